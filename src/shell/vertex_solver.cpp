#include "shell/vertex_solver.h"

#include <Eigen/OrderingMethods>

#include "base/error.h"

namespace plisse::shell {

using Eigen::Index;

VertexSolver::VertexSolver(const Eigen::SparseMatrix<double>& matrix, const std::vector<bool>& free) {
  std::vector<Index> row(free.size(), -1);
  for (std::size_t v = 0; v < free.size(); ++v)
    if (free[v]) {
      row[v] = static_cast<Index>(vertex_.size());
      vertex_.push_back(static_cast<Index>(v));
    }
  const auto count = static_cast<Index>(vertex_.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, column); it; ++it)
      if (row[static_cast<std::size_t>(it.row())] >= 0 && row[static_cast<std::size_t>(column)] >= 0)
        entries.emplace_back(static_cast<int>(row[static_cast<std::size_t>(it.row())]),
                             static_cast<int>(row[static_cast<std::size_t>(column)]), it.value());
  Eigen::SparseMatrix<double> whole(count, count), lower(count, count);
  whole.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(whole, order);  // order.indices()[k]: the row that comes k-th
  std::vector<Index> vertices;
  for (Index k = 0; k < count; ++k) vertices.push_back(vertex_[static_cast<std::size_t>(order.indices()[k])]);
  lower.selfadjointView<Eigen::Lower>() = whole.selfadjointView<Eigen::Lower>().twistedBy(order.inverse());
  vertex_ = std::move(vertices);
  cholesky_.analyse(lower);
  if (!cholesky_.factorise(lower))
    throw Error(ExitCode::bad_input,
                "triangles of the rest shape are so thin or so unlike in size that double precision does not "
                "solve for a smooth surface; a cleaner mesh is wanted");
}

Positions VertexSolver::solve(const Positions& right) const {
  Eigen::Matrix<double, Eigen::Dynamic, 3> own(static_cast<Index>(vertex_.size()), 3);
  for (Index k = 0; k < own.rows(); ++k) own.row(k) = right.col(vertex_[static_cast<std::size_t>(k)]);
  own = cholesky_.solve_three(own);
  Positions result = Positions::Zero(3, right.cols());
  for (Index k = 0; k < own.rows(); ++k) result.col(vertex_[static_cast<std::size_t>(k)]) = own.row(k);
  return result;
}

}  // namespace plisse::shell
