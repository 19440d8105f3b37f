// Whole-number periods (Chen et al. 2021, section E.4): the phase of a solution made single-valued on the
// surface, up to multiples of 2π.
#pragma once

#include <array>
#include <vector>

#include "wrinkle/solve.h"

namespace plisse::wrinkle {

// The state with every period a multiple of 2π that costs the least energy to second order: integer least
// squares in the metric of the Hessian, reduced to the periods, by Babai's nearest plane and then single
// steps; the other unknowns change to first order. A good start for a solve with fixed periods.
Waves with_whole_periods(const Problem& problem, const Waves& waves);

// √(Σ∫a²|dφ − ω|² / Σ∫a²|ω|²) of two states' one-forms, amplitudes of the first; 0 where nothing wrinkles.
double phase_residual(const Problem& problem, const Waves& real, const Waves& whole);

// φ of every corner of every face, radians; those of one vertex differ by multiples of 2π where its amplitude
// is not 0. 0 on faces that are not live. Needs whole periods.
std::vector<std::array<double, 3>> corner_phases(const Problem& problem, const Waves& whole);

}  // namespace plisse::wrinkle
