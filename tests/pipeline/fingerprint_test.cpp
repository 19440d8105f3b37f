// What decides a frame's pixels decides its fingerprint: whatever setting changes, another scene's frame is
// never taken for one of this. (That frames are drawn anew then: tests/pipeline/frames_test.cpp.)
#include "pipeline/fingerprint.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <functional>
#include <set>

#include "pipeline/loaded_scene.h"
#include "support/files.h"

namespace plisse::pipeline {
namespace {

// Two sheets of 2 × 3 vertices as three OBJ files, squeezed more and more.
config::SceneSettings two_sheets(const std::filesystem::path& folder) {
  for (int frame = 1; frame <= 3; ++frame) {
    std::string text;
    for (const char* name : {"left", "right"}) {
      text += fmt::format("o {}\n", name);
      for (int i = 0; i < 6; ++i)
        text += fmt::format("v {} {} {}\n", (1 - 0.1 * frame) * (i % 3), i / 3, name[0] == 'l' ? 0 : 1);
    }
    for (const int first : {1, 7}) {
      text += first == 1 ? "o left\n" : "o right\n";
      for (const int i : {first, first + 1}) text += fmt::format("f {} {} {} {}\n", i, i + 1, i + 4, i + 3);
    }
    test::write_text(folder / fmt::format("sheet_{:04}.obj", frame), text);
  }
  config::SceneSettings settings;
  settings.model.path = (folder / "sheet_####.obj").string();
  settings.wrinkles.fine = 2;
  settings.wrinkles.irregularity = 0.5;
  return settings;
}

std::string fingerprint(const config::SceneSettings& settings) {
  return LoadedScene(settings).frame_hash(2, Hash().add("driver"));
}

TEST(Fingerprint, EverySettingThatDecidesAPixelCounts) {
  const test::TemporaryFolder folder;
  const config::SceneSettings plain = two_sheets(folder.path());
  using Settings = config::SceneSettings;
  const std::vector<std::pair<std::string, std::function<void(Settings&)>>> alterations = {
      {"model.frames_per_second", [](Settings& s) { s.model.frames_per_second = 12; }},
      {"model.loop", [](Settings& s) { s.model.loop = true; }},
      {"model.metres_per_unit", [](Settings& s) { s.model.metres_per_unit = 0.01; }},
      {"model.up", [](Settings& s) { s.model.up = "z"; }},
      {"model.rest", [](Settings& s) { s.model.rest = "frame:3"; }},
      {"wrinkles.wavelength", [](Settings& s) { s.wrinkles.wavelength = 0.123; }},
      {"wrinkles.strength", [](Settings& s) { s.wrinkles.strength = 0.9; }},
      {"wrinkles.profile", [](Settings& s) { s.wrinkles.profile = "pencil"; }},
      {"wrinkles.only", [](Settings& s) { s.wrinkles.only = {"left"}; }},
      {"wrinkles.exclude", [](Settings& s) { s.wrinkles.exclude = {"left"}; }},
      {"wrinkles.dead_zone", [](Settings& s) { s.wrinkles.dead_zone = 0.006; }},
      {"wrinkles.irregularity", [](Settings& s) { s.wrinkles.irregularity = 0.6; }},
      {"wrinkles.seed", [](Settings& s) { s.wrinkles.seed = 2; }},
      {"wrinkles.fine", [](Settings& s) { s.wrinkles.fine = 3; }},
      {"wrinkles.fine_share", [](Settings& s) { s.wrinkles.fine_share = 0.4; }},
      {"relax.mode", [](Settings& s) { s.relax.mode = config::RelaxMode::descent; }},
      {"relax.rounds", [](Settings& s) { s.relax.rounds = 2; }},
      {"relax.epsilon", [](Settings& s) { s.relax.epsilon = 13; }},
      {"relax.interval", [](Settings& s) { s.relax.interval = 2; }},
      {"relax.onset_rounds", [](Settings& s) { s.relax.onset_rounds = 7; }},
      {"relax.smoothing_rounds", [](Settings& s) { s.relax.smoothing_rounds = 299; }},
      {"camera.focal_length", [](Settings& s) { s.camera.focal_length = 70; }},
      {"camera.azimuth", [](Settings& s) { s.camera.azimuth = 34; }},
      {"camera.elevation", [](Settings& s) { s.camera.elevation = 14; }},
      {"camera.distance", [](Settings& s) { s.camera.distance = 9; }},
      {"camera.margin", [](Settings& s) { s.camera.margin = 1.1; }},
      {"light.key_azimuth", [](Settings& s) { s.light.key_azimuth += 1; }},
      {"light.key_elevation", [](Settings& s) { s.light.key_elevation += 1; }},
      {"light.key_intensity", [](Settings& s) { s.light.key_intensity += 0.1; }},
      {"light.fill_azimuth", [](Settings& s) { s.light.fill_azimuth += 1; }},
      {"light.fill_elevation", [](Settings& s) { s.light.fill_elevation += 1; }},
      {"light.fill_ratio", [](Settings& s) { s.light.fill_ratio += 0.1; }},
      {"light.rim_azimuth", [](Settings& s) { s.light.rim_azimuth += 1; }},
      {"light.rim_elevation", [](Settings& s) { s.light.rim_elevation += 1; }},
      {"light.rim_intensity", [](Settings& s) { s.light.rim_intensity += 0.1; }},
      {"light.ambient", [](Settings& s) { s.light.ambient += 0.1; }},
      {"light.key_colour", [](Settings& s) { s.light.key_colour.z = 0.5F; }},
      {"light.fill_colour", [](Settings& s) { s.light.fill_colour.z = 0.5F; }},
      {"light.shadows", [](Settings& s) { s.light.shadows = true; }},
      {"shading.blend", [](Settings& s) { s.shading.blend = config::Blend::linear; }},
      {"shading.gradient", [](Settings& s) { s.shading.gradient = config::Gradient::paper; }},
      {"shading.roughness", [](Settings& s) { s.shading.roughness = 0.7; }},
      {"shading.sheen", [](Settings& s) { s.shading.sheen = 0.1; }},
      {"shading.cavity", [](Settings& s) { s.shading.cavity = 1.1; }},
      {"shading.parallax", [](Settings& s) { s.shading.parallax = 0.9; }},
      {"shading.wireframe", [](Settings& s) { s.shading.wireframe = true; }},
      {"shading.colour", [](Settings& s) { s.shading.colour.z = 0.5F; }},
      {"output.width", [](Settings& s) { s.output.width = 1281; }},
      {"output.height", [](Settings& s) { s.output.height = 1025; }},
      {"output.samples", [](Settings& s) { s.output.samples = 1; }},
      {"output.transparent", [](Settings& s) { s.output.transparent = true; }},
      {"output.background", [](Settings& s) { s.output.background.z = 0.5F; }},
      {"output.ground", [](Settings& s) { s.output.ground = true; }},
  };
  std::set<std::string> seen = {fingerprint(plain)};
  for (const auto& [name, alter] : alterations) {
    config::SceneSettings altered = plain;
    alter(altered);
    EXPECT_TRUE(seen.insert(fingerprint(altered)).second) << name;
  }
}

TEST(Fingerprint, NothingElseDoes) {
  const test::TemporaryFolder folder, elsewhere;
  const config::SceneSettings plain = two_sheets(folder.path());
  config::SceneSettings other = two_sheets(elsewhere.path());  // the same model at another place
  other.output.path = "other";
  other.model.frames = "2";
  other.file = "scene.toml";
  EXPECT_EQ(fingerprint(other), fingerprint(plain));
  EXPECT_NE(LoadedScene(plain).frame_hash(2, Hash().add("another driver")), fingerprint(plain));
  EXPECT_NE(LoadedScene(plain).frame_hash(3, Hash().add("driver")), fingerprint(plain));
}

}  // namespace
}  // namespace plisse::pipeline
