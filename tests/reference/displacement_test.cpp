// Points moved by the height field, against closed forms and finite differences.
#include "reference/displacement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/functions.h"

namespace plisse::reference {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A triangle of the plane z = 0 with three different waves.
Triangle flat_triangle() {
  Triangle triangle;
  triangle.waves.corners << 0, 1, 0.2,  //
      0, 0.1, 0.9,                      //
      0, 0, 0;
  triangle.waves.wavenumbers << 2, 1.5, 1.8,  //
      0.3, 0.1, -0.4,                         //
      0, 0, 0;
  triangle.waves.heights = {0.05, 0.04, 0.06};
  triangle.waves.phases = {0.3, -1, 2};
  triangle.normals = Vector3d::UnitZ().replicate(1, 3);
  return triangle;
}

const Matrix3d upward = Vector3d::UnitZ().replicate(1, 3);

TEST(Displacement, OnAFlatTriangleTheNormalIsThatOfTheMovedSurface) {
  for (const Blend blend : {Blend::linear, Blend::smooth}) {
    const Triangle triangle = flat_triangle();
    for (const Vector3d& b : {Vector3d(0.2, 0.3, 0.5), Vector3d(0.6, 0.3, 0.1), Vector3d(0.1, 0.1, 0.8)}) {
      const auto point = [&](double beta, double gamma) {
        const Vector3d at(b[0] - beta - gamma, b[1] + beta, b[2] + gamma);
        return displace(triangle, upward, at, sinusoid(), blend, 1).position;
      };
      const Vector3d normal = displace(triangle, upward, b, sinusoid(), blend, 1).normal;
      for (const double step : {1e-3, 1e-4, 1e-5}) {
        const Vector3d along = point(step, 0) - point(-step, 0), across = point(0, step) - point(0, -step);
        // Central differences: the third derivative, up to 500 of h's size over ℓ³ here, times step²/6; and
        // roundings of 1e-16/step.
        EXPECT_NEAR((along.cross(across).normalized() - normal).norm(), 0, 100 * step * step + 1e-10) << step;
      }
    }
  }
}

TEST(Displacement, ACornerRisesWithItsOwnWave) {
  const Triangle triangle = flat_triangle();
  for (const Blend blend : {Blend::linear, Blend::smooth}) {
    for (int corner = 0; corner < 3; ++corner) {
      const Displaced here = displace(triangle, upward, Vector3d::Unit(corner), sinusoid(), blend, 1);
      EXPECT_NEAR(here.height, triangle.waves.heights[corner] * std::cos(triangle.waves.phases[corner]),
                  1e-15);
      // Continuous: a step of 1e-6 of the triangle climbs no more than the steepest slope, 2π·.06·2 = .75.
      const Vector3d beside = (1 - 1e-6) * Vector3d::Unit(corner) + 1e-6 / 3 * Vector3d::Ones();
      EXPECT_NEAR(displace(triangle, upward, beside, sinusoid(), blend, 1).height, here.height, 1e-6);
    }
  }
}

TEST(Displacement, WithoutWavesNothingMovesAndNormalsStay) {
  Triangle triangle = flat_triangle();
  triangle.waves.heights.setZero();
  triangle.normals.col(1) = Vector3d(0.3, 0, 1).normalized();
  const Vector3d b(0.2, 0.5, 0.3);
  const Displaced here = displace(triangle, triangle.normals, b, sinusoid(), Blend::smooth, 1);
  EXPECT_EQ(here.height, 0);
  EXPECT_EQ(here.sky_front, 1);
  EXPECT_NEAR((here.position - triangle.waves.corners * b).norm(), 0, 1e-15);
  EXPECT_NEAR((here.normal - (triangle.normals * b).normalized()).norm(), 0, 1e-15);
}

// A wave round a cylinder: X = (R + a cos ms)(sin(s/R), 0, cos(s/R)) has the normal (1 + h/R) e_r − h' e_s.
// Eq. 7 leaves out h/R, which is what keeps geometry from being shading here.
TEST(Displacement, RoundACylinderTheBendCounts) {
  constexpr double R = 0.5, a = 0.2, waves = 3, side = 1e-3;
  const double per_length = waves / (2 * pi * R);
  const auto radial = [](double s) { return Vector3d(std::sin(s / R), 0, std::cos(s / R)); };
  const auto tangent = [](double s) { return Vector3d(std::cos(s / R), 0, -std::sin(s / R)); };
  for (const double s : {0.1, 0.4, 0.9}) {
    Triangle triangle;
    const double at[3] = {s - side, s + side, s};
    for (int j = 0; j < 3; ++j) {
      triangle.waves.corners.col(j) = R * radial(at[j]) + (j == 2 ? side : 0) * Vector3d::UnitY();
      triangle.waves.wavenumbers.col(j) = per_length * tangent(at[j]);
      triangle.waves.phases[j] = 2 * pi * per_length * at[j];
      triangle.normals.col(j) = radial(at[j]);
    }
    triangle.waves.heights.setConstant(a);
    const Displaced here =
        displace(triangle, triangle.normals, {0.25, 0.25, 0.5}, sinusoid(), Blend::smooth, 1);
    const double h = a * std::cos(2 * pi * per_length * s),
                 slope = -2 * pi * per_length * a * std::sin(2 * pi * per_length * s);
    const Vector3d expected = ((1 + h / R) * radial(s) - slope * tangent(s)).normalized();
    EXPECT_NEAR(here.height, h, 1e-5);  // the blend of three waves a thousandth of a turn apart
    // The chord of the triangle: (side/R)² and what the blend of slopes leaves.
    EXPECT_NEAR((here.normal - expected).norm(), 0, 2e-3) << s;
    const Vector3d shading = (radial(s) - slope * tangent(s)).normalized();
    EXPECT_GT((shading - expected).norm(), 0.02) << s;  // and the test would notice its lack
  }
}

}  // namespace
}  // namespace plisse::reference
