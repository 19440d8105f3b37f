// Wrinkles travel with the cloth and do not flicker: change of the height field from frame to frame, at
// points fixed to the cloth, against change of the pose. Measured on the demo's sleeve and two more clips.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "config/scene_file.h"
#include "pipeline/history.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

using std::numbers::pi;
using test::Readings;

// From one frame to the next, over vertices wrinkled and set in both (onsets apart: they come from nothing).
struct Change {
  double vertices = 0;
  double phase = 0;   // RMS of the change of phase, radians
  double jumps = 0;   // vertices whose phase changed by more than 1 rad
  double field = 0;   // RMS change of h cos φ over the RMS of h cos φ of random phases, h/√2
  double strain = 0;  // RMS change of the length of their edges, relative
};

Change change(const Surface& surface, const Readings& before, const Readings& now) {
  Change result;
  double power = 0, edges = 0;
  for (std::size_t v = 0; v < now.phase.size(); ++v) {
    const bool counts =
        now.weight[v] > 0 && before.weight[v] > 0 && now.status[v] == 1 && before.status[v] == 1;
    if (!counts) continue;
    // k keeps its sign in time, so phases can be compared as they are; were it to turn over, that would be a
    // jump as well.
    const double turned = test::wrap_radians(now.phase[v] - before.phase[v]);
    result.vertices += 1;
    result.phase += turned * turned;
    result.jumps += std::abs(turned) > 1 ? 1 : 0;
    const double moved =
        now.height[v] * std::cos(now.phase[v]) - before.height[v] * std::cos(before.phase[v]);
    result.field += moved * moved;
    power += 0.25 * (now.height[v] * now.height[v] + before.height[v] * before.height[v]);
    for (std::uint32_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i) {
      const std::uint32_t n = surface.neighbours.items[i];
      const double length = glm::distance(before.position[v], before.position[n]);
      const double strained = glm::distance(now.position[v], now.position[n]) / length - 1;
      result.strain += strained * strained;
      edges += 1;
    }
  }
  if (result.vertices > 0) {
    result.phase = std::sqrt(result.phase / result.vertices);
    result.field = std::sqrt(result.field / power);
    result.strain = std::sqrt(result.strain / edges);
  }
  return result;
}

// What random phases would do from frame to frame: differences of uniform phases have an RMS of π/√3 = 1.81,
// and cos φ − cos φ' has twice the power of cos φ.
constexpr double random_phase = 1.81, random_field = std::numbers::sqrt2;

// A wrinkle that has just left the dead zone δ grows, for a change Δs of r, by Δh/h = Δs/2δ, 100 Δs at δ =
// .005. Edges lie in all directions, so that their RMS strain is √⟨cos⁴⟩ = √(3/8) of the strain along the
// squeeze: 160 strains. And a twentieth, 1/28 of random phases, for what the descent still has to do while
// nothing moves.
double allowed_field(double strain) {
  return 0.05 + 160 * strain;
}

struct Worst {
  double phase = 0, field = 0, ratio = 0, jumps = 0, vertices = 0;
  void add(const Change& step) {
    phase = std::max(phase, step.phase);
    field = std::max(field, step.field);
    if (step.vertices >= 20)
      ratio = std::max(ratio, step.field / allowed_field(step.strain));  // fewer are no mean
    jumps += step.jumps;
    vertices += step.vertices;
  }
};

Worst over_the_clip(const config::SceneSettings& settings, int stride = 1) {
  History history(settings);
  Worst worst;
  const int last = history.scene.animation.timeline().frame_count;
  Readings before = history.at(1);
  for (int frame = 1 + stride; frame <= last; frame += stride) {
    Readings now = history.at(frame);
    worst.add(change(history.scene.surface(), before, now));
    before = std::move(now);
  }
  return worst;
}

class Flicker : public test::OpenGlTest {};

void expect_steady(const std::string& name, const Worst& worst) {
  std::printf(
      "%s: worst frame: phase %.3f rad (random %.2f), field %.3f (random %.2f), %.2f of what the pose "
      "allows; "
      "%.0f of %.0f phases jumped\n",
      name.c_str(), worst.phase, random_phase, worst.field, random_field, worst.ratio, worst.jumps,
      worst.vertices);
  EXPECT_GT(worst.vertices, 1000) << name;
  EXPECT_LT(worst.phase, random_phase / 5) << name;
  EXPECT_LT(worst.ratio, 1) << name;
  // A dislocation that heals takes a vertex or two through half a turn; of random phases 680 in a thousand
  // jump.
  EXPECT_LE(worst.jumps, 2e-3 * worst.vertices) << name;
}

TEST_F(Flicker, TheSleevesWrinklesTravelWithTheCloth) {
  expect_steady("sleeve", over_the_clip(config::load_scene(test::asset("sleeve.toml"))));
}

