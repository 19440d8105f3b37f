// The command line's options that override a scene.
#include "config/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "config/keys.h"
#include "config/scene_file.h"
#include "support/errors.h"

namespace plisse {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

config::SceneSettings with(const config::GivenOptions& options) {
  config::SceneSettings scene = config::bare_scene("model.glb");
  config::apply_options(scene, options);
  return scene;
}

std::string error_of(const config::GivenOptions& options) {
  return test::error_of([&] { with(options); });
}

TEST(Options, EveryOptionOfTheContractIsThere) {
  std::vector<std::string> names;
  for (const config::SceneOption& option : config::scene_options()) names.push_back(option.name);
  // docs/contract.md, the line of `render`, those that concern the scene.
  EXPECT_THAT(
      names, testing::UnorderedElementsAre("--output", "--frames", "--fps", "--clip", "--size", "--samples",
                                           "--wavelength", "--profile", "--relax", "--rounds", "--interval",
                                           "--camera", "--background", "--only", "--exclude", "--method",
                                           "--quality", "--fabric", "--follow", "--tension-limit", "--body",
                                           "--strength", "--rest", "--up", "--units", "--cache", "--limits"));
}

TEST(Options, OverrideTheScene) {
  const config::SceneSettings scene = with({{"--output", {"x_##.png"}},
                                            {"--frames", {"1-4"}},
                                            {"--fps", {"12.5"}},
                                            {"--clip", {"007"}},
                                            {"--size", {"64x32"}},
                                            {"--samples", {"1"}},
                                            {"--wavelength", {"9 mm"}},
                                            {"--strength", {"0.5"}},
                                            {"--relax", {"descent"}},
                                            {"--rounds", {"3"}},
                                            {"--interval", {"2"}},
                                            {"--only", {"a", "b,c"}},
                                            {"--exclude", {"7"}},
                                            {"--rest", {"frame:2"}},
                                            {"--up", {"z"}},
                                            {"--units", {"0.01"}},
                                            {"--profile", {"pencil"}},
                                            {"--background", {"#ff0000"}}});
  EXPECT_EQ(scene.output.path, "x_##.png");
  EXPECT_EQ(scene.model.frames, "1-4");
  EXPECT_EQ(scene.model.frames_per_second, 12.5);
  EXPECT_EQ(scene.model.clip, "007") << "a name, not the number seven";
  EXPECT_EQ(scene.output.width, 64);
  EXPECT_EQ(scene.output.height, 32);
  EXPECT_EQ(scene.output.samples, 1);
  EXPECT_EQ(scene.wrinkles.wavelength, 0.009);
  EXPECT_EQ(scene.wrinkles.strength, 0.5);
  EXPECT_EQ(scene.relax.mode, config::RelaxMode::descent);
  EXPECT_EQ(scene.relax.rounds, 3);
  EXPECT_EQ(scene.relax.interval, 2);
  EXPECT_THAT(scene.wrinkles.only, ElementsAre("a", "b,c"));
  EXPECT_THAT(scene.wrinkles.exclude, ElementsAre("7"));
  EXPECT_EQ(scene.model.rest, "frame:2");
  EXPECT_EQ(scene.model.up, "z");
  EXPECT_EQ(scene.model.metres_per_unit, 0.01);
  EXPECT_EQ(scene.wrinkles.profile, "pencil");
  EXPECT_EQ(scene.output.background, glm::vec3(1, 0, 0));
}

TEST(Options, ColourAfterTransparentIsOpaque) {
  config::SceneSettings scene;
  scene.output.transparent = true;
  config::apply_options(scene, {{"--background", {"#ffffff"}}});
  EXPECT_FALSE(scene.output.transparent);
}

TEST(Options, CameraTakesItsThreeForms) {
  EXPECT_EQ(with({{"--camera", {"main"}}}).camera.name, "main");
  EXPECT_EQ(with({{"--camera", {"0"}}}).camera.name, "0");

  const config::CameraSettings angles = with({{"--camera", {"-30,10,85"}}}).camera;
  EXPECT_EQ(angles.azimuth, -30);
  EXPECT_EQ(angles.elevation, 10);
  EXPECT_EQ(angles.focal_length, 85);
  EXPECT_FALSE(angles.explicit_pose);
  EXPECT_EQ(with({{"--camera", {"5,6"}}}).camera.focal_length, config::CameraSettings{}.focal_length);

  const config::CameraSettings points = with({{"--camera", {"target=0,1,0;eye=1,20 cm,-3"}}}).camera;
  EXPECT_TRUE(points.explicit_pose);
  EXPECT_EQ(points.eye, glm::dvec3(1, 0.2, -3));
  EXPECT_EQ(points.target, glm::dvec3(0, 1, 0));
}

TEST(Options, CameraReplacesTheScenes) {
  config::SceneSettings scene;
  scene.camera.name = "main";
  config::apply_options(scene, {{"--camera", {"1,2"}}});
  EXPECT_EQ(scene.camera.name, "");
  config::apply_options(scene, {{"--camera", {"eye=1,2,3;target=0,0,0"}}});
  EXPECT_TRUE(scene.camera.explicit_pose);
  config::apply_options(scene, {{"--camera", {"1,2"}}});
  EXPECT_FALSE(scene.camera.explicit_pose);
  config::apply_options(scene, {{"--camera", {"eye=1,2,3;target=0,0,0"}}});
  config::apply_options(scene, {{"--camera", {"main"}}});
  EXPECT_FALSE(scene.camera.explicit_pose);
}

TEST(Options, CameraMistakes) {
  for (const char* wrong :
       {"", "1,2,3,4", "1,95", "1,2,1", "nan,1", "eye=1,2,3", "eye=1,2,3;target=1,2,3",
        "eye=1,2;target=0,0,0", "eye=1,2,x;target=0,0,0", "eye=1,2,3;eye=1,2,3", "eye=;target=0,0,0",
        "eye=1,2,3;target=0,0,0;up=0,1,0", "eye=1,2,inf;target=0,0,0"}) {
    EXPECT_THAT(error_of({{"--camera", {wrong}}}), testing::StartsWith("--camera: ")) << wrong;
  }
}

TEST(Options, MistakesNameTheOptionAndWhatIsAllowedAllAtOnce) {
  const std::string text = error_of({{"--samples", {"2"}}, {"--strength", {"inf"}}, {"--relax", {"smoth"}}});
  EXPECT_EQ(text,
            "--samples: 2 is not among them; allowed: 1 or 4\n"
            "--strength: inf is not finite; allowed: 0 … 10\n"
            "--relax: 'smoth' is unknown; allowed: smooth or descent (did you mean 'smooth'?)");
  EXPECT_THAT(error_of({{"--size", {"1x1", "2x2"}}}), HasSubstr("--size: given 2 times"));
  EXPECT_THAT(error_of({{"--camera", {"a", "b"}}}), HasSubstr("--camera: given 2 times"));
}

}  // namespace
}  // namespace plisse
