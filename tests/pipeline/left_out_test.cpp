// What a part of a surface does not need is not drawn, and the picture is the same, byte for byte, as with
// everything: parts without waves, waves under two pixels, parts out of view, materials without a texture,
// surfaces that are masked.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "config/scene_file.h"
#include "config/settings.h"
#include "gpu/target.h"
#include "gpu/timer.h"
#include "io/picture/image.h"
#include "passes/render.h"
#include "pipeline/history.h"
#include "pipeline/look.h"
#include "pipeline/render.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

constexpr int width = 230, height = 170;  // no multiples of the driver's tiles

class LeftOut : public test::OpenGlTest {
 protected:
  // The sleeve (three materials, in one surface) without floor and shadow.
  static config::SceneSettings sleeve() {
    config::SceneSettings settings = config::load_scene(test::asset("sleeve.toml").string());
    settings.model.loop = false;
    settings.output.ground = settings.light.shadows = false;
    settings.output.width = width;
    settings.output.height = height;
    return settings;
  }

  // What is left out of a frame; fails where that shows.
  static passes::LeftOut left_out(const config::SceneSettings& settings, int frame) {
    History run(settings);
    run.at(frame);
    passes::LeftOut result;
    for (const int samples : {1, 4}) {
      const passes::View view = run.scene.view(frame);
      const gpu::Target all(width, height, samples, gpu::Target::Format::srgb8),
          some(width, height, samples, gpu::Target::Format::srgb8);
      passes::RenderPass pass(pipeline::look_of(run.scene), run.scene.profile,
                              pipeline::draw_parts(run.scene), pipeline::texture_levels(run.scene), "");
      pass.draw_all(run.stepper.surface(), view, all);
      EXPECT_EQ(pass.left_out().flat + pass.left_out().too_fine + pass.left_out().out_of_view, 0);
      pass.draw(run.stepper.surface(), view, some, true);
      EXPECT_EQ(all.read_rgba8(), some.read_rgba8()) << samples << " samples, frame " << frame;
      result = pass.left_out();
    }
    return result;
  }
};

// Two sheets of 5 × 5 vertices side by side as OBJ files, squeezed from frame 2 on.
config::SceneSettings two_sheets(const std::filesystem::path& folder) {
  for (int frame = 1; frame <= 3; ++frame) {
    std::string text;
    for (int sheet = 0; sheet < 2; ++sheet) {
      text += sheet == 0 ? "o left\n" : "o right\n";
      for (int i = 0; i < 25; ++i)
        text += fmt::format("v {} {} 0\n", 1.2 * sheet + (1.1 - 0.1 * frame) * (i % 5) / 4.0, (i / 5) / 4.0);
      for (int i = 1; i < 20; ++i) {
        const int v = 25 * sheet + i;
        if (i % 5 != 0) text += fmt::format("f {} {} {} {}\n", v, v + 1, v + 6, v + 5);
      }
    }
    test::write_text(folder / fmt::format("sheet_{:04}.obj", frame), text);
  }
  config::SceneSettings settings;
  settings.model.path = (folder / "sheet_####.obj").string();
  settings.output.width = width;
  settings.output.height = height;
  return settings;
}

TEST_F(LeftOut, PartsThatAreMaskedAreDrawnWithoutWaves) {
  const test::TemporaryFolder folder;
  config::SceneSettings settings = two_sheets(folder.path());
  EXPECT_EQ(left_out(settings, 3).flat, 0);
  settings.wrinkles.only = {"left"};
  const passes::LeftOut squeezed = left_out(settings, 3);
  EXPECT_EQ(squeezed.flat, 1);
  EXPECT_EQ(squeezed.too_fine, 0);
  EXPECT_EQ(squeezed.out_of_view, 0);
  EXPECT_FALSE(squeezed.nothing_in_view);
}

// The sleeve has seams of uv, so vertices of the file have other numbers than welded ones.
TEST_F(LeftOut, ThePartThatIsPickedWrinklesAndNoOther) {
  config::SceneSettings settings = sleeve();
  settings.wrinkles.exclude.clear();
  std::vector<std::string> materials;
  {
    const pipeline::LoadedScene scene(settings);
    ASSERT_GT(scene.surface().render_vertices.size(), scene.surface().vertex_count());
    for (const Part& part : scene.surface().parts) materials.push_back(part.material_name);
  }
  ASSERT_EQ(materials.size(), 3U);
  for (const std::string& picked : materials) {
    settings.wrinkles.only = {picked};
    const pipeline::LoadedScene scene(settings);
    const auto parts = pipeline::draw_parts(scene);
    for (std::size_t p = 0; p < parts.size(); ++p)
      EXPECT_EQ(parts[p].wrinkles, materials[p] == picked) << picked << p;
  }
}

TEST_F(LeftOut, AtRestNoPartHasWaves) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(left_out(two_sheets(folder.path()), 1).flat, 2);
}

