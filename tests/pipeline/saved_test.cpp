// What a run says it saved: sums by hand.
#include "pipeline/saved.h"

#include <gtest/gtest.h>

namespace plisse::pipeline {
namespace {

// Sums of a few exact decimals, times 1e-3.
constexpr double rounding = 1e-12;

FrameReport frame(std::map<std::string, double> ms, std::vector<std::string> left_out = {}) {
  FrameReport report;
  report.ms = std::move(ms);
  report.left_out = std::move(left_out);
  return report;
}

TEST(SavedSeconds, CountsWholeStagesWithWhatTheyCostElsewhere) {
  RenderReport report;
  report.frames = {frame({{"skin", 1}, {"crush", 20}, {"relax", 300}, {"render", 4000}}),
                   frame({{"skin", 3}, {"crush", 40}, {"relax", 500}, {"render", 8000}}),
                   frame({{"render", 5}}, {"unchanged poses", "copied pictures"})};
  report.skipped = {{"unchanged poses", 7}};
  // Means: skin 2, crush 30, relax 400 ms. Steps before the first frame count as well: 7, not 1.
  EXPECT_NEAR(saved_seconds(report).at("unchanged poses"), 7 * 0.432, rounding);
  report.skipped = {{"idle relaxations", 2}, {"masked surfaces", 3}};
  EXPECT_NEAR(saved_seconds(report).at("idle relaxations"), 2 * 0.4, rounding);
  EXPECT_NEAR(saved_seconds(report).at("masked surfaces"), 3 * 0.43, rounding);
}

TEST(SavedSeconds, CopiedPicturesSaveDrawingReadingAndEncoding) {
  RenderReport report;
  report.frames = {frame({{"relax", 1000}, {"render", 10}, {"readback", 2}, {"encode", 30}, {"write", 500}}),
                   frame({{"relax", 1000}, {"write", 500}}, {"copied pictures"}), frame({})};
  report.skipped = {{"copied pictures", 1}};
  EXPECT_NEAR(saved_seconds(report).at("copied pictures"), 0.042, rounding)
      << "a frame without times, one that stood already, is no part of the mean";
}

TEST(SavedSeconds, ComparesPicturesWithAndWithoutAPart) {
  RenderReport report;
  report.frames = {frame({{"render", 50}}), frame({{"render", 70}}),
                   frame({{"render", 20}}, {"parts without waves"}),
                   frame({{"render", 30}}, {"parts without waves"})};
  report.skipped = {{"parts without waves", 12}};  // six parts a frame
  // 60 − 25 ms in each of two frames.
  EXPECT_NEAR(saved_seconds(report).at("parts without waves"), 0.07, rounding);
  report.frames[0].ms["render"] = report.frames[1].ms["render"] = 24;
  EXPECT_TRUE(saved_seconds(report).empty()) << "nothing was saved: noise is no saving";
}

TEST(SavedSeconds, IsSilentWhereThereIsNothingToCompareWith) {
  RenderReport report;
  report.frames = {frame({{"render", 5}}, {"unchanged poses", "surfaces out of view"})};
  report.skipped = {{"unchanged poses", 1}, {"surfaces out of view", 1}, {"existing frames", 9}};
  EXPECT_TRUE(saved_seconds(report).empty());
  report.frames = {frame({{"render", 50}}), frame({}, {"existing frames"})};
  report.skipped = {{"existing frames", 1}};
  EXPECT_TRUE(saved_seconds(report).empty());
}

}  // namespace
}  // namespace plisse::pipeline
