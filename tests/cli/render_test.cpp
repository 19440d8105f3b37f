// `render` and `verify` from outside, on a driver: what they write, report and end with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fmt/format.h>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/program.h"
#include "io/picture/image.h"
#include "support/opengl.h"

namespace plisse {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class Render : public test::Program {
 protected:
  void SetUp() override {
    if (!test::opengl_works()) GTEST_SKIP() << test::opengl_problem();
  }

  // A sequence of a square of 5 × 5 vertices that is squeezed step by step.
  std::string squeezed_square(int frames) const {
    for (int frame = 1; frame <= frames; ++frame) {
      std::string text = "o cloth\n";
      const double squeeze = 1 - 0.4 * (frame - 1) / frames;
      for (int i = 0; i < 25; ++i) text += fmt::format("v {} {} 0\n", squeeze * (i % 5), i / 5);
      for (int i = 0; i < 16; ++i) {
        const int corner = i / 4 * 5 + i % 4 + 1;
        text += fmt::format("f {} {} {} {}\n", corner, corner + 1, corner + 6, corner + 5);
      }
      test::write_text(folder_ / fmt::format("cloth_{:04}.obj", frame), text);
    }
    return path("cloth_####.obj");
  }

  static std::vector<std::string> small(std::vector<std::string> arguments) {
    for (const char* more : {"--size", "64x48", "--samples", "1"}) arguments.emplace_back(more);
    return arguments;
  }
};

TEST_F(Render, SceneOfInitGivesTheBareModelsBytes) {
  const std::string model = squeezed_square(3);
  ASSERT_EQ(run(small({"render", model, "-o", path("bare")})).code, 0);
  ASSERT_EQ(run({"init", model, "-o", path("scenes/cloth.toml")}).code, 0);
  ASSERT_EQ(run(small({"render", path("scenes/cloth.toml"), "-o", path("scene")})).code, 0);
  for (const char* frame : {"frame_0001.png", "frame_0002.png", "frame_0003.png"}) {
    const auto bare = test::read_bytes(folder_ / "bare" / frame);
    ASSERT_FALSE(bare.empty()) << frame;
    EXPECT_EQ(test::read_bytes(folder_ / "scene" / frame), bare) << frame;
  }
}

TEST_F(Render, ReportHasTheContractsKeys) {
  const std::string model = squeezed_square(3);
  const Outcome outcome =
      run(small({"render", model, "-o", path("x_%02d.png"), "--frames", "1,3", "--json", "-"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  for (const char* key : {"vendor", "renderer", "version"}) EXPECT_NE(report["gl"][key], "") << key;
  EXPECT_EQ(report["vertices"]["welded"], 25);
  EXPECT_EQ(report["triangles"], 32);
  EXPECT_THAT(report["timer"].get<std::string>(), testing::AnyOf("cpu", "gpu"));
  ASSERT_EQ(report["frames"].size(), 2U);
  EXPECT_EQ(report["frames"][1]["frame"], 3);
  EXPECT_NEAR(report["frames"][1]["time_s"].get<double>(), 2.0 / 24, 1e-12);  // (n − 1)/fps, in double
  EXPECT_EQ(report["frames"][1]["path"], path("x_03.png"));
  for (const char* stage : {"skin", "crush", "relax", "render", "readback", "encode", "write"}) {
    EXPECT_TRUE(report["frames"][0]["ms"].contains(stage)) << stage;
  }
  for (const char* key : {"fps", "wall_s", "skipped"}) EXPECT_TRUE(report.contains(key)) << key;
  EXPECT_EQ(report["interrupted"], false);
  EXPECT_THAT(outcome.err, HasSubstr("1/2  ")) << "a plain line a frame where there is no terminal";
}

TEST_F(Render, SkipExistingKeepsWhatIsWhole) {
  const std::string model = squeezed_square(2);
  const auto arguments = small({"render", model, "-o", path("out"), "--skip-existing", "--json", "-"});
  ASSERT_EQ(run(arguments).code, 0);
  fs::resize_file(folder_ / "out/frame_0002.png", 100);
  const json report = json::parse(run(arguments).out);
  EXPECT_EQ(report["frames"][0]["skipped"], true);
  EXPECT_EQ(report["frames"][1]["skipped"], false);
}

TEST_F(Render, QuietSaysNothing) {
  const Outcome outcome = run(small({"render", squeezed_square(2), "-o", path("out"), "-q"}));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Render, MistakesOnlyTheModelCanTell) {
  const std::string model = squeezed_square(2);
  EXPECT_EQ(run(small({"render", model, "-o", path("o"), "--frames", "1-9"})).code, 2);
  EXPECT_EQ(run(small({"render", model, "-o", path("one.png")})).code, 2);
  EXPECT_EQ(run(small({"render", model, "-o", path("o"), "--only", "nobody"})).code, 2);
  EXPECT_EQ(run(small({"render", model, "-o", path("o"), "--aov", "hieght"})).code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "o"));
  test::write_text(folder_ / "file", "");
  EXPECT_EQ(run(small({"render", model, "-o", path("file/o")})).code, 5);
}

TEST_F(Render, SignalsEndARunAfterWholeFrames) {
  constexpr int frames = 150;
  const std::string model = squeezed_square(frames);
  for (const int number : {SIGINT, SIGTERM}) {
    const std::string out = path(fmt::format("out{}", number)), report = path("report.json");
    const pid_t child =
        start({"render", model, "-o", out, "--size", "1024x1024", "--samples", "4", "--json", report});
    // The second frame is there: the loop is running.
    for (int i = 0; i < 3000 && !fs::exists(out + "/frame_0002.png"); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    kill(child, number);
    const Outcome outcome = wait(child);
    EXPECT_EQ(outcome.code, 128 + number) << outcome.err;
    const auto names = test::names_in(out);
    EXPECT_GE(names.size(), 2U);
    EXPECT_LT(names.size(), static_cast<std::size_t>(frames)) << "too quick to be interrupted";
    for (const std::string& name : names) {
      EXPECT_THAT(name, testing::MatchesRegex("frame_[0-9]*\\.png")) << "litter";
      EXPECT_EQ(io::load_image(out + "/" + name).width, 1024) << name;
    }
    const json json_report = json::parse(test::read_text(report));
    EXPECT_EQ(json_report["interrupted"], true);
    EXPECT_EQ(json_report["frames"].size(), names.size());
  }
}

TEST_F(Render, VerifyReportsEveryPass) {
  const Outcome outcome =
      run(small({"verify", squeezed_square(3), "--frames", "3", "--json", path("v.json")}));
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("tolerance"));
  const json report = json::parse(test::read_text(folder_ / "v.json"));
  EXPECT_EQ(report["ok"], true);
  EXPECT_EQ(report["frames"], json({3}));
  for (const char* pass : {"skin", "crush", "relax", "render"}) {
    for (const char* key : {"max_abs", "rms", "tolerance", "ok"}) {
      EXPECT_TRUE(report["passes"][pass].contains(key)) << pass << "." << key;
    }
  }
  for (const char* key : {"fraction_within_4", "mean_flip", "silhouette_fraction"}) {
    EXPECT_TRUE(report["passes"]["render"].contains(key)) << key;
  }
  for (const char* key : {"phase_rms", "image_flip"}) EXPECT_TRUE(report["chain"].contains(key)) << key;
}

TEST_F(Render, ListsDevices) {
  const Outcome outcome = run({"render", "--list-devices"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("0:"));
}

}  // namespace
}  // namespace plisse
