// Stretching energies against closed forms, finite differences, convexity, invariance.
#include "shell/stretching.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "shell/meshes.h"

namespace plisse::shell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Random {
  std::mt19937 engine;
  std::normal_distribution<double> normal;
  explicit Random(unsigned seed) : engine(seed) {}
  double operator()() { return normal(engine); }
  Corners corners() {
    return Corners::NullaryExpr([&] { return normal(engine); });
  }
};

const Material material{1e6, 0.3, 1e-3, 0};

std::vector<StretchingLaw> laws() {
  return {{material, Stretching::stvk, 0},
          {material, Stretching::tension_field, 0},
          {material, Stretching::tension_field, 1e-3},
          {material, Stretching::tension_field, 0, 0.05},
          {{1e6, 0, 1e-3, 0}, Stretching::tension_field, 0},
          {{1e6, 0.5, 1e-3, 0}, Stretching::tension_field, 0}};
}

// One point inside each branch: taut, wrinkled, slack.
Corners posed(const RestFace& rest, double l1, double l2, Random& random) {
  const Eigen::Matrix3d turn = test::random_rotation(random.engine);
  const double angle = random();
  const Eigen::Rotation2Dd in_plane(angle);
  const Eigen::Matrix2d stretch = in_plane.toRotationMatrix() *
                                  Vector2d(std::sqrt(1 + l1), std::sqrt(1 + l2)).asDiagonal() *
                                  in_plane.inverse().toRotationMatrix();
  Corners corners = Corners::Zero();
  corners.block<2, 1>(0, 1) = stretch * rest.edges.col(0);
  corners.block<2, 1>(0, 2) = stretch * rest.edges.col(1);
  corners = turn * corners;
  corners.colwise() += Vector3d(random(), random(), random());
  return corners;
}

TEST(ShellStretching, BranchesMeetWhereStressIsContinuous) {
  const StretchingLaw law{material, Stretching::tension_field, 0};
  const double nu = material.poisson, l1 = 0.1, step = 1e-9;
  EXPECT_EQ(tension_state(material, l1, -nu * l1 + step), TensionState::taut);
  EXPECT_EQ(tension_state(material, l1, -nu * l1 - step), TensionState::wrinkled);
  EXPECT_EQ(tension_state(material, 0, -1), TensionState::slack);
  EXPECT_EQ(tension_state(material, 0, 0), TensionState::slack);
  const auto taut = stretching_density(law, l1, -nu * l1 + step);
  const auto wrinkled = stretching_density(law, l1, -nu * l1 - step);
  // First derivatives change by the second ones (275 N/m) times the step on either side.
  EXPECT_NEAR(taut.value, wrinkled.value, 1e-6 * step);
  EXPECT_NEAR((taut.first - wrinkled.first).norm(), 0, 1e3 * step);
  EXPECT_NEAR(wrinkled.value, material.thickness / 4 * 0.5 * material.young * l1 * l1, 1e-15);
  EXPECT_EQ(stretching_density(law, -0.1, -0.2).value, 0);
}

TEST(ShellStretching, DerivativesAtThreeSteps) {
  Random random(1);
  const Corners rest_corners = (Corners() << 0, 1, 0.3, 0, 0.1, 0.8, 0, 0, 0).finished();
  const RestFace rest = rest_face(rest_corners, 0);
  for (const StretchingLaw& law : laws())
    for (const Vector2d& strain : {Vector2d(0.3, 0.1), Vector2d(0.3, -0.6), Vector2d(-0.2, -0.5),
                                   Vector2d(1e-3, 5e-4), Vector2d(0.02, 0.02), Vector2d(0.2, 0.01)}) {
      // An energy of 0 has no relative error.
      if (strain[0] < 0 && law.model == Stretching::tension_field && law.residual == 0) continue;
      const Corners corners = posed(rest, strain[0], strain[1], random);
      const Vector9 at = Eigen::Map<const Vector9>(corners.data());
      const auto energy = [&](const Vector9& x) {
        return Eigen::Matrix<double, 1, 1>(stretching(law, rest, Eigen::Map<const Corners>(x.data())));
      };
      const auto gradient = [&](const Vector9& x) {
        Vector9 g;
        stretching(law, rest, Eigen::Map<const Corners>(x.data()), &g);
        return g;
      };
      Matrix9 hessian;
      stretching(law, rest, corners, nullptr, &hessian);
      // Small enough that no branch is crossed.
      const double scale = 0.1 * strain.cwiseAbs().minCoeff();
      test::expect_derivative(
          energy, [&](const Vector9& d) { return Eigen::Matrix<double, 1, 1>(gradient(at).dot(d)); }, at,
          scale, random.engine);
      test::expect_derivative(
          gradient, [&](const Vector9& d) { return Vector9(hessian * d); }, at, scale, random.engine);
      EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-12 * hessian.norm());
    }
}

