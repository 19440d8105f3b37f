// The reference's height field over a triangle against finite differences, plane waves, and its continuity.
#include "reference/waves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/functions.h"

namespace plisse::reference {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Random {
  std::mt19937 engine;
  std::normal_distribution<double> normal;
  explicit Random(unsigned seed) : engine(seed) {}
  Vector3d vector() { return {normal(engine), normal(engine), normal(engine)}; }
  Vector3d barycentric() {  // well inside
    std::uniform_real_distribution<double> share(0.1, 1);
    const Vector3d b(share(engine), share(engine), share(engine));
    return b / b.sum();
  }
};

WaveTriangle random_triangle(Random& random) {
  WaveTriangle t;
  for (int j = 0; j < 3; ++j) {
    t.corners.col(j) = random.vector();
    t.wavenumbers.col(j) = 0.5 * random.vector();
    t.heights[j] = 0.1 + 0.05 * std::abs(random.normal(random.engine));
    t.phases[j] = random.normal(random.engine);
  }
  return t;
}

Vector3d barycentric_of(const Matrix3d& corners, const Vector3d& point) {
  // A direct solve: the point as a combination of corners, coordinates summing to 1.
  Eigen::Matrix<double, 4, 3> system;
  system << corners, 1, 1, 1;
  return system.colPivHouseholderQr().solve(point.homogeneous());
}

TEST(ReferenceWaves, FullGradientIsTheHeightsDerivative) {
  Random random(1);
  for (const Blend blend : {Blend::linear, Blend::smooth})
    for (int trial = 0; trial < 50; ++trial) {
      const WaveTriangle t = random_triangle(random);
      const Vector3d at = random.barycentric();
      const HeightSample sample = height_and_gradient(t, at, sinusoid(), blend, Gradient::full);
      // The derivative along the triangle's plane, as the height is known nowhere else.
      for (int side = 1; side < 3; ++side) {
        const Vector3d direction = t.corners.col(side) - t.corners.col(0);
        const Vector3d change = Vector3d::Unit(side) - Vector3d::Unit(0);  // of the barycentric coordinates
        const double expected = sample.gradient.dot(direction);
        for (const double step : {1e-3, 1e-4, 1e-5}) {
          const auto height = [&](double s) {
            return height_and_gradient(t, at + s * change, sinusoid(), blend, Gradient::full).height;
          };
          // Central differences: third derivatives of waves and weights reach some 2e4 here; rounding
          // 1e-16/step.
          EXPECT_NEAR((height(step) - height(-step)) / (2 * step), expected,
                      2e4 * step * step + 1e-15 / step);
        }
      }
    }
}

// Finer waves: the slope is that of the height, and the two take as much of the cloth's length as one alone,
// half the mean square of the slopes.
TEST(ReferenceWaves, FinerWavesSlopeAndLength) {
  Random random(5);
  for (const auto& [waves, share] : {std::pair(3, 0.5), std::pair(8, 1.5)}) {
    Profile both = sinusoid();
    both.fine_waves = waves;
    both.coarse = 1 / std::sqrt(1 + share * share);
    both.fine = both.coarse * share / waves;
    const WaveTriangle t = random_triangle(random);
    const Vector3d at = random.barycentric(), change = Vector3d::Unit(1) - Vector3d::Unit(0);
    const double expected = height_and_gradient(t, at, both, Blend::smooth, Gradient::full)
                                .gradient.dot(t.corners.col(1) - t.corners.col(0));
    for (const double step : {1e-4, 1e-5}) {
      const auto height = [&](double s) {
        return height_and_gradient(t, at + s * change, both, Blend::smooth, Gradient::full).height;
      };
      // As above, third derivatives grown by fine · waves³ = share · waves².
      EXPECT_NEAR((height(step) - height(-step)) / (2 * step), expected,
                  2e4 * (1 + share * waves * waves) * step * step + 1e-15 / step);
    }
    // One corner's own wave, along its own direction, over one period.
    double alone = 0, together = 0;
    constexpr int places = 1000;
    for (int i = 0; i < places; ++i) {
      const double turns = (i + 0.5) / places;
      alone += std::pow(both.slope(turns), 2);
      together +=
          std::pow(both.coarse * both.slope(turns) + both.fine * waves * both.slope(waves * turns), 2);
    }
    EXPECT_NEAR(together / alone, 1, 1e-9);
  }
}

TEST(ReferenceWaves, PaperGradientDropsTheWeightsGradient) {
  Random random(2);
  for (const Blend blend : {Blend::linear, Blend::smooth}) {
    const WaveTriangle t = random_triangle(random);
    const Vector3d at = random.barycentric();
    const BlendWeights w = blend_weights(t.corners, at, blend);
    Vector3d waves = Vector3d::Zero(), weights = Vector3d::Zero();
    const Vector3d point = t.corners * at;
    for (int j = 0; j < 3; ++j) {
      // Eq. 8 and eq. 5, written out from positions.
      const double phase = 2 * pi * t.wavenumbers.col(j).dot(point - t.corners.col(j)) + t.phases[j];
      waves -= w.weights[j] * 2 * pi * t.heights[j] * std::sin(phase) * t.wavenumbers.col(j);
      weights += t.heights[j] * std::cos(phase) * w.gradients.col(j);
    }
    EXPECT_LT((height_and_gradient(t, at, sinusoid(), blend, Gradient::paper).gradient - waves).norm(),
              1e-13);
    EXPECT_LT(
        (height_and_gradient(t, at, sinusoid(), blend, Gradient::full).gradient - waves - weights).norm(),
        1e-13);
  }
}

TEST(ReferenceWaves, AgreeingWavesGiveThePlaneWave) {
  // Partition of unity: three times the same wave is that wave, height and gradient; 1e-20 in the sum of
  // shares costs 1e-20/E, here below 1e-15.
  Random random(3);
  for (const Blend blend : {Blend::linear, Blend::smooth})
    for (int trial = 0; trial < 20; ++trial) {
      WaveTriangle t = random_triangle(random);
      const Vector3d k = random.vector();
      for (int j = 0; j < 3; ++j) {
        t.wavenumbers.col(j) = k;
        t.heights[j] = 0.2;
        t.phases[j] = 2 * pi * k.dot(t.corners.col(j)) + 0.3;
      }
      const Vector3d at = random.barycentric();
      const double phase = 2 * pi * k.dot(t.corners * at) + 0.3;
      const HeightSample sample = height_and_gradient(t, at, sinusoid(), blend, Gradient::full);
      EXPECT_NEAR(sample.weights.sum(), 1, 1e-14);
      EXPECT_NEAR(sample.height, 0.2 * std::cos(phase), 1e-13);
      const Vector3d expected = -0.2 * 2 * pi * std::sin(phase) * k;
      EXPECT_LT((sample.gradient - expected).norm(), 1e-11);  // |k| to 4, weights' gradients to 100 cancel
    }
}

TEST(ReferenceWaves, SmoothBlendIsContinuousAcrossEdges) {
  // Two coplanar triangles ABC and BAD with all that belongs to A and B in common.
  Random random(4);
  double linear_jump = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Matrix3d turn =
        Eigen::Quaterniond(Eigen::Vector4d(random.vector().homogeneous()).normalized()).toRotationMatrix();
    WaveTriangle first = random_triangle(random), second = random_triangle(random);
    std::normal_distribution<double>& n = random.normal;
    first.corners << 0, 1.3, n(random.engine), 0, 0, 1 + std::abs(n(random.engine)), 0, 0, 0;
    second.corners << 1.3, 0, n(random.engine), 0, 0, -1 - std::abs(n(random.engine)), 0, 0, 0;
    first.corners = turn * first.corners;
    second.corners = turn * second.corners;
    for (int j = 0; j < 2; ++j) {
      second.wavenumbers.col(1 - j) = first.wavenumbers.col(j);
      second.heights[1 - j] = first.heights[j];
      second.phases[1 - j] = first.phases[j];
    }
    // Waves live in their tangent planes, here one for all.
    for (WaveTriangle* t : {&first, &second}) {
      const Vector3d normal = turn.col(2);
      t->wavenumbers -= normal * (normal.transpose() * t->wavenumbers);
    }
    for (const double s : {0.01, 0.2, 0.5, 0.77, 0.999}) {
      const Vector3d one(1 - s, s, 0), other(s, 1 - s, 0);
      const auto on = [&](Blend blend, const WaveTriangle& t, const Vector3d& at) {
        return height_and_gradient(t, at, sinusoid(), blend, Gradient::full);
      };
      const HeightSample a = on(Blend::smooth, first, one), b = on(Blend::smooth, second, other);
      EXPECT_NEAR(a.height, b.height, 1e-9);  // 1e-20/E near a corner, E = 1e-6 at .999
      EXPECT_LT((a.gradient - b.gradient).norm(), 1e-9);
      const HeightSample c = on(Blend::linear, first, one), d = on(Blend::linear, second, other);
      EXPECT_NEAR(c.height, d.height, 1e-13);
      linear_jump = std::max(linear_jump, (c.gradient - d.gradient).norm());
      // And the way there: a step of 1e-6 off the edge changes the gradient by about its own size, not by a
      // jump.
      const Vector3d inward(-0.5e-6, -0.5e-6, 1e-6);
      EXPECT_LT((on(Blend::smooth, first, one + inward).gradient - a.gradient).norm(),
                s > 0.9 || s < 0.1 ? 0.1 : 1e-3);
    }
  }
  EXPECT_GT(linear_jump, 0.1);  // what the smooth blend is for
}

