// plisse measure from outside: the square's waves, exported and found again.
#include <gmock/gmock.h>

#include <cmath>

#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::HasSubstr;

class Measure : public Program {};

// At 50 % the waves are .21651 W high and half as long as W (wrinkle-passes.md, "Ground truth").
TEST_F(Measure, FindsTheWavesThatWereExported) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder / name).string(); };
  const std::string square = asset("square.toml").string();
  ASSERT_EQ(plisse({"export", square, "-q", "--frames", "73", "--levels", "4", "-o", file("fine.ply")}).code,
            0);
  ASSERT_EQ(plisse({"export", square, "-q", "--frames", "73", "--levels", "0", "--strength", "0", "-o",
                    file("base.ply")})
                .code,
            0);
  const Outcome outcome =
      plisse({"measure", file("fine.ply"), "--base", file("base.ply"), "--json", file("report.json"), "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(read_text(folder / "report.json"));
  ASSERT_FALSE(json["waves"].empty());
  const auto& wave = json["waves"][0];
  const double W = 0.1;  // of square.toml
  EXPECT_NEAR(wave["wavelength_m"].get<double>() / (0.5 * W), 1,
              0.04);  // 2 % of the measure, 2 % of the phases
  EXPECT_NEAR(wave["amplitude_m"].get<double>() / (0.21651 * W), 1, 0.05);
  EXPECT_GT(std::abs(wave["direction"][0].get<double>()), 0.999);
  EXPECT_EQ(json["spectrum"].size(), 64U);
}

TEST_F(Measure, SaysWhatItWants) {
  const Outcome outcome = plisse({"measure"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("give a MESH"));
  EXPECT_EQ(plisse({"measure", "nowhere.obj"}).code, 2);
}

}  // namespace
}  // namespace plisse::test
