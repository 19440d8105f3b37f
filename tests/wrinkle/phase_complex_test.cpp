// Closed one-forms by construction: their number against Euler's characteristic, their closedness and their
// periods against sums round faces and loops.
#include "wrinkle/phase_complex.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Eigen::VectorXd;
using test::Grid;

// Sum of a one-form round every live face, at most.
double largest_curl(const shell::Topology& topology, const PhaseComplex& complex, const VectorXd& phase,
                    const VectorXd& period) {
  VectorXd form = VectorXd::Constant(static_cast<Eigen::Index>(topology.edges.size()), NAN);
  double worst = 0;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (!complex.live[f]) continue;
    const Eigen::Vector3d c = complex.corner_phases(f, phase, period);
    for (std::size_t i = 0; i < 3; ++i) {
      const double along =
          side_sign(topology, f, i) * (c[static_cast<int>((i + 1) % 3)] - c[static_cast<int>(i)]);
      double& kept = form[side_edge(topology, f, i)];
      // Both faces of an edge have to say the same: closed on each by itself, that makes a one-form.
      if (!std::isnan(kept)) worst = std::max(worst, std::abs(kept - along));
      kept = along;
    }
  }
  return worst;
}

VectorXd random_vector(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return VectorXd::NullaryExpr(static_cast<Eigen::Index>(size), [&] { return normal(random); });
}

// Live components' first Betti number by Euler's characteristic of the live faces, their pinched vertices
// counted once a fan.
std::size_t betti(const shell::Topology& topology, const PhaseComplex& complex, int components, int closed) {
  int edges = 0, faces = 0;
  for (const bool live : complex.live) faces += live ? 1 : 0;
  for (const auto& e : topology.edges) {
    const bool live = complex.live[e.face[0]] || (e.face[1] != shell::none && complex.live[e.face[1]]);
    edges += live ? 1 : 0;
  }
  return static_cast<std::size_t>(components + closed - (static_cast<int>(complex.vertices) - edges + faces));
}

void expect_closed(const shell::Topology& topology, const PhaseComplex& complex) {
  const double worst =
      largest_curl(topology, complex, random_vector(complex.vertices, 1), random_vector(complex.periods, 2));
  EXPECT_LT(worst, 1e-12);  // sums of a few numbers of size 1
}

TEST(PhaseComplex, SheetsHaveALoopAHole) {
  const Grid grid(1, 1, 12, 12);
  const auto topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  const std::vector<bool> none(topology.vertex_count, false);
  for (const int holes : {0, 1, 2, 4}) {
    std::vector<bool> live(grid.faces.size(), true);
    for (std::size_t f = 0; f < live.size(); ++f) {
      for (int k = 0; k < holes; ++k) {
        const Eigen::Vector3d hole(0.25 + 0.5 * (k % 2), 0.25 + 0.5 * (k / 2), 0);
        if ((grid.centre(grid.faces[f]) - hole).cwiseAbs().maxCoeff() < 0.1) live[f] = false;
      }
    }
    const PhaseComplex complex(topology, live, none);
    EXPECT_EQ(complex.periods, static_cast<std::size_t>(holes));
    EXPECT_EQ(complex.periods, betti(topology, complex, 1, 0));
    expect_closed(topology, complex);
  }
}

TEST(PhaseComplex, AnnulusTakesItsPeriodRoundTheHole) {
  const Grid grid(1, 1, 12, 12);
  const auto topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  std::vector<bool> live(grid.faces.size(), true);
  for (std::size_t f = 0; f < live.size(); ++f)
    live[f] = (grid.centre(grid.faces[f]) - Eigen::Vector3d(0.5, 0.5, 0)).cwiseAbs().maxCoeff() > 0.2;
  const PhaseComplex complex(topology, live, std::vector<bool>(topology.vertex_count, false));
  ASSERT_EQ(complex.periods, 1U);
  // Round the rim: all boundary sides of the outer square, which run counterclockwise.
  double round = 0;
  const VectorXd phase = random_vector(complex.vertices, 3), period = VectorXd::Constant(1, 2.5);
  for (std::size_t f = 0; f < live.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (across(topology, f, i) != shell::none) continue;
      const Eigen::Vector3d c = complex.corner_phases(f, phase, period);
      round += c[static_cast<int>((i + 1) % 3)] - c[static_cast<int>(i)];
    }
  }
  EXPECT_NEAR(std::abs(round), 2.5, 1e-12);
}

// A torus of 9 × 7 quads: closed, two loops.
TEST(PhaseComplex, TorusHasTwoLoops) {
  std::vector<shell::Face> faces;
  const auto id = [](int i, int j) { return static_cast<std::uint32_t>((i % 9) * 7 + j % 7); };
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 7; ++j) {
      faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      faces.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  const auto topology = shell::build_topology(faces, 63);
  const PhaseComplex complex(topology, std::vector<bool>(faces.size(), true), std::vector<bool>(63, false));
  EXPECT_EQ(complex.periods, 2U);
  EXPECT_EQ(complex.periods, betti(topology, complex, 1, 1));
  expect_closed(topology, complex);
}

TEST(PhaseComplex, SphereHasNone) {
  const std::vector<shell::Face> faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1},
                                       {5, 2, 1}, {5, 3, 2}, {5, 4, 3}, {5, 1, 4}};
  const auto topology = shell::build_topology(faces, 6);
  const PhaseComplex complex(topology, std::vector<bool>(8, true), std::vector<bool>(6, false));
  EXPECT_EQ(complex.periods, 0U);
  expect_closed(topology, complex);
}

// Two faces that touch in one vertex: of one phase, or of two where no wave passes through it.
TEST(PhaseComplex, PinnedVerticesLetFansGo) {
  const auto topology = shell::build_topology({{0, 1, 2}, {0, 3, 4}}, 5);
  std::vector<bool> pinned(5, false);
  EXPECT_EQ(PhaseComplex(topology, {true, true}, pinned).vertices, 5U);
  pinned[0] = true;
  EXPECT_EQ(PhaseComplex(topology, {true, true}, pinned).vertices, 6U);
}

}  // namespace
}  // namespace plisse::wrinkle
