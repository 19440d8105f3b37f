// Linear equations with one number a vertex, the same for x, y and z: A u = f, A symmetric and positive
// definite, solved many times with one factorisation.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "shell/cholesky.h"
#include "shell/rest_shape.h"

namespace plisse::shell {

class VertexSolver {
 public:
  // On the vertices that are free; the others' rows and columns have no part, and u = 0 there. Throws
  // Error(bad_input) where rounding leaves that matrix not positive definite.
  VertexSolver(const Eigen::SparseMatrix<double>& matrix, const std::vector<bool>& free);

  // f and u: 3×V. May be called from several threads.
  Positions solve(const Positions& right) const;

 private:
  std::vector<Eigen::Index> vertex_;  // of each row, in an order that keeps the factor sparse
  Cholesky cholesky_;
};

}  // namespace plisse::shell
