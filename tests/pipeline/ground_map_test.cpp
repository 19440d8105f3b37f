// The ground map is made only where the model can darken it. The reference, which makes all of it from the
// same depth maps, must find the same everywhere, whatever way the light comes from, and from one light to
// the next.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/scene_file.h"
#include "gpu/target.h"
#include "gpu/timer.h"
#include "passes/render.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/look.h"
#include "pipeline/stepper.h"
#include "reference/depth.h"
#include "reference/ground.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

class GroundMap : public test::OpenGlTest {};

Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

TEST_F(GroundMap, IsWholeWhereverTheLightComesFrom) {
  config::SceneSettings settings = config::load_scene(test::asset("sleeve.toml").string());
  settings.model.loop = false;
  pipeline::LoadedScene scene(settings);
  gpu::StageTimer timer(true);
  pipeline::Stepper stepper(scene, timer, "");
  passes::RenderPass pass(pipeline::look_of(scene), scene.profile, pipeline::draw_parts(scene),
                          pipeline::texture_levels(scene), "");
  const gpu::Target target(64, 48, 1, gpu::Target::Format::srgb8);
  stepper.advance_to(scene.step_of_frame(36));
  passes::View view = scene.view(36);
  const double degree = std::numbers::pi / 180;
  struct Light {
    double azimuth, elevation;
  };
  // From overhead to beyond the map's rim, then a light in the floor and one below it, whose shadow is
  // nowhere.
  for (const auto [azimuth, elevation] : {Light{0, 90}, Light{-85, 30}, Light{40, 12}, Light{200, 4},
                                          Light{130, 60}, Light{75, 0}, Light{75, -20}, Light{-10, 75}}) {
    view.lights[0].direction = {std::sin(azimuth * degree) * std::cos(elevation * degree),
                                std::sin(elevation * degree),
                                std::cos(azimuth * degree) * std::cos(elevation * degree)};
    pass.draw_all(stepper.surface(), view, target);

    const double radius = 1.02 * view.bounds_radius;
    const reference::Ground ground =
        reference::ground_under(eigen(view.bounds_centre), view.bounds_radius, eigen(view.up), view.floor);
    reference::ShadowMap key, below;
    key.matrix =
        reference::parallel_view(eigen(view.bounds_centre), radius, -eigen(view.lights[0].direction));
    key.size = passes::RenderPass::shadow_size;
    key.depth = pass.shadow_map();
    below.matrix = reference::view_from_below(ground, eigen(view.bounds_centre));
    below.size = passes::RenderPass::below_size;
    below.depth = pass.map_from_below();
    const reference::GroundMap expected = reference::ground_map(ground, key, below);
    const auto found = pass.ground_map();
    double light = 0, sky = 0, far_off = 0;
    std::size_t off = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double error = std::max(std::abs(found[i].x - expected.taken.at(i).x()),
                                    std::abs(found[i].y - expected.taken.at(i).y()));
      // Half floats, three times rounded, keep 1e-3. At the shadow's edge a comparison of depths in floats
      // may fall the other way, which the blur spreads over its neighbours: few texels, by parts of a
      // comparison's weight.
      off += error > 1e-3 ? 1 : 0;
      far_off = std::max(far_off, error);
      light = std::max(light, expected.taken.at(i).x());
      sky = std::max(sky, expected.taken.at(i).y());
    }
    EXPECT_LE(off, found.size() / 200) << azimuth << ", " << elevation;
    EXPECT_LE(far_off, 0.1) << azimuth << ", " << elevation;
    EXPECT_GT(sky, 0.2) << "nothing hangs above the floor: the comparison says little";
    if (elevation >= 4) {
      EXPECT_GT(light, 0.5) << azimuth << ", " << elevation;
    }
  }
}

}  // namespace
}  // namespace plisse::pipeline