TEST_F(LeftOut, WavesUnderTwoPixelsAreRoughnessAlone) {
  const test::TemporaryFolder folder;
  // From in front, `factor` times as far off as where the sheets fill the picture and a wave is some 18
  // pixels long.
  const auto from = [&](double factor, int fine) {
    config::SceneSettings settings = two_sheets(folder.path());
    settings.wrinkles.fine = fine;
    settings.camera.explicit_pose = true;
    settings.camera.target = {1.1, 0.5, 0};
    settings.camera.eye = settings.camera.target + glm::dvec3(0.1, 0.2, 5 * factor);
    return left_out(settings, 3);
  };
  EXPECT_EQ(from(30, 0).too_fine, 2);
  EXPECT_EQ(from(30, 5).too_fine, 2);
  // Nearer by and by: where some wave may be two pixels long, all are drawn as they are.
  EXPECT_EQ(from(1, 0).too_fine, 0);
  for (const double factor : {14.0, 10.0, 8.0, 6.0}) from(factor, 0);
}

TEST_F(LeftOut, PartsOutOfViewAreNotDrawn) {
  config::SceneSettings settings = sleeve();
  // Up to the elbow's inside: the cuff at the sleeve's end is beyond the picture.
  settings.camera.focal_length *= 5;
  const passes::LeftOut close = left_out(settings, 37);
  EXPECT_GE(close.out_of_view, 1);
  EXPECT_LE(close.out_of_view, 2);
  EXPECT_FALSE(close.nothing_in_view);
}

// The same material with a white texture, whose every texel is exactly 1, is what parallax would shift.
TEST_F(LeftOut, WhereNoTextureIsThereIsNoParallax) {
  History run(sleeve());
  run.at(37);
  const passes::View view = run.scene.view(37);
  const gpu::Target target(width, height, 4, gpu::Target::Format::srgb8);
  const auto drawn = [&](bool white) {
    auto parts = pipeline::draw_parts(run.scene);
    for (passes::DrawPart& part : parts) part.texture = white ? 0 : -1;
    std::vector<std::vector<passes::TextureLevel>> textures;
    if (white) textures.push_back({{1, 1, {255, 255, 255, 255}}});
    passes::RenderPass pass(pipeline::look_of(run.scene), run.scene.profile, parts, textures, "");
    pass.draw(run.stepper.surface(), view, target, true);
    EXPECT_EQ(pass.left_out().untextured, white ? 0 : 3);
    return target.read_rgba8();
  };
  EXPECT_EQ(drawn(false), drawn(true));
}

// The finished run, and what its report says.
class LeftOutRuns : public test::DriverTest {};

TEST_F(LeftOutRuns, MaskedSurfacesAreNeitherCrushedNorRelaxedAndTheReportSaysSo) {
  const test::TemporaryFolder folder;
  pipeline::RenderRequest request;
  request.scene = config::load_scene(test::asset("curtain.toml").string());
  request.scene.model.loop = false;
  request.scene.model.frames = "1-6";
  request.scene.output.width = width;
  request.scene.output.height = height;
  request.scene.wrinkles.strength = 0;
  request.scene.output.path = (folder / "masked").string();
  const pipeline::RenderReport masked = pipeline::render(request, {});
  EXPECT_EQ(masked.skipped.at("masked surfaces"), 6);
  EXPECT_GE(masked.skipped.at("parts without waves"), 6);
  // With an AOV that shows the compression the passes run, and the pictures are the same.
  request.aovs = {"tension"};
  request.scene.output.path = (folder / "looked_at").string();
  const pipeline::RenderReport looked_at = pipeline::render(request, {});
  EXPECT_FALSE(looked_at.skipped.contains("masked surfaces"));
  for (int n = 1; n <= 6; ++n) {
    const std::string name = "frame_000" + std::to_string(n) + ".png";
    EXPECT_EQ(io::load_image(folder / ("masked/" + name)).rgba,
              io::load_image(folder / ("looked_at/" + name)).rgba)
        << n;
  }
}

TEST_F(LeftOutRuns, WhatPicturesWithoutWavesSaveIsEstimatedFromThoseWith) {
  const test::TemporaryFolder folder;
  pipeline::RenderRequest request;
  request.scene = config::load_scene(test::asset("square.toml").string());
  request.scene.model.loop = false;
  request.scene.model.frames = "1-24";
  request.scene.output.width = width;
  request.scene.output.height = height;
  request.scene.output.path = (folder / "out").string();
  const pipeline::RenderReport report = pipeline::render(request, {});
  const int flat =
      report.skipped.contains("parts without waves") ? report.skipped.at("parts without waves") : 0;
  EXPECT_GE(flat, 1);
  EXPECT_LT(flat, 24);
  int named = 0;
  for (const pipeline::FrameReport& frame : report.frames)
    for (const std::string& what : frame.left_out) named += what == "parts without waves" ? 1 : 0;
  EXPECT_EQ(named, flat);  // the square is one part
}

}  // namespace
}  // namespace plisse::pipeline
