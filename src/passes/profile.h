// The shape of a wave across its crest: f over one period and its derivative, as tables (Loviscach
// 2006, 6.3). f is even in the phase, because the sign of a direction is not determined, and runs between −1
// and 1.
#pragma once

#include <string>
#include <vector>

namespace plisse::passes {

struct Profile {
  static constexpr int size = 1024;  // linear interpolation of a cosine is then good to 5e-6
  std::vector<double> f;             // f(2πi/size)
  std::vector<double> derivative;    // df/dphase there
  double slope_variance = 1;         // mean of f'² over the sinusoid's ½
  // A wave is coarse · f(τ) + fine · f(fine_waves τ), times its height.
  int fine_waves = 0;  // 0: none
  double coarse = 1, fine = 0;
};

// The profile with finer waves added: `waves` of them on each wave, `share` times as steep. Both are scaled
// so that the cloth's length is unchanged to second order in the slopes (docs/passes.md, "Finer waves").
Profile with_finer_waves(Profile profile, int waves, double share);

// A profile of mesh/wave_profiles.h by its name, or a text file of numbers: one period of f at even
// distances, beginning at the crest. Throws Error(bad_input) with file and line: not a number, fewer than 4
// or more than 65536, not even, constant. A table is scaled to −1…1.
Profile make_profile(const std::string& name);

}  // namespace plisse::passes
