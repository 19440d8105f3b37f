// Plots: what stands where, by reading the SVG back.
#include "io/picture/svg_plot.h"

#include <gmock/gmock.h>

#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "support/errors.h"

namespace plisse::io {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Dot {
  double x, y;
};

// Filled circles: the first series' symbols, the legend's last.
std::vector<Dot> circles(const std::string& svg) {
  const std::regex circle("<circle cx=\"([-0-9.]+)\" cy=\"([-0-9.]+)\" r=\"5\"");
  std::vector<Dot> dots;
  for (std::sregex_iterator it(svg.begin(), svg.end(), circle), end; it != end; ++it)
    dots.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  return dots;
}

Plot three_decades() {
  Plot plot;
  plot.title = "a < b & c";
  plot.x = {"time", true, true};
  plot.y = {"error", true, false};
  plot.series = {
      {"one",
       {{1e-3, 1, 0, 0, "first", true}, {1e-2, 0.1, 0, 0, "second", true}, {1e-1, 0.01, 0, 0, "", false}}}};
  return plot;
}

TEST(SvgPlot, LogarithmicAxesPutDecadesAtEvenDistances) {
  const auto dots = circles(svg_plot(three_decades()));
  ASSERT_GE(dots.size(), 3U);
  // Coordinates are written to a tenth of a pixel.
  EXPECT_NEAR(dots[1].x - dots[0].x, dots[2].x - dots[1].x, 0.21);
  EXPECT_NEAR(dots[1].y - dots[0].y, dots[2].y - dots[1].y, 0.21);
  EXPECT_GT(dots[1].x, dots[0].x + 50);
  EXPECT_GT(dots[1].y, dots[0].y + 50);  // smaller errors are further down
}

TEST(SvgPlot, LinearAxesPutValuesInProportion) {
  Plot plot = three_decades();
  plot.x.logarithmic = plot.y.logarithmic = false;
  const auto dots = circles(svg_plot(plot));
  ASSERT_GE(dots.size(), 3U);
  EXPECT_NEAR((dots[2].x - dots[0].x) / (dots[1].x - dots[0].x), 11,
              0.1);  // .099 / .009, to a tenth of a pixel
}

TEST(SvgPlot, WhatIsZeroStandsBelowTheLowestDecade) {
  Plot plot = three_decades();
  plot.series[0].points.push_back({1, 0, 0, 0, "exact", false});
  const auto dots = circles(svg_plot(plot));
  ASSERT_GE(dots.size(), 4U);
  for (int i = 0; i < 3; ++i) EXPECT_GT(dots[3].y, dots[static_cast<std::size_t>(i)].y + 5);
  EXPECT_LT(dots[3].y, plot.height);
}

TEST(SvgPlot, TextsAreEscapedAndTimesHaveUnits) {
  const std::string svg = svg_plot(three_decades());
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
  EXPECT_THAT(svg, Not(HasSubstr("a < b")));
  EXPECT_THAT(svg, HasSubstr(">10 ms<"));
  EXPECT_THAT(svg, HasSubstr(">first<"));
}

TEST(SvgPlot, TheLegendNamesOnlyWhatHasAName) {
  Plot plot = three_decades();
  plot.mark_name = "front";
  EXPECT_EQ(circles(svg_plot(plot)).size(), 4U);  // three points, and their symbol beside the name
  plot.series[0].name.clear();
  const std::string svg = svg_plot(plot);
  EXPECT_EQ(circles(svg).size(), 3U);
  EXPECT_THAT(svg, HasSubstr(">front<"));
}

TEST(SvgPlot, EverythingStaysInsideThePicture) {
  Plot plot = three_decades();
  plot.series.push_back(
      {"a second series with a long name", {{5e-3, 3, 4e-3, 7e-3, "a long label beside it", false}}});
  const std::string svg = svg_plot(plot);
  const std::regex place("x=\"([-0-9.]+)\" y=\"([-0-9.]+)\"");
  int count = 0;
  for (std::sregex_iterator it(svg.begin(), svg.end(), place), end; it != end; ++it, ++count) {
    EXPECT_GE(std::stod((*it)[1]), 0);
    EXPECT_LE(std::stod((*it)[1]), plot.width);
    EXPECT_GE(std::stod((*it)[2]), 0);
    EXPECT_LE(std::stod((*it)[2]), plot.height);
  }
  EXPECT_GT(count, 5);
}

TEST(SvgPlot, NothingAndWhatIsNotFiniteAreErrors) {
  Plot plot = three_decades();
  plot.series[0].points[1].y = std::nan("");
  EXPECT_THAT(test::error_of([&] { svg_plot(plot); }, ExitCode::no_output), HasSubstr("not finite"));
  plot.series.clear();
  EXPECT_THAT(test::error_of([&] { svg_plot(plot); }, ExitCode::no_output), HasSubstr("no point"));
}

}  // namespace
}  // namespace plisse::io
