// Limited-memory BFGS in a metric, and the solver that gives the metric of a surface, against closed forms.
#include "shell/limited_memory.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/error.h"
#include "shell/vertex_solver.h"

namespace plisse::shell {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// A chain of springs to neighbours and to the ground.
Eigen::SparseMatrix<double> chain(Index count) {
  Eigen::SparseMatrix<double> matrix(count, count);
  for (Index v = 0; v < count; ++v) {
    matrix.coeffRef(v, v) += 0.1;
    if (v + 1 == count) continue;
    const double k = 1 + static_cast<double>(v % 5);
    matrix.coeffRef(v, v) += k;
    matrix.coeffRef(v + 1, v + 1) += k;
    matrix.coeffRef(v, v + 1) -= k;
    matrix.coeffRef(v + 1, v) -= k;
  }
  return matrix;
}

TEST(ShellVertexSolver, SolvesAsADenseMatrixDoes) {
  const Index count = 40;
  const Eigen::SparseMatrix<double> matrix = chain(count);
  std::vector<bool> free(count, true);
  free[0] = free[17] = false;
  MatrixXd dense = matrix;
  for (const Index v : {0, 17}) {
    dense.row(v).setZero();
    dense.col(v).setZero();
    dense(v, v) = 1;
  }
  Positions right(3, count);
  for (Index v = 0; v < count; ++v) right.col(v) << std::sin(v), 1, static_cast<double>(v * v);
  Positions masked = right;
  masked.col(0).setZero();
  masked.col(17).setZero();
  const MatrixXd expected = dense.ldlt().solve(masked.transpose()).transpose();
  // Condition below 1e3.
  EXPECT_LT((VertexSolver(matrix, free).solve(right) - expected).cwiseAbs().maxCoeff(),
            1e-12 * expected.cwiseAbs().maxCoeff());
  EXPECT_THROW(VertexSolver(Eigen::SparseMatrix<double>(-matrix), free), Error);
}

// Of a quadratic energy the exact metric gives the minimum in one step, any other in as many as the unlike
// eigenvalues at most (here 3): BFGS with exact steps is the method of conjugate gradients.
TEST(ShellLimitedMemory, FindsTheMinimumOfAQuadratic) {
  const Eigen::Vector3d stiffness(1, 2.5, 4), place(3, -1, 2);
  const auto value = [&](const Positions& x) {
    const Positions off = x.colwise() - place;
    EnergyValue result;
    result.gradient = off.array().colwise() * stiffness.array();
    result.energy = result.summands = 0.5 * off.cwiseProduct(result.gradient).sum();
    return result;
  };
  MinimumSettings settings;
  settings.tolerance = 1e-12;
  const Positions start = Positions::Random(3, 5);
  const Minimum exact = find_minimum(
      start, value, [&](const Positions& g) { return Positions(g.array().colwise() / stiffness.array()); },
      settings);
  EXPECT_TRUE(exact.converged);
  EXPECT_EQ(exact.iterations, 1);
  const Minimum other = find_minimum(
      start, value, [](const Positions& g) { return Positions(g / 4); }, settings);
  EXPECT_TRUE(other.converged);
  EXPECT_LT((other.x.colwise() - place).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(other.iterations, 20);  // by steps of the metric alone (3/4)ⁿ: 96
}

// Σ cosh(x − p): so steep far off that a whole step in the metric of the minimum overshoots.
TEST(ShellLimitedMemory, ShortensStepsThatOvershoot) {
  const auto value = [](const Positions& x) {
    EnergyValue result;
    result.energy = result.summands = (x.array() - 1).cosh().sum();
    result.gradient = (x.array() - 1).sinh();
    return result;
  };
  MinimumSettings settings;
  settings.tolerance = 1e-9;
  const Minimum minimum = find_minimum(
      Positions::Constant(3, 2, 9), value, [](const Positions& g) { return g; }, settings);
  EXPECT_TRUE(minimum.converged);
  EXPECT_LT((minimum.x.array() - 1).abs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace plisse::shell