TEST(ShellStretching, RigidMotionsChangeNothing) {
  Random random(2);
  for (const StretchingLaw& law : laws())
    for (int trial = 0; trial < 20; ++trial) {
      const RestFace rest = rest_face(random.corners(), 0);
      const Corners corners = random.corners();
      Corners moved = test::random_rotation(random.engine) * corners;
      moved.colwise() += Vector3d(random(), random(), random());
      const double energy = stretching(law, rest, corners);
      EXPECT_NEAR(stretching(law, rest, moved), energy, 1e-12 * std::max(energy, 1.0));
      Vector9 gradient;
      stretching(law, rest, corners, &gradient);
      const Eigen::Map<const Corners> force(gradient.data());
      const double size = force.norm();
      EXPECT_LT(force.rowwise().sum().norm(), 1e-12 * size + 1e-300);
      Vector3d torque = Vector3d::Zero();
      for (int k = 0; k < 3; ++k) torque += corners.col(k).cross(force.col(k));
      EXPECT_LT(torque.norm(), 1e-12 * size * corners.norm() + 1e-300);
    }
}

// The relaxed density is convex in dr (Pipkin 1986): no midpoint lies above its chord.
TEST(ShellStretching, TensionFieldIsConvex) {
  Random random(3);
  const RestFace rest = rest_face((Corners() << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished(), 0);
  for (const auto& [nu, limit] :
       {std::pair(0.0, 0.0), {0.3, 0.0}, {0.5, 0.0}, {0.0, 0.5}, {0.3, 0.5}, {0.5, 2.0}}) {
    const StretchingLaw law{{1e6, nu, 1e-3, 0}, Stretching::tension_field, 0, limit};
    for (int trial = 0; trial < 30000; ++trial) {
      const Corners a = random.corners(), b = random.corners();
      const double chord = 0.5 * (stretching(law, rest, a) + stretching(law, rest, b));
      // Rounding of energies.
      ASSERT_LE(stretching(law, rest, 0.5 * (a + b)), chord * (1 + 1e-13));
    }
  }
}

// Closed forms of the limit s = Yl: pulled one way ψ = h/4 (½Yl² + s(λ − l)), both ways the stresses are s
// and no more; the elastic strain carries that stress, and what is within the limit is as without.
TEST(ShellStretching, TensionEndsAtItsLimit) {
  const double young = material.young, nu = material.poisson, limit = 0.05, quarter = material.thickness / 4;
  const StretchingLaw law{material, Stretching::tension_field, 0, limit},
      free{material, Stretching::tension_field, 0};
  for (const double l1 : {0.06, 0.3, 13.0}) {
    const StretchingDensity pulled = stretching_density(law, l1, -0.5 * l1);
    EXPECT_NEAR(pulled.value, quarter * young * limit * (limit / 2 + l1 - limit), 1e-12 * pulled.value);
    EXPECT_EQ(pulled.first, Vector2d(quarter * young * limit, 0));
    EXPECT_EQ(elastic_strain(law, l1, -0.5 * l1), Vector2d(limit, -0.5 * l1));
    const StretchingDensity both = stretching_density(law, l1, l1);
    EXPECT_EQ(both.first, Vector2d(quarter * young * limit, quarter * young * limit));
    EXPECT_NEAR((elastic_strain(law, l1, l1) - Vector2d::Constant((1 - nu) * limit)).norm(), 0, 1e-15);
  }
  for (const Vector2d& within : {Vector2d(0.04, -0.2), Vector2d(0.03, 0.01), Vector2d(-0.1, -0.2)}) {
    EXPECT_EQ(stretching_density(law, within[0], within[1]).value,
              stretching_density(free, within[0], within[1]).value);
    EXPECT_EQ(elastic_strain(law, within[0], within[1]), within);
  }
  // The stress of the elastic strain is the limited one: the two ways to the same number.
  for (const Vector2d& beyond : {Vector2d(0.2, 0.01), Vector2d(0.2, -0.01), Vector2d(0.2, 0.06)}) {
    const Vector2d elastic = elastic_strain(law, beyond[0], beyond[1]);
    EXPECT_NEAR((stretching_density(free, elastic[0], elastic[1]).first -
                 stretching_density(law, beyond[0], beyond[1]).first)
                    .norm(),
                0, 1e-13 * quarter * young);
  }
}

TEST(ShellStretching, PositiveCurvatureIsPositiveAndElsewhereExact) {
  Random random(4);
  for (const StretchingLaw& law : laws())
    for (int trial = 0; trial < 200; ++trial) {
      const RestFace rest = rest_face(random.corners(), 0);
      const Corners corners = random.corners();
      Matrix9 exact, positive;
      stretching(law, rest, corners, nullptr, &exact);
      stretching(law, rest, corners, nullptr, &positive, Curvature::positive);
      const Eigen::SelfAdjointEigenSolver<Matrix9> eigen(positive);
      EXPECT_GE(eigen.eigenvalues()[0], -1e-12 * (positive.norm() + exact.norm()));
      if (law.model == Stretching::tension_field && law.residual == 0) {
        EXPECT_EQ(exact, positive);
      }
    }
}

TEST(ShellStretching, FiniteForCollapsedAndInvertedTriangles) {
  const RestFace rest = rest_face((Corners() << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished(), 0);
  std::vector<Corners> cases(4, Corners::Zero());
  cases[1].col(1) << 1, 0, 0;                               // a needle
  cases[2].col(1) << 1, 0, 0, cases[2].col(2) << 0, -1, 0;  // turned over: isometric, so no energy
  cases[3].col(1) << 1e-16, 0, 0;
  for (const StretchingLaw& law : laws())
    for (const Corners& corners : cases) {
      Vector9 gradient;
      Matrix9 hessian;
      EXPECT_TRUE(std::isfinite(stretching(law, rest, corners, &gradient, &hessian)));
      EXPECT_TRUE(gradient.allFinite());
      EXPECT_TRUE(hessian.allFinite());
    }
  EXPECT_NEAR(stretching(laws()[0], rest, cases[2]), 0, 1e-30);
}

// The strip of "Known answers": .25 × .1 m, h 1e-4, Y 1e6, stretched by 10 %, free to contract: with
// λ₁ = 1.1² − 1 every triangle has λ₂ = −νλ₁, E = ½Yh(λ₁/2)²A = .01378 J and P = dE/dL = 1.155 N for any ν.
TEST(ShellStretching, StripFreeToContract) {
  for (const double nu : {0.0, 0.3, 0.5}) {
    const StretchingLaw law{{1e6, nu, 1e-4, 0}, Stretching::tension_field, 0};
    const auto mesh = test::jittered(test::grid(10, 4, 0.25, 0.1), 0.025, 0.3, 7);
    const auto rest = rest_faces(mesh.positions, mesh.faces);
    const auto energy = [&](double stretch) {
      Positions x = mesh.positions;
      x.row(0) *= stretch;
      x.row(1) *= std::sqrt(1 - nu * (stretch * stretch - 1));
      double sum = 0;
      for (std::size_t f = 0; f < rest.size(); ++f)
        sum += stretching(law, rest[f], corners_of(mesh.faces[f], x));
      return sum;
    };
    const double strain = (1.1 * 1.1 - 1) / 2;
    EXPECT_NEAR(energy(1.1), 0.5 * 1e6 * 1e-4 * strain * strain * 0.025, 1e-12);
    EXPECT_NEAR(energy(1.1), 0.01378, 1e-5);
    const double step = 1e-5;
    EXPECT_NEAR((energy(1.1 + step) - energy(1.1 - step)) / (2 * step * 0.25), 1.155, 1e-6);
  }
}

// An affine map has the same strain everywhere: the exact energy, and no force on an inner vertex.
TEST(ShellStretching, AffinePatch) {
  Random random(5);
  const auto mesh = test::jittered(test::grid(6, 6, 1, 1), 1.0 / 6, 0.3, 9);
  const auto rest = rest_faces(mesh.positions, mesh.faces);
  for (const StretchingLaw& law : laws()) {
    const Eigen::Matrix3d map = Eigen::Matrix3d::Identity() + 0.2 * random.corners();
    const Positions x = map * mesh.positions;
    const Principal strain =
        principal(map.leftCols<2>().transpose() * map.leftCols<2>() - Eigen::Matrix2d::Identity());
    double energy = 0, largest = 0;
    Positions force = Positions::Zero(3, x.cols());
    for (std::size_t f = 0; f < rest.size(); ++f) {
      Vector9 gradient;
      energy += stretching(law, rest[f], corners_of(mesh.faces[f], x), &gradient);
      largest = std::max(largest, gradient.cwiseAbs().maxCoeff());
      for (int k = 0; k < 3; ++k)
        force.col(mesh.faces[f][static_cast<std::size_t>(k)]) += gradient.segment<3>(3 * k);
    }
    EXPECT_NEAR(energy, stretching_density(law, strain.value[0], strain.value[1]).value, 1e-12 * energy);
    for (Eigen::Index v = 0; v < x.cols(); ++v) {
      const auto p = mesh.positions.col(v);
      const bool inner = p[0] > 1e-9 && p[0] < 1 - 1e-9 && p[1] > 1e-9 && p[1] < 1 - 1e-9;
      if (inner) {
        EXPECT_LT(force.col(v).norm(), 1e-12 * std::max(largest, 1.0));
      }
    }
  }
}

}  // namespace
}  // namespace plisse::shell
