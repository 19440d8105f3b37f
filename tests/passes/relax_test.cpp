// Relax on the GPU against closed forms of eq. 6, its limit of stability, exact plane waves, and the
// published plateau of the descent.
#include "passes/relax.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <queue>
#include <random>

#include "support/opengl.h"
#include "support/sheets.h"

namespace plisse::passes {
namespace {

using std::numbers::pi;
using test::Passes;
using test::Readings;
using test::Sheet;
using test::wrap_radians;

class Relax : public test::OpenGlTest {};

enum Status { idle = 0, set = 1, fresh = 2 };
// A phase near π has 2.4e-7 rad between neighbouring floats; a step sums a handful of them.
constexpr double rounding = 2e-6;

// Neighbours as given, no triangles, everything at one place: what is left of eq. 6 is the difference of
// phases.
Sheet only_neighbours(const std::vector<std::vector<std::uint32_t>>& lists) {
  Sheet sheet = test::sheet(std::vector<glm::dvec3>(lists.size(), glm::dvec3(0)), {});
  sheet.surface.neighbours = {};
  for (const auto& list : lists) {
    auto& rows = sheet.surface.neighbours;
    rows.items.insert(rows.items.end(), list.begin(), list.end());
    rows.offsets.push_back(static_cast<std::uint32_t>(rows.items.size()));
  }
  sheet.rest = rest_frames(sheet.surface);
  return sheet;
}

void set_flat(Passes& passes, const std::vector<double>& phases, std::vector<double> weights = {},
              std::vector<int> status = {}) {
  weights.resize(phases.size(), 1.0);
  status.resize(phases.size(), set);
  passes.pose({glm::dmat4(1)});
  passes.set_waves(std::vector<glm::dvec3>(phases.size(), glm::dvec3(0)), weights);
  passes.set_phases(phases, status);
}

// One round of descent alone.
RelaxOptions descent(double epsilon, int rounds = 1) {
  RelaxOptions options;
  options.rounds = rounds;
  options.epsilon = epsilon;
  options.onset = false;
  return options;
}
RelaxOptions onset(int spreading, int smoothing) {
  RelaxOptions options;
  options.rounds = 0;
  options.onset_rounds = spreading;
  options.smoothing_rounds = smoothing;
  return options;
}

TEST_F(Relax, AStepOfTwoPiSquaredMovesToTheMean) {
  Passes passes(only_neighbours({{1, 2, 3}, {0}, {0}, {0}}));
  set_flat(passes, {0.1, 0.5, 0.9, 1.3});
  passes.relax(descent(2 * pi * pi));
  Readings now = passes.read();
  EXPECT_NEAR(now.phase[0], 0.9, rounding);
  for (std::size_t v = 1; v < 4; ++v) EXPECT_NEAR(now.phase[v], 0.1, rounding);

  // N counts a neighbour that weighs nothing or has no phase; ε/(2π²) of the way.
  set_flat(passes, {0.1, 0.5, 0.9, 1.3}, {1, 1, 0.5, 0}, {set, set, set, set});
  passes.relax(descent(pi * pi));
  EXPECT_NEAR(passes.read().phase[0], 0.1 + 0.5 * (0.4 + 0.5 * 0.8) / 3, rounding);
  set_flat(passes, {0.1, 0.5, 0.9, 1.3}, {}, {set, set, set, idle});
  passes.relax(descent(2 * pi * pi));
  now = passes.read();
  EXPECT_NEAR(now.phase[0], 0.1 + (0.4 + 0.8) / 3, rounding);
  EXPECT_EQ(now.phase[3], static_cast<double>(1.3F));  // idle: left alone
  EXPECT_EQ(now.status[3], idle);
}

TEST_F(Relax, GoesTheShorterWayRound) {
  Passes passes(only_neighbours({{1}, {0}}));
  set_flat(passes, {3, -3}, {0, 1});  // vertex 0 weighs nothing: 1 stays
  passes.relax(descent(2 * pi * pi));
  const Readings now = passes.read();
  EXPECT_NEAR(now.phase[0], -3, rounding);
  EXPECT_NEAR(now.phase[1], -3, rounding);
  set_flat(passes, {3, -3}, {0, 1});
  passes.relax(descent(pi * pi));  // half way: 3 + .1416 = π, which is inside (−π, π]
  EXPECT_NEAR(std::abs(passes.read().phase[0]), pi, rounding);
}

TEST_F(Relax, TwoWavesMeetInTheMiddleOfTheirEdge) {
  const Sheet sheet = test::sheet({{0, 0, 0}, {1, 0.5, 0}, {0.3, 1, 0}}, {0, 1, 2});
  Passes passes(sheet);
  passes.pose({glm::dmat4(1)});
  for (const double sign : {1.0, -1.0}) {
    const std::vector<glm::dvec3> waves{{0.3, 0.1, 0.05}, sign * glm::dvec3(0.35, 0.1, -0.02), {0, 0, 0}};
    passes.set_waves(waves, {0, 1, 0});  // only 1 weighs, only 0 asks it: of two neighbours
    passes.set_phases({1.2, 0.4, 0}, {set, set, idle});
    passes.relax(descent(4 * pi * pi));  // N = 2
    const Readings now = passes.read();
    const glm::dvec3 middle = 0.5 * (now.position[0] + now.position[1]);
    const auto wave = [&](std::size_t v) {
      return std::cos(2 * pi * glm::dot(waves[v], middle - now.position[v]) + now.phase[v]);
    };
    EXPECT_NEAR(wave(0), wave(1), 2 * rounding) << sign;
    EXPECT_NE(now.phase[0], 1.2) << sign;
  }
}

// 2π² = 19.74 is the limit where the mesh has two colours: the checkerboard is multiplied by 1 − ε/π² a
// round.
TEST_F(Relax, StabilityEndsAtTwoPiSquaredOnQuads) {
  constexpr int side = 8;
  std::vector<std::vector<std::uint32_t>> lists;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      lists.emplace_back();
      for (const auto& [x, y] :
           {std::pair(i, j - 1), std::pair(i - 1, j), std::pair(i + 1, j), std::pair(i, j + 1)}) {
        if (x >= 0 && y >= 0 && x < side && y < side)
          lists.back().push_back(static_cast<std::uint32_t>(y * side + x));
      }
    }
  }
  Passes passes(only_neighbours(lists));
  std::vector<double> start;
  std::vector<double> degree;
  double degrees = 0;
  for (int v = 0; v < side * side; ++v) {
    start.push_back(((v % side + v / side) % 2 == 0 ? 1e-3 : -1e-3));
    degree.push_back(static_cast<double>(lists[static_cast<std::size_t>(v)].size()));
    degrees += degree.back();
  }
  for (const auto& [epsilon, rounds] : {std::pair(19.0, 20), std::pair(19.0, 100), std::pair(20.5, 40)}) {
    set_flat(passes, start);
    passes.relax(descent(epsilon, rounds));
    const double expected =
        1e-3 * std::pow(1 - epsilon / (pi * pi), rounds);  // .925^100 = 4e-4, 1.077^40 = 19.5
    const Readings now = passes.read();
    for (std::size_t v = 0; v < start.size(); ++v) {
      EXPECT_NEAR(now.phase[v], start[v] > 0 ? expected : -expected, 0.01 * std::abs(expected) + 1e-7)
          << epsilon << " " << v;
    }
  }
}

