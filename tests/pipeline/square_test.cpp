// The paper's ground truth (wrinkle-passes.md, "Ground truth"): the square of 148 triangles through the whole
// chain, its clip starting at rest and wrinkling on the way to 98, 75 and 50 %.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "config/scene_file.h"
#include "pipeline/history.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

using std::numbers::pi;
using test::Readings;

class Square : public test::OpenGlTest {};

struct Measures {
  double misfit = 0;       // turns²
  double amplitude = 0;    // ⟨|cos(Δψ/2)|⟩ at the edges' middles
  double wavelength = 0;   // along x, in the pose, model units
  double parallelism = 0;  // ⟨|κ̂·x̂|⟩
};

Measures measure(const Surface& surface, const Readings& now) {
  Measures result;
  result.misfit = test::misfit(surface, now);
  double edges = 0, gained = 0, run = 0;
  const auto& rows = surface.neighbours;
  for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
    result.parallelism +=
        std::abs(glm::normalize(now.wave[v]).x) / static_cast<double>(surface.vertex_count());
    for (std::uint32_t i = rows.offsets[v]; i < rows.offsets[v + 1]; ++i) {
      const std::uint32_t n = rows.items[i];
      const double d = test::disagreement(now, v, n), dx = now.position[n].x - now.position[v].x;
      result.amplitude += std::abs(std::cos(pi * d));
      edges += 1;
      // The phase gained from vertex to vertex, against the distance along x: least squares give turns per
      // length.
      const double mean_wave = 0.5 * (std::abs(now.wave[v].x) + std::abs(now.wave[n].x));
      gained += dx * (mean_wave * dx + (now.wave[v].x < 0 ? -d : d));
      run += dx * dx;
    }
  }
  result.amplitude /= edges;
  result.wavelength = run / gained;
  return result;
}

constexpr std::array<std::pair<int, double>, 3> squeezes{{{25, 0.98}, {49, 0.75}, {73, 0.5}}};
constexpr std::array<double, 3> heights_in_W{0.04975, 0.16536, 0.21651};

TEST_F(Square, HeightsDirectionsAndWavenumbers) {
  History run(config::load_scene(test::asset("square.toml")));
  const double W = run.scene.wavelength() / run.scene.units.metres;
  for (std::size_t i = 0; i < squeezes.size(); ++i) {
    const auto [frame, r] = squeezes[i];
    const Readings now = run.at(frame);
    for (std::size_t v = 0; v < now.height.size(); ++v) {
      EXPECT_NEAR(1 - now.compression[v], r, 1e-5) << v;  // the tolerance
      EXPECT_NEAR(now.height[v] / W, heights_in_W[i], 1e-5) << v;
      EXPECT_NEAR(glm::length(now.wave[v]) * W, 1 / r, 1e-4) << v;
      EXPECT_NEAR(std::abs(glm::normalize(now.wave[v]).x), 1, 1e-6) << v;
      EXPECT_EQ(now.status[v], 1) << v;
    }
  }
}

TEST_F(Square, PhasesMakeOneWave) {
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
    config::SceneSettings settings = config::load_scene(test::asset("square.toml"));
    settings.wrinkles.seed = seed;
    History run(settings);
    const double W = run.scene.wavelength() / run.scene.units.metres;
    for (const auto& [frame, r] : squeezes) {
      const Measures now = measure(run.scene.surface(), run.at(frame));
      EXPECT_LT(now.misfit, 1e-3) << seed << " " << r;
      EXPECT_GT(now.amplitude, 0.99) << seed << " " << r;
      EXPECT_NEAR(now.wavelength / (r * W), 1, 0.02) << seed << " " << r;
      EXPECT_NEAR(now.parallelism, 1, 1e-6) << seed << " " << r;
    }
  }
}

// However the onset falls: at other frame rates other vertices leave the dead zone first, some of them by
// rounding alone (at 24 a second all are within 1e-7 of its rim in frame 7), and crush may run every third
// frame only.
TEST_F(Square, OneWaveHoweverItBegins) {
  for (const double fps : {10.0, 30.0, 47.0}) {
    for (const int interval : {1, 3}) {
      config::SceneSettings settings = config::load_scene(test::asset("square.toml"));
      settings.model.frames_per_second = fps;
      settings.relax.interval = interval;
      History run(settings);
      const double W = run.scene.wavelength() / run.scene.units.metres;
      const int last = run.scene.animation.timeline().frame_count;
      const Readings now = run.at(last - (last - 1) % interval);
      const Measures measures = measure(run.scene.surface(), now);
      EXPECT_LT(measures.misfit, 1e-3) << fps << " " << interval;
      EXPECT_NEAR(measures.wavelength * glm::length(now.wave[0]), 1, 0.02) << fps << " " << interval;
      EXPECT_NEAR(now.height[0] / W, 0.25 * std::sqrt(1 - std::pow(1 - now.compression[0], 2)), 1e-5);
    }
  }
}

// A clip that begins wrinkled: everything is fresh in the first frame, nothing is set.
TEST_F(Square, OneWaveFromTheFirstFrame) {
  config::SceneSettings settings = config::load_scene(test::asset("square.toml"));
  settings.model.rest = "bind";
  settings.model.frames_per_second = 0.5;  // frames at 0 s and 2 s: from rest to 75 % in one step
  History run(settings);
  const Measures now = measure(run.scene.surface(), run.at(2));
  EXPECT_LT(now.misfit, 1e-3);
  EXPECT_GT(now.amplitude, 0.99);
}

// wrinkle-passes.md: the paper's descent from random phases ends at E[d²] of .026–.028 on the square, ⟨|cos|⟩
// of about .85 and wavelengths that are 15 % off; it would not pass the tests above. 32 seeds: one alone is
// anywhere in .010–.047.
TEST_F(Square, ThePapersDescentGetsStuckSlow) {
  constexpr int seeds = 32;
  double misfit = 0, amplitude = 0;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    config::SceneSettings settings = config::load_scene(test::asset("square.toml"));
    settings.model.frames_per_second = 1;
    settings.relax.mode = config::RelaxMode::descent;
    settings.relax.rounds = 100;
    settings.wrinkles.seed = seed;
    History run(settings);
    const Measures now = measure(run.scene.surface(), run.at(4));
    misfit += now.misfit / seeds;
    amplitude += now.amplitude / seeds;
  }
  EXPECT_GT(misfit, 0.02);
  EXPECT_LT(misfit, 0.034);
  EXPECT_NEAR(amplitude, 0.85, 0.04);
}

}  // namespace
}  // namespace plisse::pipeline
