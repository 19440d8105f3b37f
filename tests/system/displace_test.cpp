// plisse render --displace from outside: other pixels than shading, the same look, its own hash.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "io/picture/flip.h"
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

// Shading against what it stands for, at waves of 1, 1/2 and 1/4 edge length (docs/passes.md, "Displacement",
// has the table). The same pixel sees another point of a fold in either, by its parallax and by what hides
// it, and the more so the higher the waves are; so both errors fall with the wavelength until folds are a few
// pixels wide, and never to nothing.
TEST_F(Displaced, TheFinerTheWavesTheLessGeometryDiffersFromShading) {
  constexpr double edge = 0.0263;  // the sleeve's mean edge, metres
  double last = 1;
  for (const double share : {1.0, 0.5, 0.25}) {
    const auto drawn_with = [&](const std::string& name, const std::vector<std::string>& more) {
      std::vector<std::string> arguments{"render",
                                         asset("sleeve.toml").string(),
                                         "-q",
                                         "--frames",
                                         "37",
                                         "--size",
                                         "640x512",
                                         "-o",
                                         (folder_ / name).string(),
                                         "--wavelength",
                                         std::to_string(share * edge),
                                         "--aov",
                                         "normal"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      const Outcome outcome = plisse(arguments);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      return io::load_image(folder_ / name);
    };
    const io::Image shading = drawn_with("a.png", {}), geometry = drawn_with("b.png", {"--displace"});
    const io::Image a = io::load_image(folder_ / "a.normal.png"),
                    b = io::load_image(folder_ / "b.normal.png");
    std::vector<std::uint8_t> both;
    double angle = 0, pixels = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
      both.push_back(a.rgba[i + 3] > 0 && b.rgba[i + 3] > 0 ? 1 : 0);
      if (both.back() == 0) continue;
      double dot = 0, squares[2] = {0, 0};
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = a.rgba[i + c] / 127.5 - 1, y = b.rgba[i + c] / 127.5 - 1;
        dot += x * y;
        squares[0] += x * x;
        squares[1] += y * y;
      }
      angle +=
          std::acos(std::clamp(dot / std::sqrt(squares[0] * squares[1]), -1.0, 1.0)) * 180 / std::numbers::pi;
      pixels += 1;
    }
    const double flip = io::flip(geometry, shading, both).mean;
    std::cout << "wavelength " << share << " edges: FLIP " << flip << ", normals " << angle / pixels
              << " degrees\n";
    EXPECT_LT(flip, last);
    EXPECT_LT(angle / pixels, 12);
    last = flip;
  }
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
