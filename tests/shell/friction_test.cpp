// Friction on obstacles: its derivatives, and cloth that holds or slides as Coulomb says.
#include "shell/friction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "shell/carry.h"
#include "shell/meshes.h"
#include "shell/newton.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::HasSubstr;
using Number = Eigen::Matrix<double, 1, 1>;

TEST(ShellFriction, DerivativesOnBothSidesOfTheSlip) {
  std::mt19937 engine(11);
  std::normal_distribution<double> normal;
  Grip grip;
  grip.anchor << 0.1, -0.2, 0.3;
  grip.normal = Vector3d(1, 2, 3).normalized();
  grip.force = 2.5;
  const double slip = 0.01;
  for (const double way : {0.2, 0.7, 1.5, 8.0}) {
    const Vector3d along =
        grip.normal.cross(Vector3d(normal(engine), normal(engine), normal(engine))).normalized();
    const Vector3d at = grip.anchor + way * slip * along + 0.3 * grip.normal;
    const Contact contact = friction(grip, at, 0.4, slip);
    test::expect_derivative([&](const Vector3d& x) { return Number(friction(grip, x, 0.4, slip).value); },
                            [&](const Vector3d& d) { return Number(contact.first.dot(d)); }, at, 0.1 * slip,
                            engine);
    test::expect_derivative([&](const Vector3d& x) { return friction(grip, x, 0.4, slip).first; },
                            [&](const Vector3d& d) { return Vector3d(contact.second * d); }, at, 0.1 * slip,
                            engine);
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix3d>(contact.second).eigenvalues()[0], -1e-12 / slip);
    if (way >= 1) {
      EXPECT_NEAR(contact.first.norm(), 0.4 * 2.5, 1e-12);  // μF from there on
    }
  }
  EXPECT_EQ(friction(grip, grip.anchor, 0.4, slip).first.norm(), 0);
  EXPECT_EQ(friction(grip, grip.anchor, 0.4, slip).value, 0);
}

Shell shell_of(const test::Mesh& mesh) {
  Shell shell;
  shell.topology = build_topology(mesh.faces, static_cast<std::size_t>(mesh.positions.cols()));
  shell.rest = rest_faces(mesh.positions, mesh.faces);
  shell.material = {1e5, 0.3, 1e-3, 200};
  return shell;
}

struct Slid {
  Equilibrium equilibrium;
  double way = 0;  // m: how far it went along the plane
};

// A patch of .2 m on a plane tilted by an angle, straight under gravity, with a coefficient of friction.
Slid on_a_slope(double slope, double coefficient) {
  const test::Mesh mesh = test::grid(6, 6, 0.2, 0.2, test::Diagonal::alternating);
  const Shell shell = shell_of(mesh);
  const Matrix3d tilt = Eigen::AngleAxisd(std::atan(slope), Vector3d::UnitY()).toRotationMatrix();
  Loads loads;
  loads.gravity << 0, 0, -9.81;
  loads.obstacles = {Plane{{0, 0, 0}, tilt.col(2)}};
  loads.gap = 1e-3;
  loads.friction = coefficient;
  const Positions start = (tilt * mesh.positions).colwise() + 5e-4 * tilt.col(2);
  Slid slid;
  slid.equilibrium = find_equilibrium(shell, Conditions(static_cast<std::size_t>(start.cols())), loads, start,
                                      {200, 1e-8, 0});
  slid.way =
      (tilt.transpose() * (slid.equilibrium.positions - start)).topRows<2>().colwise().norm().maxCoeff();
  return slid;
}

TEST(ShellFriction, HoldsBelowItsAngleAndSlidesAbove) {
  for (const double coefficient : {0.2, 0.5}) {
    const double slope = 0.9 * coefficient, slip = 1e-4;
    const auto [holds, way] = on_a_slope(slope, coefficient);
    EXPECT_TRUE(holds.converged) << holds.reason;
    // Nine tenths of all that friction can be: f₀' = .9 at 1 − √.1 of the slip length, which is a tenth of
    // the gap.
    const double share = 1 - std::sqrt(0.1);
    EXPECT_NEAR(way, share * slip, 1e-6);
    // The work that this was, by all of the weight's part across the plane. Ways differ by a hundredth of
    // themselves, the work by two.
    const double push = 200 * 1e-3 * 0.04 * 9.81 / std::hypot(1, slope);
    const double work = coefficient * push * slip * (share * share - share * share * share / 3);
    EXPECT_NEAR(holds.friction, work, 0.02 * work);
    const Equilibrium slides = on_a_slope(1.1 * coefficient, coefficient).equilibrium;
    EXPECT_FALSE(slides.converged);
    EXPECT_THAT(slides.reason, HasSubstr("slides along an obstacle without end"));
  }
}

TEST(ShellFriction, WithoutItNothingHoldsOnASlope) {
  const Equilibrium slides = on_a_slope(0.1, 0).equilibrium;
  EXPECT_FALSE(slides.converged);
  EXPECT_THAT(slides.reason, HasSubstr("slides along an obstacle without end"));
}

