// D. Zhang et al., SIGGRAPH 2025, 4.2: source resolutions and their transitions.

#include "sizing/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace plisse::sizing {
namespace {

constexpr double millimetre = 1e-3;

// Throws unless the value is in low … high; NaN is not.
void check(const char* what, double value, bool holds, const char* allowed) {
  if (holds && std::isfinite(value)) return;
  throw Error(ExitCode::bad_input, fmt::format("{} is {:g}; allowed: {}", what, value, allowed));
}

}  // namespace

double fabric_resolution(const ResolutionLaw& law, const Stiffness& stiffness) {
  check("bending stiffness B", stiffness.bending, stiffness.bending > 0, "above 0 N·m");
  check("Young's modulus E", stiffness.modulus, stiffness.modulus > 0, "above 0 N/m²");
  return law.resolution(stiffness.bending / stiffness.modulus);
}

double shirring_resolution(const ResolutionLaw& law, const Stiffness& stiffness, double added_modulus,
                           double ratio, double exponent) {
  check("shirring stiffness E_sh", added_modulus, added_modulus >= 0, "0 N/m² or more");
  check("contraction ρ", ratio, ratio > 0 && ratio <= 1, "above 0, up to 1 (no contraction)");
  check("shirring exponent n", exponent, exponent >= 0, "0 or more");
  return std::pow(ratio, exponent) *
         fabric_resolution(law, {stiffness.bending, stiffness.modulus + added_modulus});
}

double folding_resolution(double degrees, double neighbourhood, double floor, FoldRule rule) {
  check("fold angle Δθ", degrees, degrees >= 0 && degrees <= 360, "0 to 360 degrees");
  const double share = rule == FoldRule::literal ? degrees / 360 : 1 - degrees / 360;
  return std::max(share * neighbourhood, floor);
}

double stitching_ratio(double one_length, double other_length) {
  check("length of a stitched line", one_length, one_length > 0, "above 0 m");
  check("length of a stitched line", other_length, other_length > 0, "above 0 m");
  return std::min(one_length, other_length) / std::max(one_length, other_length);
}

double wave_resolution(double wavelength, double amplitude) {
  return std::hypot(wavelength / 4, amplitude);
}
double fading_wave_amplitude(double wavelength, double compression) {
  return std::numbers::sqrt2 / std::numbers::pi * wavelength * std::sqrt(compression);
}
double plain_wave_amplitude(double wavelength, double compression) {
  return wavelength * std::sqrt(compression) / std::numbers::pi;
}

double effective_thickness(const Stiffness& stiffness, double poisson_ratio) {
  return std::cbrt(12 * (1 - poisson_ratio * poisson_ratio) * stiffness.bending / stiffness.modulus);
}
double bending_stiffness(double modulus, double thickness, double poisson_ratio) {
  return modulus * std::pow(thickness, 3) / (12 * (1 - poisson_ratio * poisson_ratio));
}

double tension_transition(double wavelength, double tension, double bending) {
  return wavelength * wavelength * std::sqrt(tension / bending);
}
double compression_transition(double wavelength, double compression, double thickness) {
  return std::pow(wavelength, 1.5) * std::pow(compression / (thickness * thickness), 0.25);
}

double Transition::at(double distance) const {
  if (distance <= 0) return source;
  if (length <= 0) return std::numeric_limits<double>::infinity();
  if (form == Form::literal) return source + std::pow(distance / millimetre, exponent) * millimetre;
  return source * (1 + std::pow(distance / length, exponent));
}

double Transition::reach(double resolution) const {
  if (resolution <= source || length <= 0) return 0;
  if (form == Form::literal) return std::pow((resolution - source) / millimetre, 1 / exponent) * millimetre;
  return length * std::pow(resolution / source - 1, 1 / exponent);
}

Transition transition(double source, const Stiffness& stiffness, const TransitionCause& cause,
                      Transition::Form form) {
  check("source resolution", source, source > 0, "above 0 m");
  check("compression δ", cause.compression, cause.compression >= 0 && cause.compression < 1,
        "0 up to, not with, 1");
  check("tension T", cause.tension, cause.tension >= 0, "0 N/m or more");
  check("down-filling pressure p", cause.pressure, cause.pressure >= 0, "0 or more");
  check("prefactor of L_w", cause.prefactor, cause.prefactor > 0, "above 0");
  const double wavelength = 4 * source;  // the λ that r resolves, at δ = 0 (4.1.1)
  const double stretched = tension_transition(wavelength, cause.tension, stiffness.bending);
  const double squeezed = compression_transition(wavelength, cause.compression,
                                                 effective_thickness(stiffness, cause.poisson_ratio));
  const double length = cause.prefactor * std::max(stretched, squeezed);
  const double slower = std::exp2(-cause.pressure);

  Transition result{Transition::Form::unit_free, source, length, stretched > squeezed ? 1.0 / 2 : 2.0 / 3};
  if (length <= 0) return result;
  if (form == Transition::Form::literal && source > millimetre && length > millimetre) {
    result.form = form;
    result.exponent = std::log(source / millimetre) / std::log(length / millimetre) / slower;
    result.length = std::pow(length / millimetre, slower) * millimetre;
  } else {
    result.length = source * std::pow(length / source, slower);
  }
  return result;
}

}  // namespace plisse::sizing
