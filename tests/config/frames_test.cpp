// Selections of frames and the names of their files, from the forms that docs/contract.md lists.
#include "config/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "base/error.h"
#include "support/errors.h"

namespace plisse {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string error_of(const std::string& selection, int count) {
  return test::error_of([&] { config::select_frames(selection, count); });
}

TEST(SelectFrames, TakesEachFormOfTheContract) {
  EXPECT_THAT(config::select_frames("", 3), ElementsAre(1, 2, 3));
  EXPECT_THAT(config::select_frames("2", 3), ElementsAre(2));
  EXPECT_THAT(config::select_frames("2-4", 9), ElementsAre(2, 3, 4));
  EXPECT_THAT(config::select_frames("2..4", 9), ElementsAre(2, 3, 4));
  EXPECT_THAT(config::select_frames("1-8x3", 9), ElementsAre(1, 4, 7));
  EXPECT_THAT(config::select_frames("1..7x3", 9), ElementsAre(1, 4, 7)) << "ranges are inclusive";
  EXPECT_THAT(config::select_frames(" 1 - 2 , 9 ", 9), ElementsAre(1, 2, 9));
  EXPECT_EQ(config::select_frames("1-48x2,60", 60).size(), 24U + 1U);
}

TEST(SelectFrames, IsAscendingAndTakesEachOnce) {
  EXPECT_THAT(config::select_frames("5,1-3,2-5", 9), ElementsAre(1, 2, 3, 4, 5));
}

TEST(SelectFrames, NamesTheRangeThereIs) {
  EXPECT_THAT(error_of("3-12", 10), HasSubstr("no frame 12; this clip has frames 1 to 10"));
  // Told from its ends, not by counting through two thousand million frames.
  EXPECT_THAT(error_of("1-2147483647", 10), HasSubstr("1 to 10"));
  EXPECT_EQ(config::select_frames("2147483646-2147483647", std::numeric_limits<int>::max()).size(), 2U)
      << "no overflow";
}

TEST(SelectFrames, RejectsWhatIsNoSelection) {
  for (const char* wrong : {"0", "a", "1-", "-3", "3-1", "1,,2", "1,", "1-5x0", "1-5x", "5x2", "1.5", "1...3",
                            "1-2-3", "99999999999", "1 2", "+1"}) {
    EXPECT_THAT(error_of(wrong, 100), HasSubstr("frames '")) << wrong;
  }
}

TEST(FramePath, FillsEachSpelling) {
  EXPECT_EQ(config::frame_path("out", 7), "out/frame_0007.png");
  EXPECT_EQ(config::frame_path("out/", 7), "out/frame_0007.png");
  EXPECT_EQ(config::frame_path("a/img_####.png", 7), "a/img_0007.png");
  EXPECT_EQ(config::frame_path("img_#.png", 12), "img_12.png");
  EXPECT_EQ(config::frame_path("img_%04d.png", 7), "img_0007.png");
  EXPECT_EQ(config::frame_path("img_%d.png", 7), "img_7.png");
  EXPECT_EQ(config::frame_path("img_{frame:04}.png", 7), "img_0007.png");
  EXPECT_EQ(config::frame_path("img_{frame}.PNG", 7), "img_7.PNG");
  EXPECT_EQ(config::frame_path("img_##", 123), "img_123.png") << "more digits than places";
  EXPECT_EQ(config::frame_path("a#b/c", 7), "a#b/c/frame_0007.png") << "only the last part is a pattern";
  EXPECT_EQ(config::frame_path("100%/x_%s_{frame:x}_##.png", 7), "100%/x_%s_{frame:x}_07.png");
}

TEST(FramePath, OneNameForSeveralFramesIsAnErrorThatSaysWhatWouldDo) {
  EXPECT_EQ(config::frame_path("still.png", 7), "still.png");
  EXPECT_NO_THROW(config::check_frame_paths("still.png", std::vector<int>{7}));
  EXPECT_NO_THROW(config::check_frame_paths("still_#.png", std::vector<int>{7, 8}));
  try {
    config::check_frame_paths("a/still.png", std::vector<int>{7, 8});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("a/still_####.png"));
  }
}

TEST(FramePath, OnlyPngIsWritten) {
  EXPECT_NO_THROW(config::check_frame_pattern("a_####.png"));
  EXPECT_NO_THROW(config::check_frame_pattern("a_####"));
  EXPECT_NO_THROW(config::check_frame_pattern("folder.d"));
  EXPECT_THROW(config::check_frame_pattern("a_####.jpg"), Error);
}

}  // namespace
}  // namespace plisse
