// D. Zhang et al., SIGGRAPH 2025, 4.1.1: the law c₁ r⁶ + c₂ r⁴ = B/E and its two constants.

#include "sizing/resolution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace plisse::sizing {
namespace {

void check_interval(const char* name, double low, double high) {
  if (!(low > 0) || !(high > low) || !std::isfinite(high)) {
    throw Error(ExitCode::bad_input,
                fmt::format("fabric range: {} from {:g} to {:g}; the least must be positive and below the "
                            "greatest",
                            name, low, high));
  }
}

}  // namespace

double ResolutionLaw::resolution(double ratio) const {
  if (!(ratio > 0) || !std::isfinite(ratio)) {
    throw Error(
        ExitCode::bad_input,
        fmt::format("y = B/E is {:g} m³; bending stiffness and Young's modulus must be positive and finite",
                    ratio));
  }
  // With s = r² the left side is the cubic c₁ s³ + c₂ s². Where s ≥ −2c₂/c₁ it is at least ½ c₁ s³, so this
  // start lies right of the root; there the cubic is convex and increasing, so Newton's method converges to
  // the root from above.
  double s = std::max(std::cbrt((c2 < 0 ? 2 : 1) * ratio / c1), -2 * c2 / c1);
  for (int i = 0; i < 200; ++i) {
    const double next = s - ((c1 * s + c2) * s * s - ratio) / ((3 * c1 * s + 2 * c2) * s);
    if (!(next < s)) break;  // no further decrease: the limit of rounding
    s = next;
  }
  return std::sqrt(s);
}

ResolutionLaw resolution_law(const FabricRange& range) {
  check_interval("B", range.bending_min, range.bending_max);
  check_interval("E", range.modulus_min, range.modulus_max);
  check_interval("r", range.resolution_min, range.resolution_max);
  const double low2 = std::pow(range.resolution_min, 2), high2 = std::pow(range.resolution_max, 2);
  const double low4 = low2 * low2, high4 = high2 * high2;
  const double determinant = high4 * low4 * (high2 - low2);
  const ResolutionLaw law{
      (low4 * range.ratio_max() - high4 * range.ratio_min()) / determinant,
      (high2 * high4 * range.ratio_min() - low2 * low4 * range.ratio_max()) / determinant};
  // r grows with y down to resolution_min only if the turning point r² = −2c₂/3c₁ lies below it.
  if (!(law.c1 > 0) || !(low2 > -2 * law.c2 / (3 * law.c1))) {
    throw Error(
        ExitCode::bad_input,
        fmt::format(
            "fabric range: r from {:g} to {:g} mm for y = B/E from {:g} to {:g} m³ gives no law whose "
            "r grows with y (c₁ {:g}, c₂ {:g}); y_max/y_min must be well above (r_max/r_min)⁴",
            range.resolution_min * 1e3, range.resolution_max * 1e3, range.ratio_min(), range.ratio_max(),
            law.c1, law.c2));
  }
  return law;
}

}  // namespace plisse::sizing