// --- waves on jittered grids
// -------------------------------------------------------------------------------------------------

// The grid squeezed to half its width along x: κ = 2/W there, each with a sign of its own.
struct Squeezed {
  explicit Squeezed(const Sheet& of, double W, unsigned seed) : sheet(of), passes(of) {
    std::mt19937 random(seed);
    std::bernoulli_distribution flip;
    passes.pose(mapped(sheet, [](const glm::dvec3& x) { return glm::dvec3(0.5 * x.x, x.y, 0); }));
    for (std::size_t v = 0; v < sheet.size(); ++v) waves.emplace_back((flip(random) ? -2 : 2) / W, 0, 0);
    passes.set_waves(waves, std::vector<double>(sheet.size(), 1.0));
    const Readings now = passes.read();
    for (std::size_t v = 0; v < sheet.size(); ++v) {  // the plane wave with its crest at the origin
      exact.push_back(wrap_radians(2 * pi * glm::dot(waves[v], now.position[v])));
    }
    std::uniform_real_distribution<double> phase(-pi, pi);
    for (std::size_t v = 0; v < sheet.size(); ++v) random_phases.push_back(phase(random));
  }
  Sheet sheet;
  Passes passes;
  std::vector<glm::dvec3> waves;
  std::vector<double> exact, random_phases;
};

