// What the descent is made of, beside the closed forms of prescribed_test.cpp: second derivatives against
// differences of the gradient, parts that have to be positive semidefinite, and how a search ends.
#include "wrinkle/solve.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::diagonal;
using test::Grid;

const Model material = test::model(1e6, 0.3, 1e-3);

// A curved sheet, compressed along y and a little turned, so that no two faces are alike.
Problem curved_sheet() {
  const Grid grid(0.4, 0.3, 6, 5);
  return Problem(shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols())),
                 test::prescribed(
                     grid,
                     [](const Eigen::Vector3d& x) {
                       return Eigen::Matrix2d(diagonal(0.02, -0.05 - 0.1 * x.x()) +
                                              0.02 * x.y() * Eigen::Matrix2d::Ones());
                     },
                     [](const Eigen::Vector3d&) { return diagonal(2, 0); }),
                 material, std::vector<bool>(grid.faces.size(), false));
}

// The start of a search with some waves too high and others flat: far from a minimum.
VectorXd uneven(const Problem& problem) {
  VectorXd x = problem.pack(initial_waves(problem));
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] *= 1 + 0.3 * std::sin(7.0 * static_cast<double>(i));
  return x;
}

MatrixXd whole(const Eigen::SparseMatrix<double>& lower) {
  return MatrixXd(lower).selfadjointView<Eigen::Lower>();
}

double least_eigenvalue(const MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

TEST(WrinkleSolve, TheHessianIsThatOfDifferences) {
  const Problem problem = curved_sheet();
  const VectorXd x = uneven(problem);
  Problem::Curvature curvature(problem);
  VectorXd first, up, down;
  EXPECT_DOUBLE_EQ(curvature.at(x, first), problem.energy(x));
  const MatrixXd exact = whole(curvature.exact());
  const double size = exact.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    constexpr double step = 1e-5;
    const VectorXd d = step * VectorXd::Unit(x.size(), i);
    problem.gradient(x + d, up);
    problem.gradient(x - d, down);
    // Central differences: step² and rounding over the step, with room for third derivatives.
    EXPECT_LT(((up - down) / (2 * step) - exact.col(i)).cwiseAbs().maxCoeff(), 1e-6 * size) << i;
  }
}

TEST(WrinkleSolve, WhatMakesItDefinite) {
  const Problem problem = curved_sheet();
  Problem::Curvature curvature(problem);
  VectorXd first;
  curvature.at(uneven(problem), first);
  const MatrixXd exact = whole(curvature.exact()), nearest = whole(curvature.nearest()),
                 lift = whole(curvature.lift()), metric = whole(curvature.metric());
  const double size = exact.cwiseAbs().maxCoeff(),
               rounding = 1e-8 * size;               // of eigenvalues; lift: 1e-10 a face
  EXPECT_LT(least_eigenvalue(exact), -1e-4 * size);  // else this shows nothing
  EXPECT_GT(least_eigenvalue(metric), -rounding);
  EXPECT_GT(least_eigenvalue(nearest), -rounding);
  EXPECT_GT(least_eigenvalue(exact + nearest), -rounding);
  EXPECT_GT(least_eigenvalue(exact + lift), -rounding);
}

// A search that is not to end below a given energy stops early, and says that it did not converge.
TEST(WrinkleSolve, AHopelessSearchIsGivenUp) {
  const Problem problem = curved_sheet();
  const Waves start = initial_waves(problem);
  const Solution free = solve(problem, start);
  ASSERT_TRUE(free.converged) << free.reason;
  SolveOptions options;
  options.target = free.energy - 0.5 * (free.energy - problem.relaxed_energy());
  const Solution given_up = solve(problem, start, options);
  EXPECT_FALSE(given_up.converged);
  EXPECT_EQ(given_up.reason, "does not come below the target");
  EXPECT_LT(given_up.iterations, free.iterations);
  options.target = free.energy;  // within reach
  const Solution reached = solve(problem, start, options);
  EXPECT_NEAR(reached.energy / free.energy, 1, 1e-9);
}

// Where no step is worth the rounding of the energy, that is the end of the search, and a good one.
TEST(WrinkleSolve, WhatIsBelowRoundingHasConverged) {
  const Problem problem = curved_sheet();
  SolveOptions options;
  options.kkt = 0;  // no residual is small enough
  const Solution solution = solve(problem, initial_waves(problem), options);
  EXPECT_TRUE(solution.converged) << solution.reason;
  EXPECT_EQ(solution.reason, "what is left is below the rounding of the energy");
  EXPECT_LT(solution.kkt, 1e-6);
}

// No wave is higher than the room at its vertex, also where the whole field is searched for; what is bounded
// has more energy, and elsewhere waves stay.
TEST(WrinkleSolve, RoomBoundsTheWaves) {
  const Grid grid(0.4, 0.3, 6, 5);
  const auto topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  auto forms = test::prescribed(
      grid, [](const Eigen::Vector3d&) { return diagonal(0.02, -0.1); },
      [](const Eigen::Vector3d&) { return diagonal(2, 0); });
  const std::vector<bool> none(grid.faces.size(), false);
  const Field free = solve_field(topology, forms, material, none);
  const double highest = free.whole.waves.amplitude.maxCoeff();
  VectorXd room = VectorXd::Constant(grid.rest.cols(), INFINITY);
  for (Eigen::Index v = 0; v < room.size(); ++v)
    if (grid.rest(0, v) < 0.2) room[v] = 0.3 * highest;
  for (std::size_t f = 0; f < forms.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) forms[f].room[c] = room[topology.faces[f][c]];
  const Field bounded = solve_field(topology, forms, material, none);
  ASSERT_TRUE(bounded.real.converged && bounded.whole.converged);
  // Bounds are kept to rounding of the scale that amplitudes are solved in.
  EXPECT_LE((bounded.whole.waves.amplitude - room).maxCoeff(), 1e-12);
  EXPECT_GT(bounded.whole.waves.amplitude.maxCoeff(), 0.5 * highest);
  EXPECT_GT(bounded.whole.energy, free.whole.energy);
}

TEST(WrinkleSolve, NoFaceIsCompressed) {
  const Grid grid(0.4, 0.3, 6, 5);
  const auto forms = test::prescribed(
      grid, [](const Eigen::Vector3d&) { return diagonal(0.02, 0.01); }, test::no_form);
  const auto topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  const Field field = solve_field(topology, forms, material, std::vector<bool>(grid.faces.size(), true));
  EXPECT_TRUE(field.real.converged && field.whole.converged);
  EXPECT_EQ(field.iterations, 0);
  EXPECT_EQ(field.waves, 0);
  EXPECT_EQ(field.wavelength, 0);
  EXPECT_EQ(field.whole.waves.amplitude.maxCoeff(), 0);
}

}  // namespace
}  // namespace plisse::wrinkle
