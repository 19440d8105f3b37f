// The parts of `plisse bench` that have answers of their own: fronts, quartiles, turns, tables. What it
// measures is looked at through the finished program (tests/system/bench_test.cpp).
#include "bench/bench.h"

#include <gmock/gmock.h>

#include <sstream>

#include "bench/suite.h"
#include "bench/write.h"
#include "support/errors.h"

namespace plisse::bench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Row row(double seconds, double error, const std::string& scene = "a") {
  Row result{"suite", scene, "s", "l", {seconds, seconds, seconds}, Clock::cpu, "a frame"};
  result.error_of = "picture";
  result.error = error;
  result.error_unit = "FLIP";
  result.truth = "the finest";
  return result;
}

TEST(Fronts, HoldWhatNoOtherBeatsInBoth) {
  // (1, 5), (2, 3), (4, 1) are the front; (3, 3) loses to (2, 3), (4, 4) to several.
  std::vector<Row> rows{row(1, 5), row(2, 3), row(3, 3), row(4, 1), row(4, 4)};
  mark_fronts(rows);
  std::vector<bool> on;
  for (const Row& r : rows) on.push_back(r.on_front);
  EXPECT_THAT(on, ElementsAre(true, true, false, true, false));
}

TEST(Fronts, EqualsBothStandAndOtherScenesDoNotCount) {
  std::vector<Row> rows{row(1, 1), row(1, 1), row(9, 9, "b")};
  mark_fronts(rows);
  for (const Row& r : rows) EXPECT_TRUE(r.on_front);
}

TEST(Timing, QuartilesAreInterpolated) {
  const Distribution d = distribution({5, 1, 4, 2, 3});
  EXPECT_DOUBLE_EQ(d.median, 3);
  EXPECT_DOUBLE_EQ(d.low, 2);
  EXPECT_DOUBLE_EQ(d.high, 4);
  EXPECT_DOUBLE_EQ(distribution({1, 2}).median, 1.5);
}

TEST(Timing, CasesTakeTurns) {
  std::string order;
  take_turns({{"a", [&] { order += 'a'; }}, {"b", [&] { order += 'b'; }}}, {3, 0});
  // Unmeasured and once to find how often first, then in turn.
  EXPECT_THAT(order, ::testing::EndsWith("ababab"));
}

TEST(Tables, CsvQuotesWhatHasCommasAndQuotes) {
  BenchReport report;
  Row r = row(0.5, 2);
  r.truth = "\"finest\", 9 vertices";
  report.suites = {{"suite", "Suite", "note", {r}, {}}};
  const std::string csv = rows_csv(report);
  EXPECT_THAT(csv, HasSubstr("\"\"\"finest\"\", 9 vertices\""));
  EXPECT_THAT(csv, HasSubstr("suite,a,\"s, l\",0.5,0.5,0.5,cpu,a frame,picture,2,FLIP,"));
}

TEST(Tables, JsonHasTheKeysOfTheContract) {
  BenchReport report;
  report.machine = {{"processor", "x"}};
  report.suites = {{"suite", "Suite", "note", {row(0.5, 2)}, {}}};
  const auto json = to_json(report);
  EXPECT_EQ(json["machine"]["processor"], "x");
  ASSERT_EQ(json["rows"].size(), 1U);
  for (const char* key :
       {"suite", "scene", "setting", "seconds", "seconds_spread", "error", "error_unit", "truth"})
    EXPECT_TRUE(json["rows"][0].contains(key)) << key;
  EXPECT_EQ(json["rows"][0]["setting"], "s, l");
}

TEST(Plots, OneForEverySceneAndKindOfErrorWithTwoRows) {
  SuiteReport suite{"suite", "Suite", "note", {row(1, 2), row(2, 1), row(1, 1, "alone")}, {}};
  const auto drawn = plots(suite);
  ASSERT_EQ(drawn.size(), 1U);
  EXPECT_EQ(drawn[0].file, "plot_suite_a_picture_1.svg");
}

TEST(Page, EscapesAndIsWhole) {
  BenchReport report;
  report.machine = {{"processor", "<b>"}};
  report.suites = {{"suite", "a & b", "note", {row(1, 2), row(2, 1)}, {{"pictures/p.png", "p <1>"}}}};
  const std::string page = report_page(report);
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;"));
  EXPECT_THAT(page, HasSubstr("a &amp; b"));
  EXPECT_THAT(page, HasSubstr("p &lt;1&gt;"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, ::testing::EndsWith("</html>\n"));
}

TEST(Bench, AnUnknownSuiteIsAnErrorWithTheNearestName) {
  BenchRequest request;
  request.suites = {"relaxtion"};
  EXPECT_THAT(test::error_of([&] { bench(request); }), HasSubstr("did you mean 'relaxation'"));
}

}  // namespace
}  // namespace plisse::bench
