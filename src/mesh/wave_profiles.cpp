#include "mesh/wave_profiles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plisse {
namespace {

constexpr double pi = std::numbers::pi;

// 0 at the crest and at the creases, where the two flanks meet.
double side(double phase) {
  return phase == 0 || std::abs(phase) >= pi ? 0.0 : std::copysign(1.0, phase);
}

}  // namespace

const std::vector<WaveProfile>& wave_profiles() {
  static const std::vector<WaveProfile> all = {
      {"sinusoid", [](double p) { return std::cos(p); }, [](double p) { return -std::sin(p); }},
      // Straight flanks.
      {"accordion", [](double p) { return 1 - 2 * std::abs(p) / pi; },
       [](double p) { return -2 / pi * side(p); }},
      // Round pleats that meet in a crease.
      {"pencil", [](double p) { return 2 * std::cos(p / 2) - 1; },
       [](double p) { return std::abs(p) >= pi ? 0.0 : -std::sin(p / 2); }},
  };
  return all;
}

const WaveProfile* find_wave_profile(std::string_view name) {
  const auto found = std::find_if(wave_profiles().begin(), wave_profiles().end(),
                                  [&](const WaveProfile& profile) { return profile.name == name; });
  return found == wave_profiles().end() ? nullptr : &*found;
}

std::vector<std::string> wave_profile_names() {
  std::vector<std::string> names;
  for (const WaveProfile& profile : wave_profiles()) names.emplace_back(profile.name);
  return names;
}

}  // namespace plisse
