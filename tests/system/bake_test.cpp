// plisse bake from outside: maps against closed forms and against geometry, in Blender too; and what it
// refuses.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>

#include "io/picture/image.h"
#include "system/blender.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A tube round y, radius 0.1, 24 vertices round and 7 along 0.4 · `squeeze`; uv unrolls it, with a seam. Half
// of it is mirrored in uv, beside the other half.
std::string tube(double squeeze) {
  constexpr int round = 24, along = 7;
  std::string obj;
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < round; ++i) {
      const double a = 2 * std::numbers::pi * i / round;
      obj += fmt::format("v {} {} {}\nvn {} 0 {}\n", 0.1 * std::sin(a), 0.4 * squeeze * j / (along - 1),
                         0.1 * std::cos(a), std::sin(a), std::cos(a));
    }
    for (int i = 0; i <= round; ++i) {
      const double s = i / static_cast<double>(round);
      const double u = i <= round / 2 ? 0.05 + 0.8 * s : 0.95 - 0.8 * (s - 0.5);
      obj += fmt::format("vt {} {}\n", u, 0.05 + 0.9 * j / (along - 1));
    }
    // Where the halves meet in the middle: the mirrored one's own uv.
    obj += fmt::format("vt 0.95 {}\n", 0.05 + 0.9 * j / (along - 1));
  }
  const auto corner = [&](int i, int j, bool mirrored) {
    const int place = j * round + i % round + 1;
    const int uv = j * (round + 2) + (mirrored && i == round / 2 ? round + 1 : i) + 1;
    return fmt::format(" {}/{}/{}", place, uv, place);
  };
  for (int j = 0; j + 1 < along; ++j) {
    for (int i = 0; i < round; ++i) {
      const bool mirrored = i >= round / 2;
      obj += fmt::format("f{}{}{}\n", corner(i, j, mirrored), corner(i + 1, j, mirrored),
                         corner(i + 1, j + 1, mirrored));
      obj += fmt::format("f{}{}{}\n", corner(i, j, mirrored), corner(i + 1, j + 1, mirrored),
                         corner(i, j + 1, mirrored));
    }
  }
  return obj;
}

class Bake : public Program {
 protected:
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void run(const std::vector<std::string>& arguments) const {
    const Outcome outcome = plisse(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  std::string refused(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"bake", asset("square.toml").string(), "-q", "--frames", "1"});
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  }
  TemporaryFolder folder_;
};

// The square at 50 %: height .21651 W of waves along x; so the largest slope is 2π · .21651/.5, and all of a
// normal's tilt is along the squeeze.
TEST_F(Bake, TheSquaresMapsHaveItsHeightAndSlope) {
  run({"bake", asset("square.toml").string(), "-q", "--frames", "73", "--texture-size", "512", "-o",
       file("maps"), "--json", file("report.json")});
  EXPECT_THAT(names_in(folder_ / "maps"),
              ElementsAre("height_0073.exr", "height_0073.png", "normal_0073.png"));
  const auto json = nlohmann::json::parse(read_text(folder_ / "report.json"));
  EXPECT_EQ(json["overlapping"], 0);
  const io::Image height = io::load_image(folder_ / "maps/height_0073.png"),
                  normal = io::load_image(folder_ / "maps/normal_0073.png");
  ASSERT_EQ(height.width, 512);
  int highest = 0, lowest = 255;
  double steepest = 0, across = 0;
  for (std::size_t i = 0; i < height.rgba.size(); i += 4) {
    highest = std::max(highest, int{height.rgba[i]});
    lowest = std::min(lowest, int{height.rgba[i]});
    const auto component = [&](std::size_t c) { return normal.rgba[i + c] / 127.5 - 1; };
    steepest = std::max(steepest, std::abs(component(0)) / component(2));
    across = std::max(across, std::abs(component(1)));
  }
  // White is W/4: .21651/.25 of the way, and eight bits.
  const double share = 0.21651 / 0.25;
  EXPECT_NEAR(highest, 127.5 + 127.5 * share, 1.5);
  EXPECT_NEAR(lowest, 127.5 - 127.5 * share, 1.5);
  // Blending between waves that meet nearly takes and adds some (docs/passes.md: 2 % of wavelength), and
  // eight bits of a normal 70° off its vertical keep 4 % of the slope.
  EXPECT_NEAR(steepest / (2 * std::numbers::pi * 0.21651 / 0.5), 1, 0.15);
  EXPECT_LT(across, 0.25);
}

// The assets' own uv repeat their patterns, several tiles wide.
TEST_F(Bake, RepeatingUvIsBakedIntoOneMapOfAllTiles) {
  run({"bake", asset("zeppelin.toml").string(), "-q", "--frames", "2", "--texture-size", "256", "-o",
       file("maps"), "--maps", "height", "--json", file("report.json")});
  const auto json = nlohmann::json::parse(read_text(folder_ / "report.json"));
  EXPECT_GT(json["uv"]["side"], 1);
  EXPECT_GT(json["covered"], 256 * 256 / 20);
}