TEST(ReferenceWaves, SmoothBlendOnAnEdgeKnowsItsEndsAlone) {
  Random random(5);
  const WaveTriangle t = random_triangle(random);
  for (int edge = 0; edge < 3; ++edge)
    for (const double s : {0.1, 0.5, 0.8}) {
      Vector3d at = Vector3d::Zero();
      at[edge] = 1 - s;
      at[(edge + 1) % 3] = s;
      const BlendWeights w = blend_weights(t.corners, at, Blend::smooth);
      EXPECT_NEAR(w.weights[(edge + 1) % 3], s * s * (3 - 2 * s), 1e-14);
      EXPECT_NEAR(w.weights[(edge + 2) % 3], 0, 1e-14);
      const Vector3d along = t.corners.col((edge + 1) % 3) - t.corners.col(edge);
      // ∇w of the end is S'(s) along the edge, whatever the third corner.
      const Vector3d expected = 6 * s * (1 - s) * along / along.squaredNorm();
      EXPECT_LT((w.gradients.col((edge + 1) % 3) - expected).norm(), 1e-12 * (1 + expected.norm()));
    }
}

TEST(ReferenceWaves, BarycentricGradientsAgreeWithASolve) {
  Random random(6);
  const WaveTriangle t = random_triangle(random);
  const Matrix3d gradients = barycentric_gradients(t.corners);
  const Vector3d at = random.barycentric(), in_plane = t.corners * Vector3d(0.3, -0.5, 0.2);
  const Vector3d moved = barycentric_of(t.corners, t.corners * at + in_plane);
  EXPECT_LT((at + gradients.transpose() * in_plane - moved).norm(), 1e-13);
  const Vector3d normal = (t.corners.col(1) - t.corners.col(0)).cross(t.corners.col(2) - t.corners.col(0));
  EXPECT_LT((gradients.transpose() * normal).norm(), 1e-13);
  Matrix3d flat;
  flat << 0, 1, 2, 0, 1, 2, 0, 1, 2;
  EXPECT_TRUE(barycentric_gradients(flat).isZero(0));
  EXPECT_TRUE(blend_weights(Matrix3d::Zero(), at, Blend::smooth).weights.allFinite());
}

