// Fundamental forms and strains of surfaces whose forms are known.
#include "shell/fundamental_forms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "shell/material.h"
#include "shell/meshes.h"
#include "support/errors.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector3d;

// Simple shear (Known answers): I = [1 γ; γ 1+γ²], λ = γ²/2 ± γ√(1 + γ²/4).
TEST(ShellForms, StrainsOfSimpleShear) {
  const auto mesh = test::grid(1, 1, 0.3, 0.2);
  const auto rest = rest_faces(mesh.positions, mesh.faces);
  Positions sheared = mesh.positions;
  sheared.row(0) += 0.0234375 * mesh.positions.row(1);
  for (std::size_t f = 0; f < 2; ++f) {
    const Principal strain = principal_strain(rest[f], corners_of(mesh.faces[f], sheared));
    EXPECT_NEAR(strain.value[0], 0.023714, 1e-6);  // as published, six decimals
    EXPECT_NEAR(strain.value[1], -0.023164, 1e-6);
  }
}

TEST(ShellForms, RestOrientationAndMirroredPanelsDoNotMatter) {
  std::mt19937 engine(3);
  const auto mesh = test::jittered(test::grid(4, 4, 1, 1), 0.25, 0.2, 5);
  Positions turned = test::random_rotation(engine) * mesh.positions;
  turned.colwise() += Vector3d(3, -2, 1);
  const auto rest = rest_faces(mesh.positions, mesh.faces), other = rest_faces(turned, mesh.faces);
  Positions posed = mesh.positions;
  posed.row(2) = 0.1 * mesh.positions.row(0).array().square().matrix();
  posed.row(0) *= 1.1;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Corners corners = corners_of(mesh.faces[f], posed);
    Eigen::Matrix<double, 2, 3> flat = corners_of(mesh.faces[f], mesh.positions).topRows<2>();
    flat.row(1) *= -1;  // clockwise
    const auto expected = principal_strain(rest[f], corners).value;
    // Rounding of coordinates of size 4 over edges of size 1/4.
    EXPECT_LT((principal_strain(other[f], corners).value - expected).norm(), 1e-13);
    EXPECT_LT((principal_strain(rest_face(flat, f), corners).value - expected).norm(), 1e-13);
    EXPECT_NEAR(rest_face(flat, f).area, rest[f].area, 1e-15);
  }
}

// A cylinder of radius R, rolled toward the normal: II = diag(1/R, 0) on every inner triangle, up to the
// square of the angle of an edge; the error shrinks fourfold with the edge halved.
TEST(ShellForms, SecondFormOfACylinder) {
  const double radius = 0.5;
  double previous = 0;
  for (const int n : {8, 16, 32}) {
    const auto mesh = test::grid(n, n, 1, 1);
    Positions rolled = mesh.positions;
    for (Eigen::Index v = 0; v < rolled.cols(); ++v) {
      const double angle = mesh.positions(0, v) / radius;
      rolled.col(v) << radius * std::sin(angle), mesh.positions(1, v), radius * (1 - std::cos(angle));
    }
    const Topology topology = build_topology(mesh.faces, static_cast<std::size_t>(mesh.positions.cols()));
    // Grid coordinates as rest coordinates: the forms then have the cylinder's directions.
    std::vector<RestFace> rest;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      rest.push_back(
          rest_face(Eigen::Matrix<double, 2, 3>(corners_of(mesh.faces[f], mesh.positions).topRows<2>()), f));
    const auto forms = second_forms(topology, rest, rolled);
    double worst = 0;
    for (std::size_t f = 0; f < forms.size(); ++f) {
      const auto& flaps = topology.flaps[f];
      if (flaps[0] == none || flaps[1] == none || flaps[2] == none) continue;
      Matrix2d expected = Matrix2d::Zero();
      expected(0, 0) = 1 / radius;
      worst = std::max(worst, (forms[f] - expected).norm());
    }
    EXPECT_LT(worst, 1.0 / (n * n) / radius);  // (edge/R)² is 4/n²; half of a quarter of it is what arcs lose
    if (previous > 0) {
      EXPECT_NEAR(previous / worst, 4, 0.5);
    }
    previous = worst;
  }
}

TEST(ShellForms, RefusesRestTrianglesWithoutArea) {
  Corners corners;
  corners << 0, 1, 2, 0, 1, 2, 0, 0, 0;
  EXPECT_THAT(plisse::test::error_of([&] { rest_face(corners, 17); }),
              testing::HasSubstr("rest triangle 17 has no area"));
}

TEST(ShellMaterial, IdentitiesOfTheLameParameters) {
  const Material m{1.3e6, 0.37, 2e-3, 0};
  const double y = m.young, nu = m.poisson, a = m.alpha(), b = m.beta();
  EXPECT_NEAR(a / (a + 2 * b), nu, 1e-15);
  EXPECT_NEAR((a / 2 + b) / (y / (2 * (1 - nu * nu))), 1, 1e-15);
  EXPECT_NEAR(4 * b * (a + b) / (a + 2 * b) / y, 1, 1e-15);
  EXPECT_THAT(
      plisse::test::error_of([] {
        check({-1, 0.7, 0, 0});
      }),
      testing::AllOf(testing::HasSubstr("Young's modulus is -1"), testing::HasSubstr("Poisson ratio is 0.7"),
                     testing::HasSubstr("thickness is 0")));
}

}  // namespace
}  // namespace plisse::shell
