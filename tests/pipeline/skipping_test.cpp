// Only what a scene needs: what is left out is counted, saves something, and changes no byte; and what a
// budget gives up, it gives up in order and takes back.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "config/settings.h"
#include "io/picture/image.h"
#include "io/picture/png.h"
#include "pipeline/history.h"
#include "pipeline/render.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::Not;

class Skipping : public test::OpenGlTest {};
class SkippingRuns : public test::DriverTest {};

// A sheet of 5 × 5 vertices as OBJ files; `width` says how wide it is at a frame, 1 at rest.
config::SceneSettings sheet(const std::filesystem::path& folder, int frames,
                            const std::function<double(int)>& width) {
  for (int frame = 1; frame <= frames; ++frame) {
    std::string text;
    for (int i = 0; i < 25; ++i)
      text += fmt::format("v {} {} 0\n", width(frame) * (i % 5) / 4.0, (i / 5) / 4.0);
    for (int i = 1; i < 20; ++i) {
      if (i % 5 != 0) text += fmt::format("f {} {} {} {}\n", i, i + 1, i + 6, i + 5);
    }
    test::write_text(folder / fmt::format("sheet_{:04}.obj", frame), text);
  }
  config::SceneSettings settings;
  settings.model.path = (folder / "sheet_####.obj").string();
  settings.output.width = 64;
  settings.output.height = 48;
  settings.output.path = (folder / "out").string();
  return settings;
}

double squeezed_then_still(int frame) {
  return 1 - 0.2 * std::min(frame - 1, 4) / 4.0;
}
double stretched_then_squeezed(int frame) {
  return frame <= 6 ? 1 + 0.01 * frame : 1 - 0.02 * frame;
}

std::filesystem::path frame(const config::SceneSettings& settings, int number) {
  return std::filesystem::path(settings.output.path) / fmt::format("frame_{:04}.png", number);
}

TEST_F(SkippingRuns, APictureThatStaysIsDrawnAndCompressedOnce) {
  const test::TemporaryFolder folder;
  pipeline::RenderRequest request;
  request.scene = sheet(folder.path(), 12, squeezed_then_still);
  const pipeline::RenderReport report = pipeline::render(request, {});
  EXPECT_EQ(report.skipped.at("unchanged poses"), 7);  // frames 6 … 12
  EXPECT_EQ(report.skipped.at("copied pictures"), 7);
  EXPECT_GT(report.saved_s.at("copied pictures"), 0);
  for (const pipeline::FrameReport& entry : report.frames) {
    EXPECT_EQ(entry.ms.contains("render"), entry.frame <= 5) << entry.frame;
    EXPECT_EQ(std::ranges::count(entry.left_out, "copied pictures"), entry.frame > 5 ? 1 : 0) << entry.frame;
  }
  // The pixels of frame 5 under the name and the hash of its own, as when it is drawn alone.
  const auto five = io::load_image(frame(request.scene, 5)),
             twelve = io::load_image(frame(request.scene, 12));
  EXPECT_EQ(five.rgba, twelve.rgba);
  const auto copied = test::read_bytes(frame(request.scene, 12));
  EXPECT_NE(copied, test::read_bytes(frame(request.scene, 5)));
  request.scene.model.frames = "12";
  EXPECT_FALSE(pipeline::render(request, {}).skipped.contains("copied pictures"));
  EXPECT_EQ(test::read_bytes(frame(request.scene, 12)), copied);
}

TEST_F(Skipping, NothingToRelaxIsNotRelaxed) {
  const test::TemporaryFolder folder;
  pipeline::History run(sheet(folder.path(), 12, stretched_then_squeezed));
  const test::Readings one = run.at(1), six = run.at(6);
  EXPECT_EQ(run.stepper.idle_relaxations(), 6);
  EXPECT_FALSE(run.stepper.descended());
  EXPECT_EQ(one.phase, six.phase);
  EXPECT_THAT(six.status, Each(0));
  const test::Readings twelve = run.at(12);
  EXPECT_EQ(run.stepper.idle_relaxations(), 6);
  EXPECT_TRUE(run.stepper.descended());
  EXPECT_THAT(twelve.status, Contains(Not(0)));
}

TEST_F(Skipping, WhatTheLastRoundMovedFallsAsTheWavesComeToRest) {
  const test::TemporaryFolder folder;
  config::SceneSettings settings =
      sheet(folder.path(), 40, [](int n) { return n == 1 ? 1.0 : 0.8 - 1e-6 * n; });
  settings.relax.mode = config::RelaxMode::descent;  // from random phases
  pipeline::History run(settings);
  run.at(2);
  const double begun = run.stepper.last_round_moved();
  run.at(40);
  const double late = run.stepper.last_round_moved();
  // A random phase is π/√3 off on average; a round with ε = 13.2 covers ε/2π² of what the neighbours differ
  // by.
  EXPECT_GT(begun, 0.1);
  EXPECT_LT(begun, 3.2);
  EXPECT_LT(late, 0.05 * begun);
}

