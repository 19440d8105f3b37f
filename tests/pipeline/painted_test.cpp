// The painted assets over their clips: wrinkles that are there at rest, deepen where the animation squeezes,
// and are gone when erased.
#include <gtest/gtest.h>

#include <cmath>

#include "config/scene_file.h"
#include "io/picture/png.h"
#include "paint/bias_file.h"
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

// Random folds over all of a model, written as its uv texture and read again: within a step of eight bits in
// length and a degree in direction, whatever its uv do (sleeves and shirts repeat a pattern; the Knight's
// islands lie on each other).
void expect_texture_of(const std::filesystem::path& model) {
  const LoadedScene scene(config::bare_scene(model));
  std::vector<glm::dvec3> bias;
  for (std::size_t v = 0; v < scene.surface().vertex_count(); ++v) {
    const auto id = static_cast<double>(v);
    const double angle = 1.7 * id, length = 0.05 + 0.9 * std::abs(std::sin(0.37 * id));
    const glm::dvec3 &t = scene.rest.tangent[v], &n = scene.rest.normal[v];
    bias.push_back(length * (std::cos(angle) * t + std::sin(angle) * glm::cross(n, t)));
  }
  const test::TemporaryFolder folder;
  io::write_png(folder / "bias.png", paint::encode_bias(scene.surface(), scene.rest, bias, 1024));
  const auto back = paint::read_bias(folder / "bias.png", scene.surface(), scene.rest).bias;
  std::vector<bool> has_uv(bias.size(), false);
  for (const Part& part : scene.surface().parts)
    for (std::size_t c = 3 * part.first_triangle; c < 3 * (part.first_triangle + part.triangle_count); ++c)
      if (part.has_uv) has_uv[scene.surface().render_vertices[scene.surface().triangles[c]].welded] = true;
  for (std::size_t v = 0; v < bias.size(); ++v) {
    if (!has_uv[v]) continue;
    EXPECT_NEAR(glm::length(back[v]), glm::length(bias[v]), 1.0 / 255) << model << " " << v;
    EXPECT_GT(std::abs(glm::dot(glm::normalize(back[v]), glm::normalize(bias[v]))),
              std::cos(glm::radians(1.0)))
        << model << " " << v;
  }
}

TEST(PaintedTextures, OfTheAssetsComeBack) {
  expect_texture_of(test::asset("sleeve.glb"));
  expect_texture_of(test::asset("shirt.glb"));
}

TEST(PaintedTextures, OfOtherPeoplesModelsComeBack) {
  const std::filesystem::path models = test::shared_data("models");
  if (!std::filesystem::exists(models)) GTEST_SKIP() << "the shared models are not here";
  for (const char* name : {"KayKit_Knight.glb", "huesitos.fbx", "Fox.glb"}) expect_texture_of(models / name);
}

}  // namespace
}  // namespace plisse::pipeline
