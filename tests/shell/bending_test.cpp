// Bending energies against sheets that are rolled, finite differences and invariance.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "shell/bending_midedge.h"
#include "shell/bending_quadratic.h"
#include "shell/meshes.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector3d;

const Material material{1e6, 0.3, 1e-3, 0};

struct Patch {
  Topology topology;
  std::vector<RestFace> rest;
};

Patch patch_of(const test::Mesh& mesh) {
  return {build_topology(mesh.faces, static_cast<std::size_t>(mesh.positions.cols())),
          rest_faces(mesh.positions, mesh.faces)};
}

// Rolled without stretching about an axis at `angle` to y.
Positions rolled(const test::Mesh& mesh, double radius, double angle = 0) {
  Positions x = mesh.positions;
  const Vector3d across(std::cos(angle), std::sin(angle), 0), along(-std::sin(angle), std::cos(angle), 0);
  for (Eigen::Index v = 0; v < x.cols(); ++v) {
    const Vector3d p = mesh.positions.col(v);
    const double turn = p.dot(across) / radius;
    x.col(v) = radius * std::sin(turn) * across + p.dot(along) * along +
               Vector3d(0, 0, radius * (1 - std::cos(turn)));
  }
  return x;
}

double midedge_energy(const Patch& patch, const Positions& x, const Material& m = material) {
  double energy = 0;
  for (std::size_t f = 0; f < patch.rest.size(); ++f) {
    Corners across = Corners::Zero();
    std::array<bool, 3> has{};
    for (std::size_t i = 0; i < 3; ++i) {
      has[i] = patch.topology.flaps[f][i] != none;
      if (has[i]) across.col(static_cast<int>(i)) = x.col(patch.topology.flaps[f][i]);
    }
    energy += bending_midedge(m, patch.rest[f], Matrix2d::Zero(), corners_of(patch.topology.faces[f], x),
                              across, has);
  }
  return energy;
}

double quadratic_energy(const Patch& patch, const Positions& x, const Material& m = material) {
  const auto q = bending_quadratic(m, patch.topology, patch.rest);
  double energy = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd u = x.row(axis).transpose();
    energy += 0.5 * u.dot(q * u);
  }
  return energy;
}

// A flat sheet rolled to radius R: E = ½BA/R² (ν enters through B alone, as one curvature is 0). Faces on the
// boundary see half of the bend, so the error is of the edge's order there and its square inside.
TEST(ShellBending, RolledSheet) {
  const double radius = 0.5;
  for (const auto diagonal : {test::Diagonal::rising, test::Diagonal::falling})
    for (const double angle : {0.0, 0.5}) {
      double previous_midedge = 1, previous_quadratic = 1;
      for (const int n : {8, 16, 32}) {
        const auto mesh = test::grid(n, n, 1, 1, diagonal);
        const Patch patch = patch_of(mesh);
        const Positions x = rolled(mesh, radius, angle);
        const double exact = 0.5 * material.bending_stiffness() / (radius * radius);
        const double midedge = std::abs(midedge_energy(patch, x) / exact - 1);
        const double quadratic = std::abs(quadratic_energy(patch, x) / exact - 1);
        EXPECT_LT(midedge, 6.0 / n);
        EXPECT_LT(quadratic, 6.0 / n);
        // First order or better.
        EXPECT_LT(midedge, 0.65 * previous_midedge);
        EXPECT_LT(quadratic, 0.65 * previous_quadratic);
        previous_midedge = midedge;
        previous_quadratic = quadratic;
      }
    }
}

// The same closed to a cylinder round which nothing ends: only the ends remain, and they are generators'
// ends, across which nothing bends.
TEST(ShellBending, ClosedCylinderIsSecondOrder) {
  double previous_midedge = 0, previous_quadratic = 0;
  for (const int n : {12, 24, 48}) {
    const double radius = 1, length = 2 * 3.14159265358979323846 * radius;
    auto mesh = test::grid(n, n / 2, length, length / 2);
    const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    auto faces = mesh.faces;  // sewn: the last column of vertices is the first
    for (Face& face : faces)
      for (std::uint32_t& v : face)
        if (v % static_cast<std::uint32_t>(n + 1) == static_cast<std::uint32_t>(n))
          v = id(0, static_cast<int>(v) / (n + 1));
    Patch patch{build_topology(faces, static_cast<std::size_t>(mesh.positions.cols())),
                rest_faces(mesh.positions, mesh.faces)};
    const Positions x = rolled(mesh, radius);
    const double exact = 0.5 * material.bending_stiffness() * length * length / 2;
    const double midedge = midedge_energy(patch, x) / exact - 1,
                 quadratic = quadratic_energy(patch, x) / exact - 1;
    if (previous_midedge != 0) {
      EXPECT_NEAR(previous_quadratic / quadratic, 4, 0.2);
    }
    // Boundary faces lose part of their bend, the quadratic model none.
    EXPECT_LT(std::abs(midedge), 3.0 / n);
    // |Δr| is (sin(π/n)/(π/n))² of 1/R, so the energy lacks (2π/n)²/6.
    EXPECT_NEAR(quadratic, -6.58 / (n * n), 0.2 / (n * n));
    previous_midedge = midedge;
    previous_quadratic = quadratic;
  }
}

// On irregular meshes neither converges pointwise: normals that are averaged without regard to where they
// stand cost the mid-edge form a third here, the cotangent Laplacian a few percent. Bounds on what is known.
TEST(ShellBending, IrregularMeshesComeNear) {
  const auto mesh = test::jittered(test::grid(40, 40, 1, 1, test::Diagonal::alternating), 1.0 / 40, 0.25, 3);
  const Patch patch = patch_of(mesh);
  const double exact = 0.5 * material.bending_stiffness() / 0.25;
  EXPECT_NEAR(quadratic_energy(patch, rolled(mesh, 0.5, 0.3)) / exact, 1, 0.15);
  EXPECT_NEAR(midedge_energy(patch, rolled(mesh, 0.5, 0.3)) / exact, 1, 0.4);
}