TEST_F(SkippingRuns, ASurfaceOutOfViewIsStepsWithoutDrawing) {
  for (const int samples : {1, 4}) {
    const test::TemporaryFolder folder;
    pipeline::RenderRequest request;
    request.scene = sheet(folder.path(), 3, [](int n) { return 1 - 0.05 * n; });
    request.scene.output.samples = samples;
    request.scene.camera.explicit_pose = true;
    request.scene.camera.eye = {0.5, 0.5, 5};
    request.scene.camera.target = {40, 0.5, 5};  // past it
    const pipeline::RenderReport report = pipeline::render(request, {});
    EXPECT_EQ(report.skipped.at("surfaces out of view"), 3);
    const io::Image image = io::load_image(frame(request.scene, 3));
    for (std::size_t i = 0; i < image.rgba.size(); ++i) ASSERT_EQ(image.rgba[i], image.rgba[i % 4]) << i;
    request.scene.camera.target = {0.5, 0.5, 0};
    EXPECT_FALSE(pipeline::render(request, {}).skipped.contains("surfaces out of view"));
    EXPECT_NE(io::load_image(frame(request.scene, 3)).rgba, image.rgba);
  }
}

TEST_F(SkippingRuns, AnErrorBuysRoundsAndItsFramesClaimNoHash) {
  const test::TemporaryFolder folder;
  pipeline::RenderRequest request;
  request.scene = sheet(folder.path(), 8, [](int n) { return 1 - 0.03 * n; });
  request.scene.relax.mode = config::RelaxMode::descent;
  request.max_error = 1e-9;
  const pipeline::RenderReport strict = pipeline::render(request, {});
  EXPECT_EQ(strict.frames.front().effort, (pipeline::Effort{1, 1, 4}));
  EXPECT_GE(strict.frames.back().effort->rounds, 32);
  const std::string text = test::read_text(frame(request.scene, 8));
  EXPECT_EQ(text.find("plisse-hash"), std::string::npos);
  request.max_error = 100;  // more than any phase can be off
  const pipeline::RenderReport loose = pipeline::render(request, {});
  EXPECT_EQ(loose.frames.back().effort->rounds, 1);
  EXPECT_EQ(loose.frames.back().effort->interval, 4);

  request.skip_existing = true;
  EXPECT_THAT(test::error_of([&] { pipeline::render(request, {}); }),
              ::testing::AllOf(::testing::HasSubstr("--max-error"), ::testing::HasSubstr("--skip-existing")));
  request.skip_existing = false;
  request.budget_ms = 10;
  EXPECT_THAT(test::error_of([&] { pipeline::render(request, {}); }), ::testing::HasSubstr("exclude"));
}

// Frames that cost what their effort does: 10 ms, 4 a round each interval, 10 a sample.
double cost(const pipeline::Effort& effort) {
  return 10 + 4.0 * effort.rounds / effort.interval + 10.0 * effort.samples;
}

TEST(TimeBudget, GivesUpWhatIsSeenLeastFirst) {
  const pipeline::Effort wanted{5, 1, 4};  // 70 ms
  for (const auto& [allowed, kept] :
       std::vector<std::pair<double, pipeline::Effort>>{{80, wanted},
                                                        {60, {1, 1, 4}},     // 54
                                                        {53, {1, 2, 4}},     // 52
                                                        {51.5, {1, 4, 4}},   // 51
                                                        {30, {1, 4, 1}}}) {  // 21
    pipeline::TimeBudget budget(wanted, allowed);
    for (int n = 0; n < 100; ++n) budget.spent(cost(budget.effort()));
    EXPECT_EQ(budget.effort(), kept) << allowed;
  }
}

TEST(TimeBudget, TheFirstFrameIsNoMeasureAndGoodTimesComeBack) {
  const pipeline::Effort wanted{5, 1, 4};
  pipeline::TimeBudget budget(wanted, 80);
  budget.spent(1000);  // compiles its shaders
  EXPECT_EQ(budget.effort(), wanted);
  for (int n = 0; n < 50; ++n) budget.spent(3 * cost(budget.effort()));
  EXPECT_EQ(budget.effort().samples, 1);
  for (int n = 0; n < 50; ++n) budget.spent(cost(budget.effort()));
  EXPECT_EQ(budget.effort(), wanted);
}

TEST(ErrorBudget, FindsTheRoundsThatAnErrorTakes) {
  pipeline::ErrorBudget budget({1, 1, 4}, 0.1);
  for (int n = 0; n < 20; ++n) budget.moved(1.0 / budget.effort().rounds);  // ten rounds would do
  EXPECT_EQ(budget.effort().rounds, 16);
  for (int n = 0; n < 20; ++n) budget.moved(1e-3);
  EXPECT_EQ(budget.effort(), (pipeline::Effort{1, pipeline::ErrorBudget::longest_interval, 4}));
  budget.moved(0.2);
  EXPECT_EQ(budget.effort(), (pipeline::Effort{1, 1, 4}));
}

}  // namespace
}  // namespace plisse
