// The painted assets over their clips: wrinkles that are there at rest, deepen where the animation squeezes,
// and are gone when erased.
#include <gtest/gtest.h>

#include <cmath>

#include "config/scene_file.h"
#include "pipeline/history.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

class PaintedAssets : public test::OpenGlTest {};

config::SceneSettings once(const std::string& asset) {
  config::SceneSettings settings = config::load_scene(test::asset(asset));
  settings.model.loop = false;  // no test needs the round before
  return settings;
}

TEST_F(PaintedAssets, TheSleeveIsWrinkledAtRestAndMoreSoWhereItIsSqueezed) {
  History bare(once("sleeve.toml")), painted(once("sleeve_painted.toml"));
  const auto& bias = painted.scene.waves.bias;
  ASSERT_EQ(bias.size(), painted.scene.surface().vertex_count());
  const auto bare_first = bare.at(1), first = painted.at(1);
  const auto bare_bent = bare.at(37), bent = painted.at(37);
  int there = 0, deeper = 0, squeezed = 0, flatter = 0, pulled = 0;
  for (std::size_t v = 0; v < bias.size(); ++v) {
    const double p2 = glm::dot(bias[v], bias[v]);
    if (p2 == 0) {
      EXPECT_EQ(first.height[v], bare_first.height[v]) << v;  // what was not painted is as it was
      continue;
    }
    if (p2 < 0.1 || !(painted.scene.waves.mask[v] > 0)) continue;
    ++there;
    EXPECT_GT(first.height[v], bare_first.height[v]) << v;
    // M(E − q⊗q): squeezed by the animation as well, the cloth is shorter than by either alone.
    if (bare_bent.compression[v] > 0.1) {
      ++squeezed;
      deeper += bent.compression[v] > first.compression[v] ? 1 : 0;
    }
    if (bare_bent.compression[v] < -0.01) {
      ++pulled;
      flatter += bent.compression[v] < first.compression[v] ? 1 : 0;
    }
  }
  EXPECT_GT(there, 30);
  EXPECT_GT(squeezed, 5);
  // The squeeze need not be along p; where it lies across, p's wrinkles stay.
  EXPECT_GE(deeper, 0.8 * squeezed) << squeezed;
  EXPECT_GE(flatter, 0.8 * pulled) << pulled;
}

TEST_F(PaintedAssets, TheShirtsFoldsAreAsManyAndAsSteepAsItsFileSays) {
  config::SceneSettings settings = once("shirt_painted.toml");
  History run(settings);
  const auto first = run.at(1);
  const auto& bias = run.scene.waves.bias;
  std::size_t painted = 0, drawn = 0;
  for (std::size_t v = 0; v < bias.size(); ++v) {
    EXPECT_LE(glm::length(bias[v]), 0.99);
    if (glm::length(bias[v]) < 0.2 || !(run.scene.waves.mask[v] > 0.5)) continue;
    ++painted;
    drawn += first.height[v] > 0 ? 1 : 0;
  }
  EXPECT_GT(painted, bias.size() / 10);
  EXPECT_EQ(drawn, painted);
}

}  // namespace
}  // namespace plisse::pipeline
