// The shapes of waves: what passes and closed forms ask of each.
#include "mesh/wave_profiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plisse {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Profiles, EachIsEvenFromCrestToTroughWithItsDerivative) {
  ASSERT_GE(wave_profiles().size(), 3U);
  for (const WaveProfile& profile : wave_profiles()) {
    SCOPED_TRACE(profile.name);
    EXPECT_EQ(find_wave_profile(profile.name), &profile) << "a name twice";
    EXPECT_NEAR(profile.f(0), 1, 1e-15);
    EXPECT_NEAR(profile.f(pi), -1, 1e-15);
    EXPECT_NEAR(profile.f(-pi), -1, 1e-15);
    EXPECT_NEAR(profile.derivative(0), 0, 1e-15);
    for (double phase = 0.1; phase < 3.1; phase += 0.1) {
      EXPECT_NEAR(profile.f(phase), profile.f(-phase), 1e-15);
      EXPECT_NEAR(profile.derivative(phase), -profile.derivative(-phase), 1e-15);
      EXPECT_LE(profile.derivative(phase), 0) << "it falls from crest to trough";
      // Third derivatives are 1 at most: 1e-8/6, and rounding of 1e-16/1e-4.
      const double step = 1e-4;
      EXPECT_NEAR((profile.f(phase + step) - profile.f(phase - step)) / (2 * step), profile.derivative(phase),
                  1e-8);
    }
  }
}

TEST(Profiles, UnknownNamesHaveNone) {
  EXPECT_EQ(find_wave_profile("acordion"), nullptr);
  EXPECT_EQ(find_wave_profile(""), nullptr);
}

}  // namespace
}  // namespace plisse
