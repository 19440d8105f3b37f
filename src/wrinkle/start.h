// The start of the solve (Chen et al. 2021, section E.2).
#pragma once

#include <vector>

#include "wrinkle/local_waves.h"
#include "wrinkle/problem.h"

namespace plisse::wrinkle {

// The faces' own waves (local_waves.h) with `frequency` times their frequency, signs made consistent along a
// maximum spanning tree; the nearest closed one-form (least squares, weighted by area and compression);
// amplitudes for that form, averaged over the faces around a vertex, scaled for each patch to the least
// energy. A compressed patch for which the result is flat takes the best of other frequencies, from a quarter
// to four times.
Waves initial_waves(const Problem& problem, double frequency = 1);

// A state of `from` in `to`, a problem on the same surface with other pinned vertices: existing waves are
// kept as far as they are closed in `to`; free vertices without amplitude get the amplitude of waves that
// continue into them, with the best of a few scales.
Waves continued_waves(const Problem& to, const Problem& from, const Waves& waves);

// Gradients (radians per metre, one a face) with those of live faces that are not `known` replaced by the
// faces' own waves, in the sign that agrees with the known ones.
std::vector<Eigen::Vector2d> completed(const Problem& problem, const std::vector<bool>& known,
                                       const std::vector<Eigen::Vector2d>& gradients);

// The given waves with consistent signs and the nearest closed one-form; amplitudes √(2s₀)/|ω| of the faces'
// own waves, unscaled. One entry of `local` a face.
Waves waves_of(const Problem& problem, std::vector<LocalWaves> local);

}  // namespace plisse::wrinkle
