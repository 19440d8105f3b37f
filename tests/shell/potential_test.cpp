// The sum of all energies: derivatives across elements, loads and obstacles.
#include "shell/potential.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "shell/meshes.h"

namespace plisse::shell {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Shell shell_of(const test::Mesh& mesh, Bending bending, Stretching stretching = Stretching::tension_field) {
  Shell shell;
  shell.topology = build_topology(mesh.faces, static_cast<std::size_t>(mesh.positions.cols()));
  shell.rest = rest_faces(mesh.positions, mesh.faces);
  shell.material = {1e4, 0.3, 0.1, 10};
  shell.stretching = stretching;
  shell.bending = bending;
  return shell;
}

Positions bulged(const test::Mesh& mesh) {
  Positions x = 1.05 * mesh.positions;
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  for (Eigen::Index v = 0; v < x.cols(); ++v) {
    x(2, v) = 0.3 * std::sin(3 * x(0, v)) * std::cos(2 * x(1, v));
    for (int axis = 0; axis < 3; ++axis) x(axis, v) += 0.01 * normal(engine);
  }
  return x;
}

TEST(ShellPotential, DerivativesAtThreeSteps) {
  std::mt19937 engine(7);
  const auto mesh = test::jittered(test::grid(4, 4, 1, 1), 0.25, 0.2, 5);
  const Positions x = bulged(mesh);
  for (const Bending bending : {Bending::off, Bending::quadratic, Bending::midedge}) {
    Shell shell = shell_of(mesh, bending, Stretching::stvk);
    if (bending == Bending::midedge)  // curved at rest
      shell.rest_forms.assign(mesh.faces.size(), (Eigen::Matrix2d() << 0.7, 0.2, 0.2, -0.4).finished());
    Conditions conditions(static_cast<std::size_t>(x.cols()));
    conditions.hold(3, x.col(3));
    conditions.hold(7, 1, x(1, 7));
    Loads loads;
    loads.gravity << 1, -9.81, 0.3;
    loads.pressure = 200;
    loads.forces = Positions::Constant(3, x.cols(), 0.7);
    test::Mesh box = test::box({0.5, 0.5, 0.5});
    box.positions.row(2).array() -= 0.7;
    loads.obstacles = {Sphere{{0.5, 0.5, -1.0}, 0.9}, Plane{{0, 0, -0.5}, Vector3d(0.1, 0.2, 1).normalized()},
                       Capsule{{0, -0.5, -0.6}, {1, -0.6, -0.5}, 0.3},
                       Cylinder{{0, 1.4, -1}, {0, 1.4, 1}, 0.3},
                       std::make_shared<TriangleBody>(box.positions, box.faces, "box")};
    loads.gap = 0.5;
    Potential potential(shell, conditions, loads);
    ASSERT_EQ(potential.unknowns(), 3 * x.cols() - 4);
    VectorXd gradient;
    const auto value = potential.value(x, &gradient);
    ASSERT_TRUE(std::isfinite(value.energy));
    const Eigen::SparseMatrix<double> lower = potential.hessian(x, Curvature::exact);
    const MatrixXd hessian = MatrixXd(lower).selfadjointView<Eigen::Lower>();
    const auto moved = [&](const VectorXd& by) {
      Positions there = x;
      potential.advance(there, by, 1);
      return there;
    };
    const VectorXd zero = VectorXd::Zero(potential.unknowns());
    test::expect_derivative(
        [&](const VectorXd& by) { return Eigen::Matrix<double, 1, 1>(potential.value(moved(by)).energy); },
        [&](const VectorXd& d) { return Eigen::Matrix<double, 1, 1>(gradient.dot(d)); }, zero, 0.1, engine);
    test::expect_derivative(
        [&](const VectorXd& by) {
          VectorXd g;
          potential.value(moved(by), &g);
          return g;
        },
        [&](const VectorXd& d) { return VectorXd(hessian * d); }, zero, 0.1, engine);
    const Eigen::SparseMatrix<double> positive = potential.hessian(x, Curvature::positive);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen{MatrixXd(positive)};  // reads the lower half
    EXPECT_GE(eigen.eigenvalues()[0], -1e-12 * eigen.eigenvalues()[eigen.eigenvalues().size() - 1]);
  }
}

// Each term by itself, so that none hides behind a stiffer one; those that are added to the list are tested
// here as they are.
TEST(ShellPotential, EachTermOfTheListHasItsDerivatives) {
  std::mt19937 engine(11);
  const auto mesh = test::jittered(test::grid(4, 4, 1, 1), 0.25, 0.2, 5);
  const Positions x = bulged(mesh);
  for (const Bending bending : {Bending::quadratic, Bending::midedge}) {
    const Shell shell = shell_of(mesh, bending, Stretching::stvk);
    Conditions conditions(static_cast<std::size_t>(x.cols()));
    for (const Edge& edge : shell.topology.edges)  // for pressure: a boundary that is held all round
      if (edge.boundary())
        for (const std::uint32_t v : edge.vertex) conditions.hold(v, x.col(v));
    Loads loads;
    loads.gravity << 1, -9.81, 0.3;
    loads.pressure = 200;
    loads.obstacles = {Sphere{{0.5, 0.5, -1.0}, 0.9}, Plane{{0, 0, -0.5}, {0, 0, 1}}};
    loads.gap = 0.7;
    loads.friction = 0.4;
    loads.slip = 0.02;
    const Vector3d origin(0.3, 0.2, 0.1);
    std::vector<std::string> names;
    for (auto& term : Potential::all_terms(shell, conditions, loads, origin)) {
      names.emplace_back(term->name());
      SCOPED_TRACE(names.back());
      const bool linear = term->linear();
      Potential::Terms alone;
      alone.push_back(std::move(term));
      Potential potential(shell, conditions, std::move(alone));
      potential.look_up(x, true);
      Positions slipped = x;  // by half of the slip length: friction pulls
      for (Eigen::Index v = 0; v < x.cols(); ++v)
        if (!conditions.held(0, v)) slipped(0, v) += 0.5 * loads.slip;
      const auto moved = [&](const VectorXd& by) {
        Positions there = slipped;
        potential.advance(there, by, 1);
        return there;
      };
      VectorXd gradient;
      const double energy = potential.value(slipped, &gradient).energy;
      // Bending takes another way where no gradient is asked for: rounding of some hundred summands.
      EXPECT_NEAR(potential.parts(slipped).front().energy, energy, 1e-13 * std::abs(energy));
      EXPECT_GT(gradient.norm(), 0) << "nothing is tested";
      const VectorXd zero = VectorXd::Zero(potential.unknowns());
      test::expect_derivative(
          [&](const VectorXd& by) { return Eigen::Matrix<double, 1, 1>(potential.value(moved(by)).energy); },
          [&](const VectorXd& d) { return Eigen::Matrix<double, 1, 1>(gradient.dot(d)); }, zero, 0.01,
          engine);
      const MatrixXd hessian =
          MatrixXd(potential.hessian(slipped, Curvature::exact)).selfadjointView<Eigen::Lower>();
      EXPECT_EQ(hessian.norm() == 0, linear);
      if (linear) continue;
      test::expect_derivative(
          [&](const VectorXd& by) {
            VectorXd g;
            potential.value(moved(by), &g);
            return g;
          },
          [&](const VectorXd& d) { return VectorXd(hessian * d); }, zero, 0.01, engine);
      const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen{
          MatrixXd(potential.hessian(slipped, Curvature::positive))};  // reads the lower half
      const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
      EXPECT_GE(eigen.eigenvalues()[0], -1e-12 * largest);  // rounding of as many eigenvalues
    }
    EXPECT_THAT(names, testing::IsSupersetOf({"stretching", "bending", "dead loads", "contact", "pressure"}));
    Potential all(shell, conditions, loads, origin);
    all.look_up(x, true);
    double parts = 0;
    for (const auto& part : all.parts(x)) parts += std::abs(part.energy);
    const auto value = all.value(x);
    double together = 0;
    for (const auto& part : all.parts(x)) together += part.energy;
    EXPECT_NEAR(together, value.energy, 1e-13 * parts);  // the order of some hundred summands
  }
}

// A shell that is curved at rest has neither energy nor forces there; flat at rest it has both.
TEST(ShellPotential, CurvedRestShapes) {
  auto mesh = test::grid(4, 4, 1, 1);
  mesh.positions.row(2) = mesh.positions.row(0).array().square().matrix();
  Shell shell = shell_of(mesh, Bending::midedge, Stretching::stvk);
  const Conditions conditions(25);
  const Loads loads;
  VectorXd gradient;
  EXPECT_GT(Potential(shell, conditions, loads).value(mesh.positions, &gradient).energy, 1e-3);
  const double flat = gradient.norm();
  shell.rest_forms = second_forms(shell.topology, shell.rest, mesh.positions);
  const auto value = Potential(shell, conditions, loads).value(mesh.positions, &gradient);
  EXPECT_LT(value.energy, 1e-20);            // squares of rounding
  EXPECT_LT(gradient.norm(), 1e-10 * flat);  // rounding of strains by the stretching's stiffness
}

// Two edges of a triangle may have one vertex across them both: where three triangles meet.
TEST(ShellPotential, VerticesOfThreeTriangles) {
  std::mt19937 engine(8);
  test::Mesh mesh;
  mesh.positions.resize(3, 4);
  mesh.positions << 0, 1, 0.4, 0.5, 0, 0.1, 1, 0.3, 0, 0, 0, 0;
  mesh.faces = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const Shell shell = shell_of(mesh, Bending::midedge, Stretching::stvk);
  const Conditions conditions(4);
  const Loads loads;
  Potential potential(shell, conditions, loads);
  Positions x = bulged(mesh);
  x(2, 3) += 0.3;
  const MatrixXd hessian = MatrixXd(potential.hessian(x, Curvature::exact)).selfadjointView<Eigen::Lower>();
  test::expect_derivative(
      [&](const VectorXd& by) {
        Positions there = x;
        potential.advance(there, by, 1);
        VectorXd g;
        potential.value(there, &g);
        return g;
      },
      [&](const VectorXd& d) { return VectorXd(hessian * d); }, VectorXd(VectorXd::Zero(12)), 0.1, engine);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen{MatrixXd(potential.hessian(x, Curvature::positive))};
  EXPECT_GE(eigen.eigenvalues()[0], -1e-12 * eigen.eigenvalues()[11]);
}

// A quarter between two mirrors against the whole that it is a quarter of: a quarter of the energy, and the
// same forces, of which vertices in a mirror have half, that in both a quarter.
TEST(ShellPotential, MirrorsMakeAQuarterWhatTheWholeIs) {
  std::mt19937 engine(9);
  test::Mesh quarter = test::jittered(test::grid(5, 4, 1, 0.8), 0.2, 0.2, 6);
  const auto count = static_cast<std::uint32_t>(quarter.positions.cols());
  Positions x = bulged(quarter);
  Conditions conditions(count);
  conditions.mirrors = {{0, 0}, {1, 0}};
  for (std::uint32_t v = 0; v < count; ++v)
    for (int axis = 0; axis < 2; ++axis)
      if (quarter.positions(axis, v) < 1e-9) {
        x(axis, v) = 0;
        conditions.hold(v, axis, 0);
      }
  // The other quarters: mirrored vertices are new but in the mirror, mirrored faces run the other way.
  test::Mesh whole;
  std::vector<Vector3d> rest, bent;
  std::vector<std::array<std::uint32_t, 4>> image(count);  // of each vertex in each quarter
  for (std::uint32_t v = 0; v < count; ++v)
    for (std::uint32_t q = 0; q < 4; ++q) {
      const bool on[2] = {conditions.held(0, v), conditions.held(1, v)};
      const std::uint32_t same = q & ~((on[0] ? 1u : 0u) | (on[1] ? 2u : 0u));
      if (same != q) {
        image[v][q] = image[v][same];
        continue;
      }
      const Vector3d turn((q & 1u) != 0 ? -1 : 1, (q & 2u) != 0 ? -1 : 1, 1);
      image[v][q] = static_cast<std::uint32_t>(rest.size());
      rest.push_back(quarter.positions.col(v).cwiseProduct(turn));
      bent.push_back(x.col(v).cwiseProduct(turn));
    }
  for (const Face& face : quarter.faces)
    for (std::uint32_t q = 0; q < 4; ++q) {
      Face other = {image[face[0]][q], image[face[1]][q], image[face[2]][q]};
      if (q == 1 || q == 2) std::swap(other[0], other[1]);
      whole.faces.push_back(other);
    }
  const auto gathered = [](const std::vector<Vector3d>& points) {
    return Positions(
        Eigen::Map<const Positions>(points.front().data(), 3, static_cast<Eigen::Index>(points.size())));
  };
  whole.positions = gathered(rest);
  const Loads loads;
  const Conditions free(rest.size());
  const Shell part = shell_of(quarter, Bending::midedge, Stretching::stvk),
              all = shell_of(whole, Bending::midedge, Stretching::stvk);
  Potential potential(part, conditions, loads);
  const Potential full(all, free, loads);
  VectorXd gradient, forces;
  const double energy = potential.value(x, &gradient).energy,
               four = full.value(gathered(bent), &forces).energy;
  EXPECT_NEAR(energy, four / 4, 1e-13 * four);
  const auto by_vertex = [](const Potential& p, const VectorXd& g, std::size_t vertices) {
    Positions spread = Positions::Zero(3, static_cast<Eigen::Index>(vertices));
    p.advance(spread, g, 1);
    return spread;
  };
  const Positions here = by_vertex(potential, gradient, count), there = by_vertex(full, forces, rest.size());
  for (std::uint32_t v = 0; v < count; ++v) {
    const double share = (conditions.held(0, v) ? 0.5 : 1) * (conditions.held(1, v) ? 0.5 : 1);
    for (int axis = 0; axis < 3; ++axis)
      if (!conditions.held(axis, v)) {
        EXPECT_NEAR(here(axis, v), share * there(axis, image[v][0]), 1e-12 * forces.cwiseAbs().maxCoeff());
      }
  }
  const MatrixXd hessian = MatrixXd(potential.hessian(x, Curvature::exact)).selfadjointView<Eigen::Lower>();
  test::expect_derivative(
      [&](const VectorXd& by) {
        Positions moved = x;
        potential.advance(moved, by, 1);
        VectorXd g;
        potential.value(moved, &g);
        return g;
      },
      [&](const VectorXd& d) { return VectorXd(hessian * d); },
      VectorXd(VectorXd::Zero(potential.unknowns())), 0.1, engine);
}

TEST(ShellPotential, VolumeOfABox) {
  test::Mesh box = test::box({2, 3, 0.5});
  box.positions.colwise() += Vector3d(5, -1, 0);
  EXPECT_NEAR(enclosed_volume(box.faces, box.positions), 3, 1e-12);
}

}  // namespace
}  // namespace plisse::shell
