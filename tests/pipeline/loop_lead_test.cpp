// How a loop closes: over which frames the phases are led back to the first frame's, and by how much each.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "pipeline/loaded_scene.h"
#include "support/files.h"

namespace plisse::pipeline {
namespace {

// A triangle that stays, as so many OBJ files; a loop plays them once before it is shown.
LoadedScene loop_of(int frames, double frames_per_second, bool loop = true) {
  const test::TemporaryFolder folder;
  for (int frame = 1; frame <= frames; ++frame)
    test::write_text(folder / fmt::format("still_{:04}.obj", frame), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  config::SceneSettings settings;
  settings.model.path = (folder / "still_####.obj").string();
  settings.model.frames_per_second = frames_per_second;
  settings.model.loop = loop;
  return LoadedScene(settings);
}

// The first frame that is led; 0 where none is.
int first_led(const LoadedScene& scene, int frames) {
  for (int frame = 1; frame <= frames; ++frame)
    if (scene.lead_at(scene.step_of_frame(frame)) > 0) return frame;
  return 0;
}

TEST(LoopLead, ReachesOverAThirdOfTheClipAndAtMostASecond) {
  EXPECT_EQ(first_led(loop_of(30, 24), 30), 21);  // ten frames, a third of the clip
  EXPECT_EQ(first_led(loop_of(30, 6), 30), 25);   // six frames, a second
  EXPECT_EQ(first_led(loop_of(2, 24), 2), 0);     // a third of two frames is none
}

// Each frame of the reach covers the same part of the whole way, and so does the step from the last frame to
// the first: with a reach of 10 frames, 1/11.
TEST(LoopLead, GoesInEqualSharesOfTheWholeWay) {
  const LoadedScene scene = loop_of(30, 24);
  double left = 1;
  for (int frame = 21; frame <= 30; ++frame) {
    const double share = scene.lead_at(scene.step_of_frame(frame));
    EXPECT_NEAR(share * left, 1 / 11.0, 1e-14) << frame;  // ten products of doubles
    left *= 1 - share;
  }
  EXPECT_NEAR(left, 1 / 11.0, 1e-14);
}

TEST(LoopLead, IsForThePeriodThatIsDrawnAlone) {
  const LoadedScene scene = loop_of(30, 24);
  EXPECT_EQ(scene.step_of_frame(1), 31);
  for (int step = 1; step <= 31; ++step) {
    EXPECT_EQ(scene.lead_at(step), 0) << step;
    EXPECT_EQ(scene.remembers_at(step), step == 31) << step;
  }
  const LoadedScene once = loop_of(30, 24, false);
  EXPECT_EQ(once.step_of_frame(1), 1);
  EXPECT_EQ(first_led(once, 30), 0);
  EXPECT_FALSE(once.remembers_at(1));
}

}  // namespace
}  // namespace plisse::pipeline
