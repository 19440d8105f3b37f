// The default camera: the whole model is in the picture, for any shape.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/loaded_scene.h"
#include "support/files.h"

namespace plisse::pipeline {
namespace {

// The elevation in degrees of the camera that is fitted to a box of this height on a 2 m × 1 m ground.
double elevation_over(double height, double given = config::CameraSettings::from_the_shape) {
  const test::TemporaryFolder folder;
  std::string text;
  for (const double y : {0.0, height})
    text += fmt::format("v -1 {0} -0.5\nv 1 {0} -0.5\nv 1 {0} 0.5\nv -1 {0} 0.5\n", y);
  test::write_text(folder / "box.obj", text + "f 1 2 3 4\nf 5 6 7 8\n");
  config::SceneSettings settings;
  settings.model.path = folder / "box.obj";
  settings.camera.elevation = given;
  const config::CameraSettings camera = pipeline::LoadedScene(settings).settings.camera;
  const glm::dvec3 toward = glm::normalize(camera.eye - camera.target);
  return glm::degrees(std::asin(toward.y));
}

TEST(FittedCamera, LooksDownOnWhatLiesFlat) {
  // Upright things from 15°; a sheet on the ground from 50°; between, in proportion. Rounded in the last
  // digits.
  EXPECT_NEAR(elevation_over(2), 15, 1e-9);
  EXPECT_NEAR(elevation_over(0.3), 15, 1e-9);
  EXPECT_NEAR(elevation_over(0.15), 32.5, 1e-9);
  EXPECT_NEAR(elevation_over(0), 50, 1e-9);
  EXPECT_NEAR(elevation_over(0, 20), 20, 1e-9) << "what is asked for is given";
}

}  // namespace
}  // namespace plisse::pipeline
