// What a run shows of itself: rates from known times, and lines that fit.
#include "base/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/log.h"
#include "base/text.h"

namespace plisse {
namespace {

TEST(Progress, RatesFollowFromTheTimes) {
  // 12 steps in 6 s: 2 a second; 60 left take 30 s.
  EXPECT_EQ(progress_line(12, 72, 6, "a.png"), "12/72  a.png  2.0 fps  eta 0:30");
  // 1 step in 100 s, 71 left: 7100 s = 1 h 58 min 20 s.
  EXPECT_EQ(progress_line(1, 72, 100, "a.png"), "1/72  a.png  0.0 fps  eta 1:58:20");
  EXPECT_EQ(progress_line(72, 72, 36, "a.png"), "72/72  a.png  2.0 fps  eta 0:00");
}

TEST(Progress, KnowsNoRateBeforeTheFirstStep) {
  EXPECT_EQ(progress_line(0, 72, 5, "x"), "0/72  x");
  EXPECT_EQ(progress_line(3, 72, 0, "x"), "3/72  x");  // a clock too coarse to have moved
}

TEST(Progress, BarFillsInProportionAndFits) {
  const std::string half = progress_bar(36, 72, 18, 80);
  const auto ends = half.find(']');
  ASSERT_NE(ends, std::string::npos);
  EXPECT_EQ(static_cast<std::size_t>(std::count(half.begin(), half.end(), '=')), (ends - 1) / 2);
  const std::string whole = progress_bar(72, 72, 18, 80);
  EXPECT_EQ(whole.find('>'), std::string::npos);
  EXPECT_EQ(whole.find(']'), ends) << "the bar keeps its width";
  for (int columns = 0; columns < 200; ++columns) {
    EXPECT_LE(progress_bar(36, 72, 18, columns).size(), static_cast<std::size_t>(columns));
  }
  EXPECT_NE(progress_bar(36, 72, 18, 30).find("36/72"), std::string::npos) << "numbers go before the bar";
}

TEST(Progress, NonsenseCountsAreHarmless) {
  for (const int total : {0, -1, 5}) {
    for (const int done : {-3, 0, 7}) EXPECT_LE(progress_bar(done, total, 1, 80).size(), 80U);
  }
}

TEST(Progress, MessagesHaveTheirLineToThemselves) {
  testing::internal::CaptureStderr();
  {
    Progress progress(Progress::Style::bar);
    progress.update(1, 3, "a.png");
    log::warn("first");
    log::warn("second");
    progress.update(3, 3, "c.png");
  }
  const std::string text = testing::internal::GetCapturedStderr();
  const std::size_t bar = text.find("1/3"), wiped = text.find("\r\x1b[Kwarning: first\nwarning: second\n\r");
  ASSERT_NE(wiped, std::string::npos) << text;
  EXPECT_LT(bar, wiped);
  EXPECT_LT(wiped, text.find("3/3"));
  EXPECT_EQ(text.back(), '\n');
}

TEST(Text, WrapsAtSpacesByLetters) {
  EXPECT_EQ(wrapped("aa bb cc", 5), "aa bb\ncc");
  EXPECT_EQ(wrapped("a longestword b", 4), "a\nlongestword\nb");
  EXPECT_EQ(wrapped("öö üü", 5), "öö üü");  // five letters, nine bytes
  EXPECT_EQ(wrapped("", 5), "");
}

TEST(Text, PadsByLetters) {
  EXPECT_EQ(letters("größe"), 5U);
  EXPECT_EQ(padded("größe", 7), "größe  ");
  EXPECT_EQ(padded("longer", 3), "longer");
}

}  // namespace
}  // namespace plisse
