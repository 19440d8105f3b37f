// The resolution at lines of garment making, and its transition to the fabric's resolution.
//
// D. Zhang et al., SIGGRAPH 2025 ("the paper"), 4.2, with wrinkle transitions after H. Vandeparre et al.,
// "Wrinkling Hierarchy in Constrained Thin Sheets", PRL 106 (2011). SI units throughout; docs/sizing.md has
// the reasons.
#pragma once

#include "sizing/resolution.h"

namespace plisse::sizing {

// Bending stiffness B (N·m) and Young's modulus E (N/m²) in one direction.
struct Stiffness {
  double bending = 0;
  double modulus = 0;
  bool operator==(const Stiffness&) const = default;
};

// r(B/E), metres. Throws as ResolutionLaw::resolution.
double fabric_resolution(const ResolutionLaw& law, const Stiffness& stiffness);

// Shirring (4.2.2): ρⁿ r(B/(E + E_sh)); ρ = contracted over rest length in (0, 1], 1 = none; E_sh ≥ 0 in
// N/m², n ≥ 0. Stitching (4.2.4) and down-filled cells' seams (4.2.5) use it with their own ρ. Throws
// Error(bad_input).
double shirring_resolution(const ResolutionLaw& law, const Stiffness& stiffness, double added_modulus,
                           double ratio, double exponent = 1);

// The rule for r at a fold's ends and sharp bends, from its angle (4.2.3).
enum class FoldRule {
  complement,  // (1 − Δθ/360) r: a fold of 0° changes nothing
  literal,     // (Δθ/360) r, as printed; a fold of 0° would have r = 0
};
// degrees in [0, 360]; neighbourhood is r_ng. Never below `floor`. Throws Error(bad_input).
double folding_resolution(double degrees, double neighbourhood, double floor,
                          FoldRule rule = FoldRule::complement);

// Stitching (4.2.4): l_short/l_long, the contraction of the longer side. Throws Error(bad_input) for lengths
// ≤ 0.
double stitching_ratio(double one_length, double other_length);

// Edge length that resolves a sine of wavelength λ and amplitude A by four edges: √(λ²/16 + A²) (4.1.1).
double wave_resolution(double wavelength, double amplitude);
// Amplitude of a sheet compressed by δ on average: waves that fade as sin(πx/L) along the sheet (the
// paper's 3.1, their peak), or a plain sine.
double fading_wave_amplitude(double wavelength, double compression);  // (√2/π) λ√δ
double plain_wave_amplitude(double wavelength, double compression);   // λ√δ/π

// Kirchhoff–Love thickness of B/E: h = (12 (1 − ν²) B/E)^⅓.
double effective_thickness(const Stiffness& stiffness, double poisson_ratio);
// B of a sheet of thickness h: E h³/(12 (1 − ν²)).
double bending_stiffness(double modulus, double thickness, double poisson_ratio);

// Distance over which λ becomes 2λ (4.2.1), with prefactor 1.
double tension_transition(double wavelength, double tension, double bending);  // λ²√(T/B); T in N/m
double compression_transition(double wavelength, double compression, double thickness);  // λ^1.5 (δ/h²)^¼

// The growth of r with the distance from a source of resolution r₀.
struct Transition {
  enum class Form {
    unit_free,  // r₀ (1 + (x/L_w)^m)
    literal,    // r₀ + x^m in millimetres, m = ln r₀ / ln L_w
  };
  Form form = Form::unit_free;
  double source = 0;    // r₀, m
  double length = 0;    // L_w, m, already shortened by pressure; 0: no transition, r is r₀ only at x = 0
  double exponent = 0;  // m

  // Resolution at distance x ≥ 0, metres; +∞ beyond the range of numbers.
  double at(double distance) const;
  // The distance at which r has grown to `resolution`; 0 where r₀ is not smaller.
  double reach(double resolution) const;
  bool operator==(const Transition&) const = default;
};

struct TransitionCause {
  double compression = 0;  // δ = 1 − ρ
  double tension = 0;      // T, N/m
  double pressure = 0;     // p of down-filling (4.2.5), no unit, ≥ 0
  double prefactor = 1;    // of L_w
  double poisson_ratio = 0.3;
};

// The transition from r₀ with λ = 4 r₀: the longer of the two L_w, with its m (½ tension, ⅔ compression).
// Pressure shortens it: L_w' = r₀ (L_w/r₀)^(2^−p), or m' = 2^p m where literal. The literal form is valid
// only for r₀ > 1 mm and L_w > 1 mm; elsewhere the unit-free one is used. Throws Error(bad_input).
Transition transition(double source, const Stiffness& stiffness, const TransitionCause& cause,
                      Transition::Form form = Transition::Form::unit_free);

}  // namespace plisse::sizing
