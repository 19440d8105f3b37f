// Resolving only what the surface covers must not show: the same picture as drawing and resolving all of it.
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "config/scene_file.h"
#include "gpu/target.h"
#include "gpu/timer.h"
#include "passes/render.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/look.h"
#include "pipeline/stepper.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

struct Setting {
  const char* name;
  const char* scene;
  bool wireframe, transparent;
  double nearer;  // the eye's way to the target: 0.9 is inside the model, so that points lie behind the eye
};

void PrintTo(const Setting& setting, std::ostream* out) {
  *out << setting.name;
}

class CoveredRectangle : public test::OpenGlTest, public ::testing::WithParamInterface<Setting> {};

TEST_P(CoveredRectangle, DoesNotShow) {
  const Setting& setting = GetParam();
  config::SceneSettings settings =
      config::load_scene(test::asset(setting.scene + std::string(".toml")).string());
  settings.model.loop = false;
  settings.output.width = 230;  // no multiple of the driver's tiles
  settings.output.height = 170;
  settings.output.transparent = setting.transparent;
  settings.shading.wireframe = setting.wireframe;
  settings.camera.eye += setting.nearer * (settings.camera.target - settings.camera.eye);
  pipeline::LoadedScene scene(settings);
  gpu::StageTimer timer(true);
  pipeline::Stepper stepper(scene, timer, "");
  passes::RenderPass pass(pipeline::look_of(scene), scene.profile, pipeline::draw_parts(scene),
                          pipeline::texture_levels(scene), "");
  const gpu::Target whole(230, 170, 4, gpu::Target::Format::srgb8),
      part(230, 170, 4, gpu::Target::Format::srgb8);
  for (int frame : {1, 12, 24}) {
    stepper.advance_to(scene.step_of_frame(frame));
    pass.draw_all(stepper.surface(), scene.view(frame), whole);
    pass.draw(stepper.surface(), scene.view(frame), part, true);
    const auto expected = whole.read_rgba8(), found = part.read_rgba8();
    const auto differ = std::inner_product(expected.begin(), expected.end(), found.begin(), 0, std::plus<>(),
                                           std::not_equal_to<>());
    EXPECT_EQ(differ, 0) << "frame " << frame;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, CoveredRectangle,
                         ::testing::Values(Setting{"Ground", "sleeve", false, false, 0},
                                           Setting{"Plain", "zeppelin", false, false, 0},
                                           Setting{"Transparent", "zeppelin", false, true, 0},
                                           Setting{"Lines", "curtain", true, false, -0.5},
                                           Setting{"CloseUp", "zeppelin", false, false, 0.6},
                                           Setting{"Inside", "zeppelin", false, false, 0.95}),
                         [](const auto& setting) { return setting.param.name; });

}  // namespace
}  // namespace plisse::pipeline
