// A pose that holds: nothing is done again, but nothing that is due is left out either.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "pipeline/history.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

class Hold : public test::OpenGlTest {};

// A sheet of 5 × 5 vertices as 24 OBJ files: squeezed frame by frame to 80 % at frame 10, still from there.
config::SceneSettings squeezed_then_still(const std::filesystem::path& folder) {
  for (int frame = 1; frame <= 24; ++frame) {
    const double width = 1 - 0.2 * std::min(frame - 1, 9) / 9.0;
    std::string text;
    for (int i = 0; i < 25; ++i) text += fmt::format("v {} {} 0\n", width * (i % 5) / 4.0, (i / 5) / 4.0);
    for (int i = 1; i < 20; ++i) {
      if (i % 5 != 0) text += fmt::format("f {} {} {} {}\n", i, i + 1, i + 6, i + 5);
    }
    test::write_text(folder / fmt::format("sheet_{:04}.obj", frame), text);
  }
  config::SceneSettings settings;
  settings.model.path = (folder / "sheet_####.obj").string();
  return settings;
}

TEST_F(Hold, IsCrushedOnceMoreWhereTheIntervalPutIt) {
  const test::TemporaryFolder folder;
  config::SceneSettings settings = squeezed_then_still(folder.path());
  settings.relax.interval = 4;  // crush at 1, 5, 9, 13, …
  History run(settings);
  EXPECT_LT(run.at(12).compression[12], 0.199);  // as of frame 9
  const test::Readings due = run.at(13);
  EXPECT_NEAR(due.compression[12], 0.2, 1e-5);  // single precision's 1e-6 and μ's 1e-6, with room
  EXPECT_FALSE(run.stepper.unchanged());
  const test::Readings last = run.at(24);
  EXPECT_TRUE(run.stepper.unchanged());
  EXPECT_EQ(last.phase, due.phase);
  EXPECT_EQ(run.stepper.unchanged_steps(), 24 - 10 - 1);  // all after frame 10 but 13
}

TEST_F(Hold, LeavesEverythingAsItWas) {
  const test::TemporaryFolder folder;
  History run(squeezed_then_still(folder.path()));
  const test::Readings ten = run.at(10), last = run.at(24);
  EXPECT_EQ(last.phase, ten.phase);
  EXPECT_EQ(last.height, ten.height);
  EXPECT_EQ(run.stepper.unchanged_steps(), 14);
}

// The way back to the first frame's phases is made while the pose holds, too: frame 24 is one share of nine
// short of it.
TEST_F(Hold, DoesNotKeepALoopFromClosing) {
  const test::TemporaryFolder folder;
  config::SceneSettings settings = squeezed_then_still(folder.path());
  settings.model.loop = true;
  settings.model.rest = "frame:5";  // so that frame 1 has waves to come back to
  History run(settings);
  const test::Readings first = run.at(1), before = run.at(16), last = run.at(24);
  double whole = 0, left = 0;
  for (std::size_t v = 0; v < first.phase.size(); ++v) {
    if (first.status[v] != 1 || last.status[v] != 1) continue;
    const double sign = glm::dot(first.direction[v], last.direction[v]) < 0 ? -1 : 1;
    whole += std::abs(test::wrap_radians(sign * first.phase[v] - before.phase[v]));
    left += std::abs(test::wrap_radians(sign * first.phase[v] - last.phase[v]));
  }
  EXPECT_NEAR(left, whole / 9, 1e-4 * whole + 1e-4);  // eight of nine equal shares; single precision
}

}  // namespace
}  // namespace plisse::pipeline