TEST(ShellBending, NothingBendsForNuZeroExceptWhatIsBent) {
  const Material m{1e6, 0, 1e-3, 0};
  const auto mesh = test::grid(16, 16, 1, 1);
  const Patch patch = patch_of(mesh);
  // Eq. 28 as printed has α, which is 0 here; and flat sheets have none, however they are stretched.
  EXPECT_GT(quadratic_energy(patch, rolled(mesh, 0.5), m), 0.8 * 0.5 * m.bending_stiffness() / 0.25);
  Positions x = mesh.positions;
  x.row(0) *= 1.7;
  x.row(2) = 0.3 * mesh.positions.row(0) + 0.2 * mesh.positions.row(1);
  EXPECT_LT(quadratic_energy(patch, x, m), 1e-20);
  EXPECT_LT(midedge_energy(patch, x, m), 1e-20);
}

TEST(ShellBending, RigidMotionsChangeNothing) {
  std::mt19937 engine(4);
  const auto mesh = test::jittered(test::grid(6, 6, 1, 1), 1.0 / 6, 0.2, 3);
  const Patch patch = patch_of(mesh);
  const Positions x = rolled(mesh, 0.5, 0.4);
  Positions moved = test::random_rotation(engine) * x;
  moved.colwise() += Vector3d(1, 2, -1);
  EXPECT_NEAR(midedge_energy(patch, moved) / midedge_energy(patch, x), 1, 1e-12);
  EXPECT_NEAR(quadratic_energy(patch, moved) / quadratic_energy(patch, x), 1, 1e-12);
}

TEST(ShellBending, DerivativesAtThreeSteps) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  const RestFace rest = rest_face((Corners() << 0, 1, 0.3, 0, 0.1, 0.8, 0, 0, 0).finished(), 0);
  Matrix2d rest_form;
  rest_form << 0.3, -0.1, -0.1, 0.2;
  for (const std::array<bool, 3>& has :
       {std::array{true, true, true}, std::array{true, false, true}, std::array{false, true, false}})
    for (int trial = 0; trial < 5; ++trial) {
      Vector18 at;  // near a triangle and its flaps, bent a good deal
      at << 0, 0, 0, 1, 0.1, 0, 0.3, 0.8, 0, 1.2, 0.9, 0.3, -0.7, 0.5, -0.2, 0.6, -0.8, 0.4;
      for (int i = 0; i < 18; ++i) at[i] += 0.1 * normal(engine);
      const auto energy = [&](const Vector18& x) {
        return Eigen::Matrix<double, 1, 1>(bending_midedge(material, rest, rest_form,
                                                           Eigen::Map<const Corners>(x.data()),
                                                           Eigen::Map<const Corners>(x.data() + 9), has));
      };
      const auto gradient = [&](const Vector18& x) {
        Vector18 g;
        bending_midedge(material, rest, rest_form, Eigen::Map<const Corners>(x.data()),
                        Eigen::Map<const Corners>(x.data() + 9), has, &g);
        return g;
      };
      Vector18 slope;
      Matrix18 hessian;
      bending_midedge(material, rest, rest_form, Eigen::Map<const Corners>(at.data()),
                      Eigen::Map<const Corners>(at.data() + 9), has, &slope, &hessian);
      test::expect_derivative(
          energy, [&](const Vector18& d) { return Eigen::Matrix<double, 1, 1>(slope.dot(d)); }, at, 0.3,
          engine);
      test::expect_derivative(
          gradient, [&](const Vector18& d) { return Vector18(hessian * d); }, at, 0.3, engine);
      for (int i = 0; i < 3; ++i)
        if (!has[static_cast<std::size_t>(i)]) {
          EXPECT_EQ(slope.segment<3>(9 + 3 * i).norm(), 0);
        }
    }
}

// The energy's own formula is that of the second form in fundamental_forms.
TEST(ShellBending, EnergyIsTheNormOfTheSecondForm) {
  const auto mesh = test::jittered(test::grid(5, 5, 1, 1), 0.2, 0.2, 11);
  const Patch patch = patch_of(mesh);
  const Positions x = rolled(mesh, 0.3, 0.7);
  const auto forms = second_forms(patch.topology, patch.rest, x);
  double energy = 0;
  for (std::size_t f = 0; f < forms.size(); ++f)
    energy += patch.rest[f].area * std::pow(material.thickness, 3) / 12 *
              (material.alpha() / 2 * forms[f].trace() * forms[f].trace() +
               material.beta() * (forms[f] * forms[f]).trace());
  EXPECT_NEAR(midedge_energy(patch, x) / energy, 1, 1e-12);
}

TEST(ShellBending, FiniteWhereNormalsAreNot) {
  const RestFace rest = rest_face((Corners() << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished(), 0);
  const Corners flat = (Corners() << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished();
  std::vector<std::pair<Corners, Corners>> cases = {{Corners::Zero(), Corners::Zero()}, {flat, flat}};
  for (const auto& [corners, across] : cases) {
    Vector18 gradient;
    Matrix18 hessian;
    EXPECT_TRUE(std::isfinite(bending_midedge(material, rest, Matrix2d::Zero(), corners, across,
                                              {true, true, true}, &gradient, &hessian)));
    EXPECT_TRUE(gradient.allFinite());
    EXPECT_TRUE(hessian.allFinite());
  }
}

}  // namespace
}  // namespace plisse::shell
