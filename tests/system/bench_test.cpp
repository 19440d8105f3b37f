// plisse bench from outside, at its smallest: it runs, and what it writes hangs together. Its numbers mean
// nothing there.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::HasSubstr;

class Bench : public Program {
 protected:
  TemporaryFolder folder_;
};

TEST_F(Bench, SmokeRunsEverySuiteAndWritesTablesPlotsAndAPage) {
  const auto out = folder_ / "bench";
  const Outcome outcome =
      plisse({"bench", "smoke", "-q", "-o", out.string(), "--json", (folder_ / "report.json").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(read_text(folder_ / "report.json"));
  EXPECT_TRUE(json["machine"].contains("processor"));
  std::set<std::string> suites;
  for (const auto& row : json["rows"]) {
    suites.insert(row["suite"].get<std::string>());
    EXPECT_TRUE(row["error"].is_number()) << row;  // null would be what is not finite
    EXPECT_GE(row["error"].get<double>(), 0) << row;
    EXPECT_GT(row["seconds"].get<double>(), 0) << row;
    EXPECT_LE(row["seconds_spread"][0], row["seconds_spread"][1]) << row;
    EXPECT_FALSE(row["error_unit"].get<std::string>().empty()) << row;
    EXPECT_FALSE(row["truth"].get<std::string>().empty()) << row;
  }
  EXPECT_THAT(suites, ::testing::UnorderedElementsAre("relaxation", "precision", "shading", "mesh", "method",
                                                      "output", "sizing"));

  // A line a row, and every file that the page or the report names is there.
  const std::string csv = read_text(out / "rows.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), json["rows"].size() + 1);
  const std::string page = read_text(out / "index.html");
  const std::regex picture("src=\"([^\"]+)\"");
  int pictures = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), picture), end; it != end; ++it, ++pictures)
    EXPECT_TRUE(std::filesystem::exists(out / (*it)[1].str())) << (*it)[1];
  EXPECT_GT(pictures, 10);
  for (const auto& path : json["outputs"])
    EXPECT_TRUE(std::filesystem::exists(path.get<std::string>())) << path;
}

TEST_F(Bench, TheShadersAreAsNearToTheReferenceAsVerifySays) {
  const Outcome outcome = plisse({"bench", "smoke", "precision", "-q", "-o", (folder_ / "bench").string(),
                                  "--json", (folder_ / "report.json").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::map<std::string, double> worst;
  const auto json = nlohmann::json::parse(read_text(folder_ / "report.json"));
  for (const auto& row : json["rows"]) {
    const std::string setting = row["setting"];
    if (!setting.starts_with("reference"))
      worst[setting] = row["error"];
    else
      EXPECT_EQ(row["error"], 0);
  }
  // The tolerances of src/pipeline/verify_waves.cpp for the worst vertex, which no root mean square may pass.
  EXPECT_GT(worst.at("shader, float, skin"), 0);
  EXPECT_LT(worst.at("shader, float, skin"), 1e-6);
  EXPECT_LT(worst.at("shader, float, crush"), 1e-4);
  EXPECT_LT(worst.at("shader, float, render"), 0.02);
}

TEST_F(Bench, WordsThatMeanNothingAreUsage) {
  const Outcome none = plisse({"bench"});
  EXPECT_EQ(none.code, 2);
  const Outcome wrong = plisse({"bench", "qick"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'quick'"));
  const Outcome nowhere =
      plisse({"bench", "smoke", "--assets", folder_.path().string(), "-o", (folder_ / "b").string()});
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("sleeve.toml"));
}

}  // namespace
}  // namespace plisse::test