// What lies where it was laid has rubbed at nothing: its energy is that without friction.
TEST(ShellFriction, CostsNothingWhereNothingSlips) {
  const Equilibrium smooth = on_a_slope(0, 0).equilibrium, rough = on_a_slope(0, 0.5).equilibrium;
  ASSERT_TRUE(smooth.converged && rough.converged) << smooth.reason << "; " << rough.reason;
  // Forces balance to 1e-8, so energies are the least ones to about the square of it; what lies loose may be
  // some nanometres aside, which costs F times that.
  EXPECT_NEAR(rough.energy, smooth.energy, 1e-8 * std::abs(smooth.energy));
  EXPECT_NEAR(rough.friction, 0, 1e-8 * std::abs(smooth.energy));
}

// Cloth laid on a sphere off its middle.
struct OnASphere {
  Shell shell;
  Loads loads;
  Positions start;
  Conditions conditions;

  explicit OnASphere(double coefficient) {
    const test::Mesh mesh = test::grid(10, 10, 0.6, 0.6, test::Diagonal::alternating);
    shell = shell_of(mesh);
    loads.gravity << 0, 0, -9.81;
    loads.obstacles = {Sphere{{0, 0, -0.2}, 0.2}};
    loads.gap = 2e-3;
    loads.friction = coefficient;
    start = mesh.positions.colwise() - Vector3d(0.28, 0.3, 0);  // its middle is 2 cm off
    start.row(2).setConstant(1e-3);
    conditions = Conditions(static_cast<std::size_t>(start.cols()));
  }
  Equilibrium solve(int iterations = 400) const {
    return find_equilibrium(shell, conditions, loads, start, {iterations, 1e-8, 0});
  }
};

// With friction it stays, held by nothing; without, it slides off, and that is told.
TEST(ShellFriction, RestsOnASphere) {
  const OnASphere rough(0.8);
  const Equilibrium stays = rough.solve();
  EXPECT_TRUE(stays.converged) << stays.reason;
  for (Eigen::Index v = 0; v < rough.start.cols(); ++v)
    EXPECT_GT(distance(rough.loads.obstacles[0], stays.positions.col(v)).value, 0);
  EXPECT_GT(stays.positions.row(2).maxCoeff(), -1e-3);  // still over the top
  const Equilibrium falls = OnASphere(0).solve();
  EXPECT_FALSE(falls.converged);
  EXPECT_THAT(falls.reason, HasSubstr("held by nothing and gravity pulls at it"));
}

// Wherever the search ends, also between two looks at what grips: the forces that are told are those of the
// last state, as who begins there would find them.
TEST(ShellFriction, WhatIsToldIsOfTheLastState) {
  const OnASphere rough(0.8);
  for (const int iterations : {3, 6, 9, 11, 400}) {
    const Equilibrium e = rough.solve(iterations);
    EXPECT_EQ(e.converged, iterations == 400) << e.reason;
    Loads loads = rough.loads;
    loads.anchors = e.anchors;
    Potential potential(rough.shell, rough.conditions, loads);
    potential.look_up(e.positions, true);
    Eigen::VectorXd gradient;
    const Potential::Value value = potential.value(e.positions, &gradient);
    // Rounding of forces that cancel; where it has converged, little else is left of them.
    EXPECT_NEAR(e.gradient_inf, gradient.cwiseAbs().maxCoeff(), 1e-11 * value.force_scale) << iterations;
    EXPECT_NEAR(e.force_scale, value.force_scale, 1e-11 * value.force_scale) << iterations;
    // Anchors of what slips are dragged along, so friction has done less work since.
    EXPECT_NEAR(e.energy - e.friction, value.energy - value.friction, 1e-11 * value.summands) << iterations;
  }
}

TEST(ShellFriction, ObstaclesCarryWhatSticksToThem) {
  const Vector3d point(0.1, 0.2, 0.3);
  const Matrix3d turn = Eigen::AngleAxisd(0.4, Vector3d(1, 2, 2).normalized()).toRotationMatrix();
  const Vector3d shift(0.3, -0.1, 0.2);
  EXPECT_LT((carried_along(Sphere{{0, 0, 0}, 0.3}, Sphere{shift, 0.3}, point) - point - shift).norm(), 1e-15);
  // A body of triangles goes with all of its motion, turns included.
  test::Mesh ball = test::ball(0.3, 12);
  const Body before = std::make_shared<TriangleBody>(ball.positions, ball.faces, "ball");
  const Vector3d on_it = ball.positions.col(40);
  ball.positions = (turn * ball.positions).colwise() + shift;
  const Body after = std::make_shared<TriangleBody>(ball.positions, ball.faces, "ball");
  EXPECT_LT((carried_along(before, after, on_it) - turn * on_it - shift).norm(), 1e-14);
}

}  // namespace
}  // namespace plisse::shell