TEST_F(Relax, APlaneWaveFitsItself) {
  Squeezed square(test::grid(9, 9, 0.1, 0.3, 1), 0.17, 2);
  square.passes.set_phases(square.exact, std::vector<int>(81, set));
  // A phase is 1e-6 of a turn off after κ·x of up to 10 turns in single precision.
  EXPECT_LT(misfit(square.sheet.surface, square.passes.read()), 1e-11);
  square.passes.relax(descent(13.2, 10));
  const Readings now = square.passes.read();
  for (std::size_t v = 0; v < 81; ++v)
    EXPECT_NEAR(wrap_radians(now.phase[v] - square.exact[v]), 0, 10 * rounding) << v;
}

TEST_F(Relax, OnsetContinuesAPlaneWave) {
  Squeezed square(test::grid(10, 8, 0.1, 0.3, 21), 0.17, 22);
  std::vector<int> status(80, fresh);
  std::vector<double> phases = square.random_phases;
  std::queue<std::size_t> front;
  std::vector<int> distance(80, -1);  // in edges, from the first column
  for (std::size_t v = 0; v < 80; ++v) {
    if (v % 10 > 0) continue;
    status[v] = set;
    phases[v] = square.exact[v];
    distance[v] = 0;
    front.push(v);
  }
  status[45] = idle;
  for (; !front.empty(); front.pop()) {
    const std::size_t v = front.front();
    const auto& rows = square.sheet.surface.neighbours;
    for (std::uint32_t i = rows.offsets[v]; i < rows.offsets[v + 1]; ++i) {
      const std::uint32_t n = rows.items[i];
      if (distance[n] >= 0 || n == 45) continue;
      distance[n] = distance[v] + 1;
      front.push(n);
    }
  }
  for (const int rounds : {3, 20}) {
    square.passes.set_phases(phases, status);
    square.passes.relax(onset(rounds, 0));
    const Readings now = square.passes.read();
    int reached = 0;
    for (std::size_t v = 0; v < 80; ++v) {
      if (v == 45) {
        EXPECT_EQ(now.status[v], idle);
        EXPECT_EQ(now.phase[v], static_cast<double>(static_cast<float>(phases[v])));
        continue;
      }
      EXPECT_EQ(now.status[v], set) << v;
      // Nine transports of up to .6 turns; those out of reach keep what they had.
      const bool within = distance[v] <= rounds;
      EXPECT_NEAR(wrap_radians(now.phase[v] - (within ? square.exact[v] : phases[v])), 0, 1e-5)
          << v << " " << rounds;
      reached += within ? 1 : 0;
    }
    if (rounds == 3)
      EXPECT_LT(reached, 79);
    else
      EXPECT_EQ(reached, 79);
  }
}

TEST_F(Relax, OnsetLeavesTheSetOnesToTheBit) {
  Squeezed square(test::grid(8, 8, 0.1, 0.3, 31), 0.17, 32);
  std::vector<int> status(64, set);
  for (const std::size_t v : {10U, 11U, 35U, 63U}) status[v] = fresh;
  square.passes.set_phases(square.random_phases, status);
  const Readings before = square.passes.read();
  square.passes.relax(onset(2, 20));
  const Readings now = square.passes.read();
  for (std::size_t v = 0; v < 64; ++v) {
    if (status[v] == set)
      EXPECT_EQ(now.phase[v], before.phase[v]) << v;
    else
      EXPECT_NE(now.phase[v], before.phase[v]) << v;
    EXPECT_EQ(now.status[v], set);
  }
}

