// Waves by a local law of the distance from a clamped edge, for comparison with the solve
// (Chen et al. 2021, figs. 8 and 10).
//
// H. Vandeparre et al., Wrinkling hierarchy in constrained thin sheets, Phys. Rev. Lett. 106, 2011; taken as
// a wavelength for sheets without a substrate by E. Zuenko, M. Harders, 2019.
#pragma once

#include "wrinkle/problem.h"

namespace plisse::wrinkle {

// Metres: the wavelength at this distance (metres) from a clamped edge. Under tension λ = 2√π (B/T)^¼ x^½, T
// = ½Yhλ₁ (Cerda and Mahadevan's number before it); where only the waves' own slope causes tension, T =
// ½Yh(a/x)² with a = √(2s₀) λ/2π, which is λ = (16π⁴/3(1−ν²))^⅙ (h²/s₀)^⅙ x^⅔. The shorter of both; infinite
// without tension and compression.
double vandeparre_wavelength(const shell::Material& material, double distance, double tension,
                             double compression);

// These waves on every live face, with consistent signs, ω the nearest closed form, amplitudes √(2s₀)/|ω|.
// Distances are shortest paths along edges, at rest. Throws Error(bad_input) where no vertex is clamped.
Waves vandeparre_waves(const Problem& problem, const std::vector<bool>& clamped);

}  // namespace plisse::wrinkle
