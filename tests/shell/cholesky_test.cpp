// The multifrontal factorisation against Eigen's, on matrices of meshes.
#include "shell/cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <limits>
#include <random>

namespace plisse::shell {
namespace {

using Eigen::SparseMatrix;
using Eigen::VectorXd;

// Numbers of random sign between neighbours on a grid, made positive definite by the diagonal (its rows'
// sums).
SparseMatrix<double> grid_matrix(int side, int reach, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int count = side * side;
  VectorXd sums = VectorXd::Constant(count, 0.1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < a; ++b) {
      if (std::abs(a % side - b % side) > reach || a / side - b / side > reach || uniform(engine) > 0.6)
        continue;
      const double value = uniform(engine);
      entries.emplace_back(a, b, value);
      sums[a] += std::abs(value);
      sums[b] += std::abs(value);
    }
  for (int a = 0; a < count; ++a) entries.emplace_back(a, a, sums[a]);
  SparseMatrix<double> lower(count, count);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

TEST(ShellCholesky, SolvesAsEigenDoes) {
  for (const int side : {1, 2, 7, 25})
    for (const int reach : {0, 1, 3}) {
      const SparseMatrix<double> lower = grid_matrix(side, reach, 3);
      const VectorXd right = VectorXd::LinSpaced(lower.cols(), -1, 2);
      Cholesky factor;
      factor.analyse(lower);
      ASSERT_TRUE(factor.factorise(lower));
      const Eigen::SimplicialLDLT<SparseMatrix<double>, Eigen::Lower> eigen(lower);
      const VectorXd expected = eigen.solve(right);
      // Rows dominated by their diagonals by a hundredth: condition below 1e3.
      EXPECT_LT((factor.solve(right) - expected).norm(), 1e-12 * expected.norm()) << side << " " << reach;
      EXPECT_EQ(factor.solve(right), factor.solve(right));
    }
}

TEST(ShellCholesky, ThePatternServesOtherNumbersOfIt) {
  SparseMatrix<double> lower = grid_matrix(20, 2, 5);
  Cholesky factor;
  factor.analyse(lower);
  ASSERT_TRUE(factor.factorise(lower));
  const VectorXd right = VectorXd::Ones(lower.cols());
  const VectorXd first = factor.solve(right);
  SparseMatrix<double> other = 4 * lower;
  ASSERT_TRUE(factor.factorise(other));
  EXPECT_LT((4 * factor.solve(right) - first).norm(), 1e-14 * first.norm());
  ASSERT_TRUE(factor.factorise(lower));
  EXPECT_EQ(factor.solve(right), first);  // bit for bit, whatever ran where
}

TEST(ShellCholesky, SaysWhatIsNotPositiveDefinite) {
  SparseMatrix<double> lower = grid_matrix(10, 1, 7);
  Cholesky factor;
  factor.analyse(lower);
  for (const int at : {0, 37, 99}) {
    SparseMatrix<double> bad = lower;
    bad.coeffRef(at, at) = -1e-3;
    EXPECT_FALSE(factor.factorise(bad)) << at;
  }
  EXPECT_TRUE(factor.factorise(lower));
}

TEST(ShellCholesky, NothingToDo) {
  SparseMatrix<double> none(0, 0);
  Cholesky factor;
  factor.analyse(none);
  EXPECT_TRUE(factor.factorise(none));
  EXPECT_EQ(factor.solve(VectorXd()).size(), 0);
}

}  // namespace
}  // namespace plisse::shell