TEST_F(Relax, SmoothingFindsTheWave) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    constexpr double W = 0.2;
    Squeezed square(test::grid(12, 12, 0.1, 0.3, seed, W), W, 200 + seed);
    square.passes.set_phases(square.random_phases, std::vector<int>(144, fresh));
    square.passes.relax(onset(8, 300));
    const Readings now = square.passes.read();
    EXPECT_LT(misfit(square.sheet.surface, now), 1e-3) << seed;  // wrinkle-passes.md, "Ground truth": good
    double amplitude = 0, edges = 0, gained = 0, run = 0;
    const auto& rows = square.sheet.surface.neighbours;
    for (std::size_t v = 0; v < 144; ++v) {
      for (std::uint32_t i = rows.offsets[v]; i < rows.offsets[v + 1]; ++i) {
        const std::uint32_t n = rows.items[i];
        const double d = disagreement(now, v, n);
        amplitude += std::abs(std::cos(pi * d));
        edges += 1;
        // Least squares of phase gained over distance, along x: the slope is 1/wavelength in the pose.
        const double dx = now.position[n].x - now.position[v].x;
        gained += dx * (2 / W * dx + (square.waves[v].x < 0 ? -d : d));
        run += dx * dx;
      }
    }
    EXPECT_GT(amplitude / edges, 0.99) << seed;
    EXPECT_NEAR(run / gained, 0.5 * W, 0.02 * 0.5 * W) << seed;  // rW ± 2 %
  }
}

TEST_F(Relax, SmoothingIgnoresIdleNeighbours) {
  // 0 – 1 – 2 in a row at one place; 1 is fresh. From z₁ = 1 and a neighbour held at i, z goes (½ + ½i), (¼ +
  // ¾i), …
  Passes passes(only_neighbours({{1}, {0, 2}, {1}}));
  for (const int other : {idle, set}) {
    set_flat(passes, {pi / 2, 0, pi}, {}, {set, fresh, other});
    passes.relax(onset(0, 2));
    // With 2 held at −1 the mean is (i − 1)/2: z = ½·1 + ½·that, twice: (−1/8 + 3/8 i).
    const double expected = other == idle ? std::atan2(0.75, 0.25) : std::atan2(0.375, -0.125);
    EXPECT_NEAR(passes.read().phase[1], expected, rounding) << other;
  }
  // Alone among idle ones it keeps its phase.
  set_flat(passes, {1, 2, 3}, {}, {idle, fresh, idle});
  passes.relax(onset(8, 300));
  EXPECT_NEAR(passes.read().phase[1], 2, rounding);
  EXPECT_EQ(passes.read().status[1], set);
}

// wrinkle-passes.md: from 1/12 turns² of random phases to a plateau of .024–.030 as a mean of many seeds. All
// grids are one surface, so it costs one run.
TEST_F(Relax, DescentGetsStuckWhereThePaperDoesSlow) {
  constexpr int seeds = 128;
  constexpr double W = 0.2;
  Squeezed squares(test::grid(12, 12, 0.1, 0.3, 5, W, seeds), W, 6);
  const std::vector<int> all_set(squares.sheet.size(), set);
  squares.passes.set_phases(squares.random_phases, all_set);
  // d² of a uniform d has standard deviation .0745; 385 edges a grid.
  EXPECT_NEAR(misfit(squares.sheet.surface, squares.passes.read()), 1.0 / 12,
              5 * 0.0745 / std::sqrt(385.0 * seeds));
  squares.passes.relax(descent(13.2, 100));  // 300 rounds more change it by .0005
  const double plateau = misfit(squares.sheet.surface, squares.passes.read());
  RecordProperty("plateau", std::to_string(plateau));
  EXPECT_GT(plateau, 0.024);
  EXPECT_LT(plateau, 0.030);
}

TEST_F(Relax, StartPhasesAreUniform) {
  constexpr std::size_t count = 20000;
  std::vector<int> bins(20);
  double cosine = 0, sine = 0;
  for (std::uint32_t v = 0; v < count; ++v) {
    const double phase = static_cast<double>(initial_phase(7, v));
    ASSERT_GT(phase, -pi - 1e-6);
    ASSERT_LE(phase, pi + 1e-6);
    ++bins[static_cast<std::size_t>(std::clamp((phase + pi) / (2 * pi) * 20, 0.0, 19.0))];
    cosine += std::cos(phase);
    sine += std::sin(phase);
  }
  // 1000 a bin with deviation 31; means with deviation √(½/count) = .005.
  for (const int bin : bins) EXPECT_NEAR(bin, 1000, 5 * 31);
  EXPECT_NEAR(cosine / count, 0, 5 * 0.005);
  EXPECT_NEAR(sine / count, 0, 5 * 0.005);
  EXPECT_NE(initial_phase(7, 0), initial_phase(8, 0));
}

}  // namespace
}  // namespace plisse::passes
