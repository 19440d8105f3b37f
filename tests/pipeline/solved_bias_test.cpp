// Solved fields of each frame's base surface as the bias of the passes ([solve] method = "bias"): on the base
// itself, whatever its strain, waves have the field's height, direction and length.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "config/scene_file.h"
#include "pipeline/history.h"
#include "pipeline/reference_scene.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

using std::numbers::pi;

class SolvedBias : public test::OpenGlTest {
 protected:
  static constexpr int cells = 24;
  static constexpr double side = 1, height = 0.004, wave = 0.15;

  // A flat sheet of two frames as the model has it; its base surfaces are pressed along x by a tenth and a
  // fifth, with waves 20 degrees off that direction.
  SolvedBias() {
    const auto id = [](int i, int j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
    std::string obj;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i)
        obj += fmt::format("v {:.9g} {:.9g} 0\n", side * i / cells, side * j / cells);
    auto clip = std::make_shared<SolvedClip>();
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        clip->faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
        clip->faces.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
      }
    for (std::uint32_t f = 0; f < clip->faces.size(); ++f) {
      clip->triangle.push_back(f);
      obj += fmt::format("f {} {} {}\n", clip->faces[f][0] + 1, clip->faces[f][1] + 1, clip->faces[f][2] + 1);
    }
    for (const char* name : {"sheet_0001.obj", "sheet_0002.obj"}) test::write_text(folder_ / name, obj);
    for (std::uint32_t v = 0; v < (cells + 1) * (cells + 1); ++v) clip->welded.push_back(v);
    for (const double pressed : {0.9, 0.8}) {
      SolvedClip::Frame& frame = clip->frames.emplace_back();
      for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i)
          frame.base.emplace_back(pressed * side * i / cells, side * j / cells, 0);
      frame.amplitude.assign(frame.base.size(), height / pressed);
      for (const auto& face : clip->faces) {
        auto& phase = frame.phase.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) {
          const glm::dvec3& x = frame.base[face[c]];
          phase[c] = SolvedBias::phase(x.x, x.y, static_cast<int>(clip->frames.size()));
        }
      }
    }
    memory_.solved = clip;
  }
  static constexpr double turn = 20 * pi / 180;
  static double phase(double x, double y, int frame) {
    return 2 * pi / wave * (std::cos(turn) * x + std::sin(turn) * y) + 0.9 * frame;
  }
  test::TemporaryFolder folder_;
  scene::InMemory memory_;
};

TEST_F(SolvedBias, WavesAreTheFieldsWhateverTheStrain) {
  const config::SceneSettings scene = config::parse_scene(
      "[model]\npath = \"sheet_####.obj\"\n[solve]\nmethod = \"bias\"\n", folder_ / "scene.toml");
  History run(scene, LoadedScene::most_smooth, memory_);
  for (const int frame : {1, 2}) {
    run.stepper.advance_to(run.scene.step_of_frame(frame));
    const WaveSnapshot now = read_snapshot(run.stepper.surface());
    const double wanted = height / (frame == 1 ? 0.9 : 0.8) / run.scene.units.metres;
    for (int j = 2; j <= cells - 2; ++j)  // gradients at the rim are one-sided
      for (int i = 2; i <= cells - 2; ++i) {
        const auto v = static_cast<Eigen::Index>(j * (cells + 1) + i);
        // Single precision, and the search for the bias that gives this height.
        EXPECT_NEAR(now.heights[v] / wanted, 1, 1e-4) << frame;
        // Gradients of vertices are found in twelve rounds, each of which halves what is wrong at the rim.
        const Eigen::Vector3d k = now.frames.basis(v) * now.wavenumbers.col(v) / run.scene.units.metres;
        EXPECT_NEAR(k.norm() * wave, 1, 1e-3) << frame;
        const double along = k.x() * std::cos(turn) + k.y() * std::sin(turn);
        EXPECT_NEAR(std::abs(along) * wave, 1, 1e-3) << frame;
        // And the phase of this frame's field, which is another than the frame's before.
        const double x = memory_.solved->frames[static_cast<std::size_t>(frame - 1)]
                             .base[static_cast<std::size_t>(v)]
                             .x,
                     y = side * j / cells;
        EXPECT_NEAR(std::remainder(std::copysign(1, along) * now.phases[v] - phase(x, y, frame), 2 * pi), 0,
                    1e-5)
            << frame;
      }
  }
}

}  // namespace
}  // namespace plisse::pipeline
