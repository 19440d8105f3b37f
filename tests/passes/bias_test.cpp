// Painted wrinkles in crush, M(E − q⊗q) (Loviscach 2006, 7), on the GPU against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "support/opengl.h"
#include "support/sheets.h"

namespace plisse::passes {
namespace {

using std::numbers::pi;
using test::Passes;
using test::Readings;
using test::Sheet;

class Bias : public test::OpenGlTest {};

constexpr double W = 0.3;
// As in crush_test: single precision over edges of .1 of the model.
constexpr double tolerance = 1e-5;

Sheet painted(const glm::dvec3& p) {
  Sheet sheet = test::grid(7, 7, 0.15, 0.3, 3, W);
  sheet.waves.bias.assign(sheet.size(), p);
  return sheet;
}

glm::dvec3 direction(double angle) {
  return {std::cos(angle), std::sin(angle), 0};
}

double wrapped(double radians) {
  return test::wrap_radians(radians);
}

Readings crushed(const Sheet& sheet, const glm::dmat4& pose = glm::dmat4(1)) {
  Passes passes(sheet);
  passes.pose({pose});
  passes.crush(0.005);
  return passes.read();
}

TEST_F(Bias, ShortensTheRestPose) {
  for (const double square : {0.02, 0.1, 0.5, 0.75}) {
    for (const double angle : {0.0, 0.7, 2.0}) {
      const Sheet sheet = painted(std::sqrt(square) * direction(angle));
      const Readings now = crushed(sheet);
      const double r = 1 - square;
      for (std::size_t v = 0; v < sheet.size(); ++v) {
        EXPECT_NEAR(now.compression[v], square, tolerance);
        // The slope of √(1−r²) in r is at most r/√(1−r²): 5 at r = .98.
        EXPECT_NEAR(now.height[v] / W, 0.25 * std::sqrt(1 - r * r), 5 * tolerance);
        EXPECT_NEAR(std::abs(glm::dot(now.wave[v], direction(angle))) * W, 1 / r, 1e-4);
        EXPECT_NEAR(glm::length(now.wave[v]) * W, 1 / r, 1e-4);
      }
    }
  }
  // The number of the paper's section 7: |q|² = ½ → r = ½, h = .2165 W.
  EXPECT_NEAR(crushed(painted({std::sqrt(0.5), 0, 0})).height[24] / W, 0.2165, 5e-5);
}

TEST_F(Bias, BothSignsAreTheSameWrinkles) {
  const Readings one = crushed(painted({0.4, 0.3, 0})), other = crushed(painted({-0.4, -0.3, 0}));
  EXPECT_EQ(one.height, other.height);
  EXPECT_EQ(one.compression, other.compression);
  EXPECT_EQ(one.wave, other.wave);
}

TEST_F(Bias, NothingPaintedChangesNoBit) {
  Sheet bare = test::grid(7, 7, 0.15, 0.3, 3, W), zero = painted(glm::dvec3(0));
  const glm::dmat4 pose = glm::scale(glm::rotate(glm::dmat4(1), 0.7, {1, 2, 3}), {0.8, 1.1, 1});
  const Readings expected = crushed(bare, pose), now = crushed(zero, pose);
  EXPECT_EQ(now.height, expected.height);
  EXPECT_EQ(now.wave, expected.wave);
  EXPECT_EQ(now.compression, expected.compression);
  EXPECT_EQ(now.direction, expected.direction);
}

// Squeezed along the painted direction the two shortenings multiply; pulled flat, the painted wrinkle goes.
TEST_F(Bias, DeepensUnderCompressionAndPullsFlat) {
  const double square = 0.2;
  const Sheet sheet = painted({std::sqrt(square), 0, 0});
  double last = 1;
  for (const double squeeze : {0.6, 0.8, 1.0, 1.1, 1.25, 1.4}) {
    const Readings now = crushed(sheet, glm::scale(glm::dmat4(1), {squeeze, 1, 1}));
    const double r = std::min(squeeze * (1 - square), 1.0);  // beyond: the other direction is the shorter one
    for (std::size_t v = 0; v < sheet.size(); ++v)
      EXPECT_NEAR(now.compression[v], 1 - r, 2 * tolerance) << squeeze;
    EXPECT_LE(now.height[24], last);
    last = now.height[24];
  }
  EXPECT_EQ(last, 0.0);
}

// Painted along x and squeezed along y: whichever is stronger gives the direction.
TEST_F(Bias, ContestsWithTheAnimation) {
  const Sheet sheet = painted({std::sqrt(0.3), 0, 0});
  for (const double squeeze : {0.9, 0.5}) {
    const Readings now = crushed(sheet, glm::scale(glm::dmat4(1), {1, squeeze, 1}));
    const glm::dvec3 along = squeeze > 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    for (std::size_t v = 0; v < sheet.size(); ++v) {
      EXPECT_NEAR(now.compression[v], squeeze > 0.7 ? 0.3 : 0.5, tolerance);
      EXPECT_NEAR(std::abs(glm::dot(glm::normalize(now.wave[v]), along)), 1, 1e-5);
    }
  }
}

TEST_F(Bias, ALengthOfOneIsCutAndStaysFinite) {
  for (const double length : {0.99, 1.0, 7.0, 1e30}) {
    const Sheet sheet = painted({0, length, 0});
    const Readings now = crushed(sheet);
    for (std::size_t v = 0; v < sheet.size(); ++v) {
      EXPECT_NEAR(now.compression[v], 0.99 * 0.99, tolerance);
      EXPECT_TRUE(std::isfinite(glm::length(now.wave[v])));
    }
  }
}

// A solved field as bias: pulled flat its waves are gone; let go, each begins again with its own phase,
// however often, and so has the same height everywhere. A wave that the animation makes across it is not the
// field's and takes its phase from its neighbours or from nothing, as any.
TEST_F(Bias, SolvedWavesComeBackAsTheyWere) {
  Sheet sheet = painted({std::sqrt(0.2), 0, 0});
  sheet.waves.start_direction.assign(sheet.size(), {1, 0, 0});
  for (std::size_t v = 0; v < sheet.size(); ++v)
    sheet.waves.start_phase.push_back(wrapped(2 * pi / (0.8 * W) * sheet.surface.rest[v].x + 0.4));
  Passes passes(sheet);
  const auto at = [&](const glm::dvec3& scale) {
    passes.pose({glm::scale(glm::dmat4(1), scale)});
    passes.crush(0.025);
    passes.relax({});
    return passes.read();
  };
  const Readings first = at({1, 1, 1});
  for (int round = 0; round < 3; ++round) {
    const Readings flat = at({1.4, 1, 1});
    for (std::size_t v = 0; v < sheet.size(); ++v) EXPECT_EQ(flat.status[v], 0) << v;
    if (round == 2) at({1.4, 0.7, 1});  // waves along y, which turn back without being gone
    const Readings back = at({1, 1, 1});
    for (std::size_t v = 0; v < sheet.size(); ++v) {
      EXPECT_EQ(back.status[v], 1) << v;
      EXPECT_EQ(back.height[v], first.height[v]) << v;
      // −k counts the phase the other way.
      const double sign = glm::dot(back.direction[v], first.direction[v]) < 0 ? -1 : 1;
      EXPECT_NEAR(std::abs(glm::dot(back.direction[v], first.direction[v])), 1, 1e-5) << v;
      EXPECT_NEAR(test::wrap_radians(sign * back.phase[v] - sheet.waves.start_phase[v]), 0, 1e-5)
          << v;  // single precision, of 26 rad
    }
  }
  at({1.4, 1, 1});
  const Readings across = at({1.4, 0.7, 1});
  double as_solved = 0;
  for (std::size_t v = 0; v < sheet.size(); ++v) {
    EXPECT_EQ(across.status[v], 1) << v;
    as_solved += std::abs(std::abs(across.phase[v]) - std::abs(sheet.waves.start_phase[v])) < 1e-6 ? 1 : 0;
  }
  EXPECT_EQ(as_solved, 0);
}

}  // namespace
}  // namespace plisse::passes
