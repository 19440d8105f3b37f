// Whole-number periods, and the hard cases of a field: each ends in a sensible field.
#include "wrinkle/field.h"

#include <gtest/gtest.h>

#include <numbers>

#include "wrinkle/meshes.h"
#include "wrinkle/wrinkle_free.h"

namespace plisse::wrinkle {
namespace {

using test::Tube;
constexpr double turn = 2 * std::numbers::pi;

// Corners of one vertex differ by whole turns, and sides by what both faces say.
void expect_consistent(const shell::Topology& topology, const Field& field) {
  std::vector<double> first(topology.vertex_count, NAN);
  for (std::size_t f = 0; f < field.phase.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = topology.faces[f][c];
      if (!(field.whole.waves.amplitude[v] > 0)) continue;
      if (std::isnan(first[v])) first[v] = field.phase[f][c];
      EXPECT_NEAR(std::remainder(field.phase[f][c] - first[v], turn), 0, 1e-9);  // phases up to 1e3, rounding
    }
  }
  EXPECT_TRUE(field.whole.waves.amplitude.allFinite());
  EXPECT_GE(field.whole.waves.amplitude.minCoeff(), 0);
}

TEST(WrinkleField, PeriodsBecomeWholeNumbers) {
  const Tube tube(0.02);
  const Field field = tube.solve(test::model(1e6, 0.3, 1e-4));
  ASSERT_TRUE(field.real.converged && field.whole.converged);
  ASSERT_EQ(field.real.waves.period.size(), 1);
  const double real = std::abs(field.real.waves.period[0]) / turn,
               whole = std::abs(field.whole.waves.period[0]) / turn;
  EXPECT_GT(std::abs(real - std::round(real)), 1e-3);  // else this shows nothing
  EXPECT_NEAR(whole, std::round(whole), 1e-12);
  EXPECT_NEAR(field.waves, std::round(real), 1e-9);  // a sum of some hundred phases
  EXPECT_GE(field.whole.energy, field.real.energy * (1 - 1e-9));
  // dφ is off by what the rounding changed, amplitudes hardly.
  EXPECT_NEAR(field.phase_residual, std::abs(whole - real) / real, 0.3 * std::abs(whole - real) / real);
  expect_consistent(tube.topology, field);
  // The neighbouring whole numbers cost more.
  const Problem problem(tube.topology, tube.forms, test::model(1e6, 0.3, 1e-4),
                        std::vector<bool>(tube.forms.size(), false), tube.ends);
  SolveOptions fixed;
  fixed.fixed_periods = true;
  for (const double step : {-1.0, 1.0}) {
    Waves other = field.whole.waves;
    other.period[0] += step * turn;
    EXPECT_GT(solve(problem, other, fixed).energy, field.whole.energy);
  }
}

TEST(WrinkleField, NothingToWrinkle) {
  const Tube tube(0.02);
  const Field none = solve_field(tube.topology, tube.forms, test::model(1e6, 0.3, 1e-4),
                                 std::vector<bool>(tube.forms.size(), true));
  EXPECT_TRUE(none.real.converged);
  EXPECT_EQ(none.whole.waves.amplitude.maxCoeff(), 0);
  const Tube tense(-0.2);  // stretched both ways, but nobody said so
  const Field flat = tense.solve(test::model(1e6, 0.3, 1e-4));
  EXPECT_TRUE(flat.real.converged) << flat.real.reason;
  EXPECT_EQ(flat.whole.waves.amplitude.maxCoeff(), 0);
}

TEST(WrinkleField, OneLiveFace) {
  const Tube tube(0.02);
  std::vector<bool> free(tube.forms.size(), true);
  free[tube.forms.size() / 2] = false;  // all its corners belong to wrinkle-free faces
  const Field field = solve_field(tube.topology, tube.forms, test::model(1e6, 0.3, 1e-4), free);
  EXPECT_TRUE(field.real.converged);
  EXPECT_EQ(field.whole.waves.amplitude.maxCoeff(), 0);
}

TEST(WrinkleField, PatchesApart) {
  const Tube tube(0.02);
  std::vector<bool> free(tube.forms.size(), false);
  for (std::size_t f = 0; f < free.size(); ++f)
    free[f] = (f / 48) == 5 || (f / 48) == 6;  // two rows of faces
  const Field field = solve_field(tube.topology, tube.forms, test::model(1e6, 0.3, 1e-4), free, tube.ends);
  EXPECT_TRUE(field.real.converged && field.whole.converged) << field.real.reason;
  EXPECT_EQ(field.whole.waves.period.size(), 2);
  for (const Eigen::Index row : {1, 8})  // four rows of 24 vertices inside each patch
    EXPECT_GT(field.whole.waves.amplitude.segment(24 * row, 4 * 24).maxCoeff(), 0) << row;
  expect_consistent(tube.topology, field);
}

// Waves across a sheet with two holes go past both: periods round them are there, and 0.
TEST(WrinkleField, HolesThatNoWaveGoesRound) {
  test::Grid grid(0.4, 0.3, 20, 15);
  std::vector<shell::Face> faces;
  for (const shell::Face& f : grid.faces) {
    const Eigen::Vector3d c = grid.centre(f);
    if ((c - Eigen::Vector3d(0.12, 0.15, 0)).norm() > 0.04 &&
        (c - Eigen::Vector3d(0.3, 0.12, 0)).norm() > 0.03)
      faces.push_back(f);
  }
  ASSERT_LT(faces.size(), grid.faces.size());
  grid.faces = faces;
  const auto forms = test::prescribed(
      grid, [](const Eigen::Vector3d&) { return test::diagonal(-0.3 * 0.02 - 0.01, 0.02); },
      [](const Eigen::Vector3d&) { return test::diagonal(0, 0.5); });
  const shell::Topology topology = shell::build_topology(faces, static_cast<std::size_t>(grid.rest.cols()));
  const Model model = test::model(1e6, 0.3, 1e-3);
  const Field field = solve_field(topology, forms, model, std::vector<bool>(faces.size(), false));
  EXPECT_TRUE(field.real.converged && field.whole.converged) << field.real.reason;
  ASSERT_EQ(field.whole.waves.period.size(), 2);
  EXPECT_NEAR(field.whole.waves.period.cwiseAbs().maxCoeff(), 0, 1e-12);
  // One wave vector all over, as on a sheet without holes: |ω|⁴ = 12(1 − ν²)κ²/h² (docs/wrinkle.md).
  const double waves = std::pow(12 * (1 - 0.09) * 0.25, 0.25) / std::sqrt(1e-3) * 0.4 / turn;
  EXPECT_NEAR(field.waves / waves, 1, 1e-3);
  expect_consistent(topology, field);
}

TEST(WrinkleField, ExtremeMaterialsAndStrains) {
  const struct {
    const char* what;
    double compression, poisson, thickness, curvature;
    bool wrinkles;
  } cases[] = {{"incompressible", 0.02, 0.5, 1e-4, 0, true},
               {"thin as a soap film", 0.02, 0.3, 1e-6, 0, true},
               {"collapsed", 0.98, 0.3, 1e-4, 0, true},
               {"bent along its crests", 0.02, 0.3, 1e-4, 1.5, true},
               {"compressed a little", 1e-6, 0.3, 1e-4, 0, false}};
  for (const auto& c : cases) {
    const Tube tube(c.compression, c.poisson, 0.05 * (c.compression > 0.5 ? 0.01 : 1), c.curvature);
    const Field field = tube.solve(test::model(1e6, c.poisson, c.thickness));
    EXPECT_TRUE(field.real.converged) << c.what << ": " << field.real.reason;
    EXPECT_TRUE(field.whole.converged) << c.what << ": " << field.whole.reason;
    EXPECT_EQ(field.whole.waves.amplitude.maxCoeff() > 0, c.wrinkles)
        << c.what << " " << field.whole.waves.amplitude.maxCoeff();
    expect_consistent(tube.topology, field);
  }
}

}  // namespace
}  // namespace plisse::wrinkle
