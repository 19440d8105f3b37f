// plisse render --displace from outside: other pixels than shading, the same look, its own hash.
#include <gmock/gmock.h>

#include <cmath>

#include "io/flip.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::HasSubstr;

class Displaced : public Program {
 protected:
  io::Image drawn(const std::string& name, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{
        "render", asset("sleeve.toml").string(), "-q",       "--frames", "30",        "--size", "320x256",
        "-o",     (folder_ / name).string(),     "--levels", "3",        "--displace"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return io::load_image(folder_ / name);
  }
  TemporaryFolder folder_;
};

TEST_F(Displaced, GeometryLooksLikeTheShadingOfTheSameFrame) {
  const io::Image geometry = drawn("a.png", {});
  const Outcome outcome = plisse({"render", asset("sleeve.toml").string(), "-q", "--frames", "30", "--size",
                                  "320x256", "-o", (folder_ / "b.png").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const io::Image shading = io::load_image(folder_ / "b.png");
  EXPECT_NE(geometry.rgba, shading.rgba);
  const double apart = io::flip(shading, geometry).mean;
  // Folds move by their parallax and rims stand out.
  RecordProperty("flip", std::to_string(apart));
  EXPECT_LT(apart, 0.03);
  // Geometry whose waves are half as high is further away than that.
  EXPECT_GT(io::flip(shading, drawn("c.png", {"--strength", "0.5"})).mean, 1.2 * apart);
}

TEST_F(Displaced, WithoutWavesItIsTheSameSurface) {
  const io::Image geometry = drawn("a.png", {"--strength", "0"});
  const Outcome outcome = plisse({"render", asset("sleeve.toml").string(), "-q", "--frames", "30", "--size",
                                  "320x256", "-o", (folder_ / "b.png").string(), "--strength", "0"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const io::Image shading = io::load_image(folder_ / "b.png");
  int differing = 0;
  for (std::size_t i = 0; i < shading.rgba.size(); ++i)
    differing += std::abs(int{shading.rgba[i]} - int{geometry.rgba[i]}) > 4 ? 1 : 0;
  // As verify's tolerance for pictures: 4/255, but for pixels on edges of small triangles.
  EXPECT_LT(differing, static_cast<int>(shading.rgba.size() / 200));
}

TEST_F(Displaced, SkipExistingTellsGeometryFromShading) {
  drawn("a.png", {});
  const std::vector<std::string> shaded{"render",
                                        asset("sleeve.toml").string(),
                                        "--frames",
                                        "30",
                                        "--size",
                                        "320x256",
                                        "-o",
                                        (folder_ / "a.png").string(),
                                        "--skip-existing",
                                        "--json",
                                        (folder_ / "report.json").string()};
  ASSERT_EQ(plisse(shaded).code, 0);
  EXPECT_EQ(nlohmann::json::parse(read_text(folder_ / "report.json"))["frames"][0]["skipped"], false);
}

TEST_F(Displaced, AovsAreThoseOfTheGeometry) {
  drawn("a.png", {"--aov", "height,normal,amplitude,depth"});
  EXPECT_THAT(names_in(folder_.path()), ::testing::Contains("a.height.exr"));
  const Outcome refused = plisse({"render", asset("sleeve.toml").string(), "--displace", "--aov", "phase"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("do not go with --displace"));
}

TEST_F(Displaced, LevelsAreWholeNumbersAndGoWithDisplace) {
  const Outcome alone = plisse({"render", asset("sleeve.toml").string(), "--levels", "2"});
  EXPECT_EQ(alone.code, 2);
  EXPECT_THAT(alone.err, HasSubstr("--levels goes with --displace"));
  const Outcome many = plisse({"render", asset("sleeve.toml").string(), "--displace", "--levels", "9"});
  EXPECT_EQ(many.code, 2);
  EXPECT_THAT(many.err, HasSubstr("allowed: 0 … 8"));
}

}  // namespace
}  // namespace plisse::test
