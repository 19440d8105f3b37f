// Boundary rules against numbers computed apart from this code (tables of the project's specification).
#include "sizing/rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"

namespace plisse::sizing {
namespace {

const ResolutionLaw law = resolution_law();
constexpr Stiffness wine{2e-6, 3e5};
constexpr double mm = 1e-3;
constexpr double printed = 0.01 * mm;  // what the constants' last digits leave open

TEST(Rules, Shirring) {
  EXPECT_NEAR(shirring_resolution(law, wine, 0, 0.5), 3.9130 * mm, printed);
  EXPECT_NEAR(shirring_resolution(law, wine, 3e5, 0.5), 3.5016 * mm, printed);
  EXPECT_NEAR(shirring_resolution(law, wine, 2.7e6, 0.5), 2.7197 * mm, printed);
  EXPECT_NEAR(shirring_resolution(law, wine, 3e5, 1), 7.0032 * mm, printed);
  EXPECT_NEAR(shirring_resolution(law, wine, 0, 0.5, 2), 3.9130 * mm / 2, printed);
  for (const double ratio : {0.0, -0.5, 1.01, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(shirring_resolution(law, wine, 0, ratio), Error) << ratio;
  EXPECT_THROW(shirring_resolution(law, wine, -1, 0.5), Error);
}

TEST(Rules, Folding) {
  const double r = fabric_resolution(law, wine);
  for (const FoldRule rule : {FoldRule::complement, FoldRule::literal})
    EXPECT_NEAR(folding_resolution(180, r, 0, rule), 3.913 * mm, printed);  // the one angle where both agree
  EXPECT_DOUBLE_EQ(folding_resolution(0, r, 1 * mm), r);
  EXPECT_DOUBLE_EQ(folding_resolution(0, r, 1 * mm, FoldRule::literal), 1 * mm);  // the floor
  EXPECT_DOUBLE_EQ(folding_resolution(360, r, 1 * mm), 1 * mm);
  EXPECT_THROW(folding_resolution(-1, r, mm), Error);
  EXPECT_THROW(folding_resolution(361, r, mm), Error);
}

TEST(Rules, Stitching) {
  EXPECT_DOUBLE_EQ(stitching_ratio(0.4, 0.5), 0.8);
  EXPECT_DOUBLE_EQ(stitching_ratio(0.5, 0.4), 0.8);
  EXPECT_NEAR(shirring_resolution(law, wine, 0, stitching_ratio(0.4, 0.5)), 6.261 * mm, printed);
  EXPECT_THROW(stitching_ratio(0, 1), Error);
}

TEST(Rules, TransitionsScaleAsTheTheoriesSay) {
  const double tension = tension_transition(0.02, 3, 2e-6);
  EXPECT_DOUBLE_EQ(tension_transition(0.04, 3, 2e-6), 4 * tension);
  EXPECT_DOUBLE_EQ(tension_transition(0.02, 16 * 3, 2e-6), 4 * tension);
  EXPECT_DOUBLE_EQ(tension_transition(0.02, 3, 16 * 2e-6), tension / 4);
  const double compression = compression_transition(0.02, 0.05, 3e-4);
  EXPECT_NEAR(compression_transition(0.04, 0.05, 3e-4) / compression, 2.828, 5e-4);
  EXPECT_NEAR(compression_transition(0.02, 16 * 0.05, 3e-4) / compression, 2, 1e-12);
  EXPECT_NEAR(compression_transition(0.02, 0.05, 4 * 3e-4) / compression, 0.5, 1e-12);
}

TEST(Rules, EdgesThatResolveAWave) {
  EXPECT_NEAR(wave_resolution(1, fading_wave_amplitude(1, 0.1)), 0.2877, 5e-5);
  EXPECT_NEAR(wave_resolution(1, plain_wave_amplitude(1, 0.1)), 0.2695, 5e-5);
  EXPECT_DOUBLE_EQ(wave_resolution(1, 0), 0.25);
}

TEST(Rules, PlainWaveHasTheCompressionItIsNamedFor) {
  // The excess length of A sin(2πx/λ) is (πA/λ)² to second order; at small A the integral says the same.
  const double delta = 1e-4, amplitude = plain_wave_amplitude(1, delta);
  double length = 0;
  constexpr int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const double slope = 2 * M_PI * amplitude * std::cos(2 * M_PI * (i + 0.5) / steps);
    length += std::sqrt(1 + slope * slope) / steps;
  }
  EXPECT_NEAR(length - 1, delta, 1e-3 * delta);  // next order: ¾ δ
}

TEST(Rules, ThicknessAndBendingAreInverse) {
  EXPECT_NEAR(effective_thickness({bending_stiffness(3e5, 4e-4, 0.3), 3e5}, 0.3), 4e-4, 1e-16);
  // Fig. 16's sheet: h 0.1 mm and ν 0.5 give y, and y gives 4.166 mm, not the 3.8 mm that the caption has.
  EXPECT_NEAR(law.resolution(bending_stiffness(1, 1e-4, 0.5)), 4.166 * mm, printed);
}

// r 5 mm, L_w 26.7 mm: the prefactor that makes it so.
TransitionCause curtain(double pressure) {
  TransitionCause cause;
  cause.tension = 1;
  cause.pressure = pressure;
  cause.prefactor = 26.7 * mm / tension_transition(20 * mm, 1, wine.bending);
  return cause;
}

TEST(Rules, LiteralPropagation) {
  const Transition t = transition(5 * mm, wine, curtain(0), Transition::Form::literal);
  EXPECT_NEAR(t.exponent, 0.490, 5e-4);
  EXPECT_DOUBLE_EQ(t.at(0), 5 * mm);
  EXPECT_NEAR(t.at(26.7 * mm), 10 * mm, 1e-12);
  EXPECT_NEAR(t.at(10 * mm), (5 + std::pow(10, 0.48997)) * mm, 1e-6);
}

TEST(Rules, UnitFreePropagation) {
  const Transition t = transition(5 * mm, wine, curtain(0));
  EXPECT_DOUBLE_EQ(t.exponent, 0.5);
  EXPECT_DOUBLE_EQ(t.at(0), 5 * mm);
  EXPECT_NEAR(t.at(26.7 * mm), 10 * mm, 1e-12);
  EXPECT_NEAR(t.at(4 * 26.7 * mm), 15 * mm, 1e-12);  // √4 L_w
  TransitionCause squeezed;
  squeezed.compression = 0.2;
  const Transition compression = transition(5 * mm, wine, squeezed);
  EXPECT_DOUBLE_EQ(compression.exponent, 2.0 / 3);
  EXPECT_NEAR(compression.at(8 * compression.length), 25 * mm, 1e-12);  // 8^⅔ = 4
}

TEST(Rules, TheLongerTransitionWins) {
  TransitionCause both;
  both.compression = 0.2;
  both.tension = 1e-9;
  EXPECT_DOUBLE_EQ(transition(5 * mm, wine, both).exponent, 2.0 / 3);
  both.tension = 1e3;
  EXPECT_DOUBLE_EQ(transition(5 * mm, wine, both).exponent, 0.5);
}

TEST(Rules, DownFillingShortensTheTransition) {
  EXPECT_NEAR(transition(5 * mm, wine, curtain(1)).length, 11.55 * mm, 0.005 * mm);
  const Transition literal = transition(5 * mm, wine, curtain(1), Transition::Form::literal);
  EXPECT_NEAR(literal.length, 5.17 * mm, 0.005 * mm);
  EXPECT_NEAR(literal.at(literal.length), 10 * mm, 1e-12);  // still where r doubles
  EXPECT_NEAR(literal.exponent, 2 * 0.48997, 1e-4);
}

TEST(Rules, HardNumbersAreErrorsOrClamps) {
  // Millimetre and below: the logarithms of the literal form lose their sense, the unit-free form takes over.
  for (const double r : {1 * mm, 0.5 * mm}) {
    const Transition t = transition(r, wine, curtain(0), Transition::Form::literal);
    EXPECT_EQ(t.form, Transition::Form::unit_free);
    EXPECT_DOUBLE_EQ(t.at(t.length), 2 * r);
  }
  TransitionCause brief = curtain(0);
  brief.prefactor *= 0.5 / 26.7;  // L_w 0.5 mm
  EXPECT_EQ(transition(5 * mm, wine, brief, Transition::Form::literal).form, Transition::Form::unit_free);
  for (const auto form : {Transition::Form::unit_free, Transition::Form::literal}) {
    for (const double pressure : {1e2, 1e6, 1e300}) {
      const Transition t = transition(5 * mm, wine, curtain(pressure), form);
      for (const double x : {0.0, 1e-9, 1e-3, 1.0, 1e6}) {
        EXPECT_FALSE(std::isnan(t.at(x))) << pressure << " " << x;
        EXPECT_GE(t.at(x), 5 * mm);
      }
    }
  }
  // Nothing pulls or squeezes: only the line itself is fine.
  const Transition none = transition(5 * mm, wine, {});
  EXPECT_DOUBLE_EQ(none.at(0), 5 * mm);
  EXPECT_TRUE(std::isinf(none.at(1e-9)));
  EXPECT_THROW(transition(0, wine, curtain(0)), Error);
  EXPECT_THROW(transition(5 * mm, wine, curtain(-1)), Error);
  EXPECT_THROW(transition(5 * mm, wine, curtain(std::numeric_limits<double>::infinity())), Error);
}

}  // namespace
}  // namespace plisse::sizing