TEST(ReferenceWaves, TextureShiftIsThePapersEquation11) {
  // Δu = [(u_B−u_A) n'×c' + (u_C−u_A) b'×n'] / (n'·(c'×b')) · Δx', with n' the plane's normal.
  Random random(7);
  const WaveTriangle t = random_triangle(random);
  const Vector3d b = t.corners.col(1) - t.corners.col(0), c = t.corners.col(2) - t.corners.col(0);
  const Vector3d n = b.cross(c).normalized(), u(0.2, 0.9, -0.4), dx = 0.1 * b - 0.3 * c + 0.2 * n;
  const double paper = ((u[1] - u[0]) * n.cross(c) + (u[2] - u[0]) * b.cross(n)).dot(dx) / n.dot(c.cross(b));
  const double direct = u.dot(barycentric_of(t.corners, t.corners.col(0) + 0.1 * b - 0.3 * c)) - u[0];
  EXPECT_NEAR(paper, direct, 1e-13);
  EXPECT_NEAR(u.dot(barycentric_gradients(t.corners).transpose() * dx), direct, 1e-13);
}

TEST(ReferenceWaves, TablesInterpolate) {
  std::vector<double> f, slope;
  for (int i = 0; i < 64; ++i) {
    f.push_back(std::cos(2 * pi * i / 64));
    slope.push_back(-std::sin(2 * pi * i / 64));
  }
  const Profile table = tabulated(f, slope, 1);
  EXPECT_EQ(table.height(3.0 / 64), f[3]);
  EXPECT_EQ(table.height(-3.0 / 64), f[61]);
  EXPECT_NEAR(table.slope(63.5 / 64), (slope[63] + slope[0]) / 2, 1e-15);
  for (double turns = -2; turns < 2; turns += 0.0137) {
    EXPECT_NEAR(table.height(turns), sinusoid().height(turns), std::pow(2 * pi / 64, 2) / 8);  // h²/8 |f''|
    EXPECT_NEAR(table.slope(turns), sinusoid().slope(turns), std::pow(2 * pi / 64, 2) / 8);
  }
}

}  // namespace
}  // namespace plisse::reference
