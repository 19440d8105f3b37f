// The dense blocks of the factorisation: the kernels for AVX2 against those without it bit for bit, and both
// against Eigen's.
#include "shell/dense.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <tuple>
#include <vector>

namespace plisse::shell {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double poison = std::numeric_limits<double>::quiet_NaN();

// Numbers from −1 to 1, every eighth a zero of either sign: those of a front are zeros where nothing has come
// in yet.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  MatrixXd matrix(Index rows, Index columns) {
    MatrixXd made(rows, columns);
    for (Index i = 0; i < made.size(); ++i) {
      const double value = uniform_(engine_);
      made.data()[i] = engine_() % 8 == 0 ? std::copysign(0.0, value) : value;
    }
    return made;
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

// In rows of `stride`, what is not theirs poisoned: the half above the diagonal, and what lies between
// columns.
MatrixXd strided(const MatrixXd& matrix, Index stride, bool lower_only) {
  MatrixXd wide = MatrixXd::Constant(stride, matrix.cols(), poison);
  for (Index j = 0; j < matrix.cols(); ++j)
    for (Index i = lower_only ? j : 0; i < matrix.rows(); ++i) wide(i, j) = matrix(i, j);
  return wide;
}

// How many numbers have other bits; two that are no numbers are the same.
Index different(const MatrixXd& a, const MatrixXd& b) {
  Index count = 0;
  for (Index i = 0; i < a.size(); ++i) {
    const double x = a.data()[i], y = b.data()[i];
    if (std::isnan(x) && std::isnan(y)) continue;
    count += std::bit_cast<std::uint64_t>(x) != std::bit_cast<std::uint64_t>(y);
  }
  return count;
}

// Remainders of the tiles (4 × 4 and 8 × 6), of the blocks of 128 rows, 192 deep and 48 columns, and one size
// that several cores share.
const std::vector<std::array<Index, 3>> products = {
    {0, 0, 0},   {1, 1, 0},     {1, 0, 1},    {1, 1, 1},       {2, 1, 3},      {3, 3, 1},     {4, 4, 4},
    {5, 4, 2},   {6, 6, 7},     {7, 7, 5},    {8, 6, 9},       {9, 7, 4},      {12, 12, 12},  {13, 5, 48},
    {17, 17, 1}, {23, 9, 11},   {31, 31, 31}, {48, 47, 5},     {63, 1, 191},   {64, 65, 192}, {65, 64, 193},
    {127, 3, 7}, {128, 128, 2}, {129, 50, 6}, {257, 131, 200}, {300, 299, 385}};

TEST(ShellDense, ProductsAreTheSameBitForBitWithoutAvx2) {
  if (!has_wide_kernels()) GTEST_SKIP() << "this processor has no AVX2";
  for (const auto& [rows, columns, depth] : products) {
    Numbers numbers(static_cast<unsigned>(1 + rows + 7 * columns + 31 * depth));
    const MatrixXd a = strided(numbers.matrix(rows, depth), rows + 3, false);
    const MatrixXd c = strided(numbers.matrix(rows, columns), rows + 2, true);
    MatrixXd wide = c, plain = c;
    subtract_products(a.data(), rows + 3, wide.data(), rows + 2, rows, std::min(rows, columns), depth);
    subtract_products(a.data(), rows + 3, plain.data(), rows + 2, rows, std::min(rows, columns), depth,
                      Kernels::plain);
    EXPECT_EQ(different(wide, plain), 0) << rows << " " << columns << " " << depth;
  }
}

TEST(ShellDense, ProductsAreEigens) {
  for (const Kernels kernels : {Kernels::widest, Kernels::plain})
    for (const auto& [rows, wanted, depth] : products) {
      const Index columns = std::min(rows, wanted);
      Numbers numbers(static_cast<unsigned>(2 + rows + 7 * columns + 31 * depth));
      const MatrixXd a = numbers.matrix(rows, depth), c = numbers.matrix(rows, columns);
      MatrixXd ours = strided(c, rows + 2, true);
      const MatrixXd packed = strided(a, rows + 3, false);
      subtract_products(packed.data(), rows + 3, ours.data(), rows + 2, rows, columns, depth, kernels);
      const MatrixXd theirs = c - a * a.topRows(columns).transpose();
      // Both are off by at most (depth + 1) ε of the sum of absolute values (N. Higham, Accuracy and
      // Stability of Numerical Algorithms, 3.5), in whatever order they sum.
      const MatrixXd bound = 2 * static_cast<double>(depth + 1) * epsilon *
                             (c.cwiseAbs() + a.cwiseAbs() * a.cwiseAbs().topRows(columns).transpose());
      Index wrong = 0, touched = 0;
      for (Index j = 0; j < columns; ++j)
        for (Index i = 0; i < rows + 2; ++i) {
          if (i < j || i >= rows)
            touched += !std::isnan(ours(i, j));
          else
            wrong += !(std::abs(ours(i, j) - theirs(i, j)) <= bound(i, j));
        }
      EXPECT_EQ(wrong, 0) << rows << " " << columns << " " << depth;
      EXPECT_EQ(touched, 0) << rows << " " << columns << " " << depth;
    }
}

// Columns of a panel, rows below them included. Widths round the blocks of 48 columns, heights round the
// strips of 64 rows.
std::vector<std::pair<Index, Index>> panels() {
  std::vector<std::pair<Index, Index>> all;
  for (const Index width : {0, 1, 2, 3, 5, 7, 8, 13, 31, 47, 48, 49, 95, 97, 150})
    for (const Index below : {0, 1, 2, 9, 63, 64, 65, 131}) all.emplace_back(width + below, width);
  all.emplace_back(640, 200);  // shared by several cores
  return all;
}

// Positive definite at the top: I + B Bᵀ/width, whose eigenvalues are between 1 and some 3.
MatrixXd panel(Index height, Index width, unsigned seed) {
  Numbers numbers(seed);
  MatrixXd made = numbers.matrix(height, width);
  const MatrixXd half = made.topRows(width);
  made.topRows(width) = half * half.transpose() / static_cast<double>(std::max<Index>(width, 1)) +
                        MatrixXd::Identity(width, width);
  return made;
}

TEST(ShellDense, FactorsAreTheSameBitForBitWithoutAvx2) {
  if (!has_wide_kernels()) GTEST_SKIP() << "this processor has no AVX2";
  for (const auto& [height, width] : panels()) {
    const MatrixXd start = strided(panel(height, width, 5), height + 1, true);
    MatrixXd wide = start, plain = start;
    ASSERT_TRUE(factorise_columns(wide.data(), height + 1, height, width));
    ASSERT_TRUE(factorise_columns(plain.data(), height + 1, height, width, Kernels::plain));
    EXPECT_EQ(different(wide, plain), 0) << height << " " << width;
  }
}

TEST(ShellDense, FactorsAreEigens) {
  for (const Kernels kernels : {Kernels::widest, Kernels::plain})
    for (const auto& [height, width] : panels()) {
      const MatrixXd start = panel(height, width, 6);
      MatrixXd ours = strided(start, height + 1, true);
      ASSERT_TRUE(factorise_columns(ours.data(), height + 1, height, width, kernels));
      if (width == 0) continue;
      const Eigen::LLT<MatrixXd> eigen(start.topRows(width));
      const MatrixXd lower = eigen.matrixL();
      MatrixXd expected(height, width);
      expected.topRows(width) = lower;
      // (Eigen's solver binds references into right-hand sides that are empty.)
      if (height > width)
        expected.bottomRows(height - width) = lower.triangularView<Eigen::Lower>()
                                                  .solve(start.bottomRows(height - width).transpose())
                                                  .transpose();
      // Backward errors of (width + 1) ε (Higham, 10.3 and 8.5), times a condition of some 3 and the √width
      // of norms, for either of the two.
      const double bound = 20 * static_cast<double>(width + 1) * epsilon;
      double worst = 0;
      for (Index j = 0; j < width; ++j) {
        worst = std::max(
            worst,
            (ours.col(j).segment(j, height - j) - expected.col(j).tail(height - j)).cwiseAbs().maxCoeff());
        EXPECT_TRUE(ours.col(j).head(j).array().isNaN().all()) << "above the diagonal";
        EXPECT_TRUE(std::isnan(ours(height, j))) << "between the columns";
      }
      EXPECT_LE(worst, bound) << height << " " << width;
    }
}

TEST(ShellDense, BothSayWhatIsNotPositiveDefinite) {
  for (const Index at : {0, 1, 30, 47, 48, 60})
    for (const double value : {-1.0, 0.0, poison}) {
      MatrixXd bad = panel(70, 61, 7);
      if (value == 0) {
        bad.row(at).setZero();
        bad.col(at).setZero();
      }
      bad(at, at) = value;
      MatrixXd wide = bad, plain = bad;
      EXPECT_FALSE(factorise_columns(wide.data(), 70, 70, 61)) << at << " " << value;
      EXPECT_FALSE(factorise_columns(plain.data(), 70, 70, 61, Kernels::plain)) << at << " " << value;
      EXPECT_EQ(different(wide, plain), 0) << at << " " << value;
    }
}

}  // namespace
}  // namespace plisse::shell