TEST_F(Flicker, SoDoThoseOfTheShirtAndTheCurtain) {
  for (const std::string name : {"shirt", "curtain"}) {
    expect_steady(name, over_the_clip(config::load_scene(test::asset(name + ".toml"))));
  }
}

// The measure must be able to fail: what is compared here is the same clip with new phases for every frame.
TEST_F(Flicker, PhasesThatStartAnewWouldNotPass) {
  config::SceneSettings settings = config::load_scene(test::asset("sleeve.toml"));
  settings.model.loop = false;
  settings.relax.mode = config::RelaxMode::descent;
  Worst worst;
  double least = 1e9;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    settings.wrinkles.seed = seed;
    History history(settings);
    settings.wrinkles.seed = seed + 1;
    History other(settings);
    const Change step = change(history.scene.surface(), history.at(30), other.at(31));
    worst.add(step);
    least = std::min(least, step.phase);
  }
  EXPECT_GT(least, 0.8 * random_phase);
  EXPECT_GT(worst.field, 0.8 * random_field);
  EXPECT_GT(worst.ratio, 2);
  EXPECT_GT(worst.jumps, 0.5 * worst.vertices);  // 1 − 1/π of uniform differences: .68
}

// A looping clip is stepped once round before it is shown, so heights and directions go on from its last
// frame to its first. Phases need not: every onset makes a wave anew, and no number of rounds brings the old
// ones back.
TEST_F(Flicker, HeightsAndDirectionsOfALoopClose) {
  for (const std::string name : {"sleeve", "shirt"}) {
    History history(config::load_scene(test::asset(name + ".toml")));
    const Readings first = history.at(1), second = history.at(2);
    const Readings last = history.at(history.scene.animation.timeline().frame_count);
    double seam = 0, step = 0, turned = 0, count = 0;
    for (std::size_t v = 0; v < first.height.size(); ++v) {
      seam += std::pow(first.height[v] - last.height[v], 2);
      step += std::pow(second.height[v] - first.height[v], 2);
      if (first.status[v] != 1 || last.status[v] != 1) continue;
      turned += 1 - std::abs(glm::dot(glm::normalize(first.direction[v]), glm::normalize(last.direction[v])));
      count += 1;
    }
    // The seam is a step between two frames like the next one; ten times it for a clip that moves unevenly.
    EXPECT_LT(std::sqrt(seam), 10 * std::sqrt(step)) << name;
    EXPECT_LT(turned / count, 0.05) << name;  // 18°
  }
}

// The way from the last frame to the first is one share of 1/25 of at most π, .13 rad, and what the descent
// of one frame adds, in other frames .18 RMS at most. Without leading it is 1.7 (sleeve) and 1.4 (shirt),
// near random phases' 1.81.
TEST_F(Flicker, PhasesOfALoopClose) {
  for (const std::string name : {"sleeve", "shirt"}) {
    History history(config::load_scene(test::asset(name + ".toml")));
    Readings first = history.at(1);
    const Readings last = history.at(history.scene.animation.timeline().frame_count);
    for (std::size_t v = 0; v < first.phase.size(); ++v) {
      // A direction may turn over in a whole period: the same wave with the phase's sign turned.
      if (glm::dot(first.direction[v], last.direction[v]) < 0) first.phase[v] = -first.phase[v];
    }
    const Change seam = change(history.scene.surface(), last, first);
    EXPECT_GT(seam.vertices, 20) << name;
    EXPECT_LT(seam.phase, 0.35) << name;
    RecordProperty(name + "_seam_rad", std::to_string(seam.phase));
  }
}

// The second period, which a loop shows, is laid as well as the first: what a vertex remembers of the last
// wave, its direction above all, must not tear the next one. Middle frames, where most is compressed.
// Directions taken over at onset gave the curtain .016 where its first period had .001.
TEST_F(Flicker, TheSecondPeriodIsLaidAsWellAsTheFirst) {
  for (const std::string name : {"curtain", "shirt", "sleeve", "zeppelin"}) {
    config::SceneSettings settings = config::load_scene(test::asset(name + ".toml"));
    settings.wrinkles.irregularity = 0;
    const auto misfit = [&](bool loop) {
      settings.model.loop = loop;
      History history(settings);
      const int middle = history.scene.animation.timeline().frame_count / 2;
      return test::misfit(history.scene.surface(), history.at(middle));
    };
    const double first = misfit(false), second = misfit(true);
    std::printf("%s: misfit %.2g, second period %.2g turns²\n", name.c_str(), first, second);
    // Another start of the same waves: a dislocation more or less. Random phases have 1/12.
    EXPECT_LT(second, 2 * first + 2e-3) << name;
  }
}

}  // namespace
}  // namespace plisse::pipeline