// The square lies in z = 0; a box under it ends half a wave's height below.
TEST_F(Bake, WhatABodyStopsIsLevelThere) {
  const double top = -0.5 * 0.021651;
  std::string box;
  for (const double z : {-1.0, top})
    for (const double y : {-2, 2})
      for (const double x : {-2, 2}) box += fmt::format("v {} {} {}\n", x, y, z);
  write_text(folder_ / "box.obj", box + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n");
  run({"bake", asset("square.toml").string(), "-q", "--frames", "73", "--texture-size", "256", "-o",
       file("maps"), "--outside", file("box.obj")});
  const io::Image height = io::load_image(folder_ / "maps/height_0073.png"),
                  normal = io::load_image(folder_ / "maps/normal_0073.png");
  // Black is −W/4, as above.
  const double lowest = 127.5 + 127.5 * top / 0.025;
  std::size_t stopped = 0;
  for (std::size_t i = 0; i < height.rgba.size(); i += 4) {
    EXPECT_GE(height.rgba[i], lowest - 0.5);
    if (height.rgba[i] > lowest + 0.5) continue;
    ++stopped;
    // A texel beside them may be as low to eight bits and not lie on the box.
    if (i < 4 || i + 4 >= height.rgba.size() || height.rgba[i - 4] != height.rgba[i] ||
        height.rgba[i + 4] != height.rgba[i])
      continue;
    EXPECT_NEAR(normal.rgba[i], 127.5, 1) << i;
    EXPECT_NEAR(normal.rgba[i + 1], 127.5, 1) << i;
    EXPECT_EQ(normal.rgba[i + 2], 255) << i;
  }
  // cos φ < −1/2 on a third of a wave; where waves meet that differs.
  EXPECT_NEAR(static_cast<double>(stopped) / (256 * 256), 1.0 / 3, 0.05);
}

TEST_F(Bake, GreenPointsUpOrDown) {
  for (const char* green : {"up", "down"})
    run({"bake", asset("square.toml").string(), "-q", "--frames", "73", "--texture-size", "64", "-o",
         file(green), "--maps", "normal", "--green", green});
  EXPECT_THAT(names_in(folder_ / "up"), ElementsAre("normal_0073.png"));
  const io::Image up = io::load_image(folder_ / "up/normal_0073.png"),
                  down = io::load_image(folder_ / "down/normal_0073.png");
  for (std::size_t i = 0; i < up.rgba.size(); i += 4) {
    EXPECT_EQ(up.rgba[i], down.rgba[i]);
    EXPECT_NEAR(int{up.rgba[i + 1]} + int{down.rgba[i + 1]}, 255, 1);
  }
}

TEST_F(Bake, RefusesWhatCannotBeBaked) {
  EXPECT_THAT(refused({}), HasSubstr("name the folder with -o"));
  EXPECT_THAT(refused({"-o", file("a"), "--maps", "hight"}), HasSubstr("did you mean 'height'"));
  EXPECT_THAT(refused({"-o", file("a"), "--texture-size", "8"}), HasSubstr("allowed: 16 … 16384"));
  EXPECT_THAT(refused({"-o", file("a"), "--green", "left"}), HasSubstr("up or down"));
  write_text(folder_ / "bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(plisse({"bake", file("bare.obj"), "-q", "-o", file("a")}).err, HasSubstr("has no uv"));
  EXPECT_THAT(names_in(folder_.path()), ElementsAre("bare.obj"));
}

TEST_F(Bake, InBlenderTheCoarseMeshWearsTheWrinklesOfTheFineOne) {
  if (!has_blender()) GTEST_SKIP() << "no Blender with numpy on this machine";
  write_text(folder_ / "tube_1.obj", tube(1));
  write_text(folder_ / "tube_2.obj", tube(0.8));
  write_text(folder_ / "scene.toml", "[model]\npath = \"tube_#.obj\"\n[wrinkles]\nwavelength = 0.05\n");
  const std::string scene = file("scene.toml");
  run({"bake", scene, "-q", "--frames", "2", "--maps", "normal", "--texture-size", "1024", "-o",
       file("maps")});
  std::filesystem::rename(folder_ / "maps/normal_0002.png", folder_ / "normal.png");
  run({"export", scene, "-q", "--frames", "2", "--strength", "0", "--levels", "0", "-o", file("coarse.obj")});
  run({"export", scene, "-q", "--frames", "2", "--levels", "5", "-o", file("fine.obj")});
  const Outcome outcome = blender_script("blender_bake.py", {folder_.path().string(), file("report.json")});
  ASSERT_TRUE(std::filesystem::exists(folder_ / "report.json")) << outcome.out << outcome.err;
  const auto json = nlohmann::json::parse(read_text(folder_ / "report.json"));
  EXPECT_GT(json["pixels"], 2000);
  // The map lies on the flat sides of a tube of 24 of them, the geometry stands out: a fold's picture shifts
  // by a pixel or two, more to the sides.
  EXPECT_LT(json["worn_deg"], 6);
  EXPECT_GT(json["bare_deg"], 3 * json["worn_deg"].get<double>());
}

}  // namespace
}  // namespace plisse::test
