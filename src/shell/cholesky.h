// A = L Lᵀ of sparse matrices, multifrontal: most of the work in dense blocks, on all cores.
//
// J. Liu, "The Multifrontal Method for Sparse Matrix Solution: Theory and Practice", SIAM Review 34 (1992),
// with relaxed supernodes (C. Ashcraft and R. Grimes 1989). Eigen's own factorisations work column by column.
// Of the libraries with dense blocks, SuiteSparse's supernodal part is GPL, PaStiX is not in Debian 12, and
// MUMPS (CeCILL-C) is, but brings the Fortran run time, LAPACK, Scotch and a stand-in for MPI for this one
// solver.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plisse::shell {

class Cholesky {
 public:
  // Plans for matrices of this pattern: the lower half of a symmetric one, compressed, its diagonal whole, in
  // an order that keeps L sparse. The pattern is not checked again.
  void analyse(const Eigen::SparseMatrix<double>& lower);
  // False where the matrix is not positive definite. The result has the same bytes for any number of threads.
  bool factorise(const Eigen::SparseMatrix<double>& lower);
  // With the last factorised matrix; of one right side, or of three at once.
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const { return solve_columns<1>(right); }
  Eigen::MatrixX3d solve_three(const Eigen::MatrixX3d& right) const { return solve_columns<3>(right); }

  std::size_t nonzeros() const { return panels_.size(); }

 private:
  // Columns first … first + width − 1 of L, which have the same rows below; the front has these columns, then
  // the rows.
  struct Supernode {
    std::int32_t first = 0, width = 0;
    std::vector<std::int32_t> rows;         // below, ascending
    std::vector<std::int32_t> into_parent;  // of each row: its index in the parent's front
    std::vector<std::uint32_t> children;
    std::int64_t parent = -1;
    std::size_t panel = 0;  // where its columns begin in panels_, height() numbers each
    std::size_t height() const { return static_cast<std::size_t>(width) + rows.size(); }
  };
  bool eliminate(std::uint32_t node, const double* values, std::vector<Eigen::MatrixXd>& updates);
  template <int Columns>
  Eigen::Matrix<double, Eigen::Dynamic, Columns> solve_columns(
      const Eigen::Matrix<double, Eigen::Dynamic, Columns>& right) const;

  std::vector<std::int32_t> place_;      // of a column in the order of elimination (a postorder)
  std::vector<Supernode> nodes_;         // children before parents
  std::vector<std::uint32_t> node_of_;   // of each place
  std::vector<std::size_t> slots_;       // of each number of the matrix in panels_, in the order below
  std::vector<std::size_t> first_slot_;  // of each supernode in slots_ and numbers_
  std::vector<std::uint32_t> numbers_;   // which number of the matrix it is
  std::vector<double> panels_;
};

}  // namespace plisse::shell
