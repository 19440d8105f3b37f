// The shapes that a wave can have across its crest, by the names that scenes and the command line have for
// them (Loviscach 2006, 6.3). The one list of them: keys, help, messages and tables go by it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plisse {

// f and its derivative by the phase, for phases from −π to π. f is even, because the sign of a direction is
// not determined, 1 at the crest (0), and −1 at ±π. Where two flanks meet in a crease the derivative is 0.
struct WaveProfile {
  std::string_view name;
  double (*f)(double phase) = nullptr;
  double (*derivative)(double phase) = nullptr;
};

// In the order in which messages and docs name them; the first is the one that scenes have by default.
const std::vector<WaveProfile>& wave_profiles();
const WaveProfile* find_wave_profile(std::string_view name);  // nothing: there is none of this name
std::vector<std::string> wave_profile_names();

}  // namespace plisse
