// Where the solve starts (Chen et al. 2021, section E.2).
#pragma once

#include <vector>

#include "wrinkle/local_waves.h"
#include "wrinkle/problem.h"

namespace plisse::wrinkle {

// The faces' own waves (local_waves.h), `frequency` times as dense, signs agreeing along a maximum spanning
// tree; the nearest closed one-form (least squares, weighted by area and compression); amplitudes that suit
// that form, means over the faces round a vertex, scaled patch by patch to the least energy. A patch that is
// compressed and yet flat so takes the best of other frequencies, from a quarter to four times.
Waves initial_waves(const Problem& problem, double frequency = 1);

// A state of `from` in `to`, a problem on the same surface that pins other vertices: waves that are there
// stay as they are, as far as `to` has them close; vertices without amplitude that are free get the amplitude
// that suits waves which go on into them, scaled to the least energy of a few scales.
Waves continued_waves(const Problem& to, const Problem& from, const Waves& waves);

// Such waves as they are: signs combed, the nearest closed one-form, √(2s₀)/|ω| of the faces' own waves for
// amplitudes, unscaled. One entry of `local` a face.
Waves waves_of(const Problem& problem, std::vector<LocalWaves> local);

}  // namespace plisse::wrinkle
