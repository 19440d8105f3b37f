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
}

// A patch of .2 m on a plane tilted by an angle, straight under gravity, with a coefficient of friction.
Equilibrium on_a_slope(double slope, double coefficient) {
  const test::Mesh mesh = test::grid(6, 6, 0.2, 0.2, test::Diagonal::alternating);
  Shell shell;
  shell.topology = build_topology(mesh.faces, static_cast<std::size_t>(mesh.positions.cols()));
  shell.rest = rest_faces(mesh.positions, mesh.faces);
  shell.material = {1e5, 0.3, 1e-3, 200};
  const Matrix3d tilt = Eigen::AngleAxisd(std::atan(slope), Vector3d::UnitY()).toRotationMatrix();
  Loads loads;
  loads.gravity << 0, 0, -9.81;
  loads.obstacles = {Plane{{0, 0, 0}, tilt.col(2)}};
  loads.gap = 1e-3;
  loads.friction = coefficient;
  const Positions start = (tilt * mesh.positions).colwise() + 5e-4 * tilt.col(2);
  Equilibrium e = find_equilibrium(shell, Conditions(static_cast<std::size_t>(start.cols())), loads, start,
                                   {200, 1e-8, 0});
  // How far it went along the plane.
  e.energy = (tilt.transpose() * (e.positions - start)).topRows<2>().colwise().norm().maxCoeff();
  return e;
}

TEST(ShellFriction, HoldsBelowItsAngleAndSlidesAbove) {
  for (const double coefficient : {0.2, 0.5}) {
    const Equilibrium holds = on_a_slope(0.9 * coefficient, coefficient);
    EXPECT_TRUE(holds.converged) << holds.reason;
    // Nine tenths of all that friction can be: f₀' = .9 at 1 − √.1 of the slip length, which is a tenth of
    // the gap.
    EXPECT_NEAR(holds.energy, (1 - std::sqrt(0.1)) * 1e-4, 1e-6);
    const Equilibrium slides = on_a_slope(1.1 * coefficient, coefficient);
    EXPECT_FALSE(slides.converged);
    EXPECT_THAT(slides.reason, HasSubstr("slides along an obstacle without end"));
  }
}

TEST(ShellFriction, WithoutItNothingHoldsOnASlope) {
  const Equilibrium slides = on_a_slope(0.1, 0);
  EXPECT_FALSE(slides.converged);
  EXPECT_THAT(slides.reason, HasSubstr("slides along an obstacle without end"));
}

// Cloth laid on a sphere off its middle: with friction it stays, held by nothing; without, it slides off, and
// that is told.
TEST(ShellFriction, RestsOnASphere) {
  const test::Mesh mesh = test::grid(10, 10, 0.6, 0.6, test::Diagonal::alternating);
  Shell shell;
  shell.topology = build_topology(mesh.faces, static_cast<std::size_t>(mesh.positions.cols()));
  shell.rest = rest_faces(mesh.positions, mesh.faces);
  shell.material = {1e5, 0.3, 1e-3, 200};
  Loads loads;
  loads.gravity << 0, 0, -9.81;
  loads.obstacles = {Sphere{{0, 0, -0.2}, 0.2}};
  loads.gap = 2e-3;
  Positions start = mesh.positions.colwise() - Vector3d(0.28, 0.3, 0);  // its middle is 2 cm off
  start.row(2).setConstant(1e-3);
  const Conditions conditions(static_cast<std::size_t>(start.cols()));
  loads.friction = 0.8;
  const Equilibrium stays = find_equilibrium(shell, conditions, loads, start, {400, 1e-8, 0});
  EXPECT_TRUE(stays.converged) << stays.reason;
  for (Eigen::Index v = 0; v < start.cols(); ++v)
    EXPECT_GT(distance(loads.obstacles[0], stays.positions.col(v)).value, 0);
  EXPECT_GT(stays.positions.row(2).maxCoeff(), -1e-3);  // still over the top
  loads.friction = 0;
  const Equilibrium falls = find_equilibrium(shell, conditions, loads, start, {400, 1e-8, 0});
  EXPECT_FALSE(falls.converged);
  EXPECT_THAT(falls.reason, HasSubstr("held by nothing and gravity pulls at it"));
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
