// Clips of the formats that assimp reads, in small DirectX files written here: ticks a second that the file
// leaves open, clips without length or name, names that would confuse a shell.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/import.h"
#include "scene/animation.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::io {
namespace {

// A triangle in a frame that moves by `last` ticks along x; `ticks` is the block that says how long a tick
// is.
class Clips : public testing::Test {
 protected:
  Model model(const std::string& ticks, const std::string& name, int last) const {
    const auto path = folder_ / "clip.x";
    test::write_text(path, fmt::format(R"(xof 0303txt 0032
{}Frame Root {{
 FrameTransformMatrix {{ 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;; }}
 Mesh Sheet {{ 3; 0.0;0.0;0.0;, 1.0;0.0;0.0;, 0.0;1.0;0.0;; 1; 3;0;1;2;; }}
}}
AnimationSet {} {{
 Animation {{ {{ Root }}
  AnimationKey {{ 2; 2; 0;3;0.0,0.0,0.0;;, {};3;{}.0,0.0,0.0;;; }} }}
}}
)",
                                       ticks, name, last, last));
    return import_model(path);
  }
  static std::string ticks(int count) { return fmt::format("AnimTicksPerSecond {{ {}; }}\n", count); }
  test::TemporaryFolder folder_;
};

TEST_F(Clips, TicksThatTheFileStates) {
  const Model thirty = model(ticks(30), "Walk", 60);
  ASSERT_EQ(thirty.clips.size(), 1U);
  EXPECT_EQ(thirty.clips[0].duration, 2);  // 60 ticks of 1/30 s
  // 24 frames a second whatever the file's ticks: frame 25 is one second in, half of the way.
  scene::Animation animation(thirty, {});
  EXPECT_EQ(animation.timeline().frame_count, 49);
  const auto x_at = [&](int frame) {
    return scene::posed(animation.surface(), animation.pose(frame)).at(0).x;
  };
  EXPECT_NEAR(x_at(25), 30, 1e-4);  // single precision of 60
  EXPECT_NEAR(x_at(49) - x_at(1), 60, 1e-4);
}

TEST_F(Clips, NoTicksASecondAreTwentyFour) {
  // What assimp leaves at 0 was made frame by frame: the contract's 24 a second.
  EXPECT_EQ(model(ticks(0), "Walk", 48).clips.at(0).duration, 2);
}

TEST_F(Clips, WithoutLengthIsOneFrame) {
  const Model still = model(ticks(24), "Still", 0);
  scene::Animation animation(still, {});
  EXPECT_EQ(animation.timeline().frame_count, 1);
  EXPECT_NO_THROW(animation.pose(1));
}

TEST_F(Clips, NamesAreTakenAsTheyAre) {
  EXPECT_EQ(model(ticks(24), "", 24).clips.at(0).name, "clip 0");
  EXPECT_EQ(model(ticks(24), "Armature|Walk", 24).clips.at(0).name, "Armature|Walk");
  const Model piped = model(ticks(24), "Armature|Walk", 24);
  EXPECT_EQ(scene::Animation(piped, {.clip = "Armature|Walk"}).timeline().frame_count, 25);
  EXPECT_EQ(scene::Animation(piped, {.clip = "0"}).timeline().frame_count, 25);
  EXPECT_THAT(test::error_of([&] { scene::Animation(piped, {.clip = "Armature|Wolk"}); }),
              testing::HasSubstr("Armature|Walk"));
}

}  // namespace
}  // namespace plisse::io
