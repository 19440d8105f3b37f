// Small functions that several passes of the reference use, as docs/passes.md defines them.
#pragma once

#include <algorithm>
#include <cmath>

namespace plisse::reference {

inline constexpr double pi = 3.14159265358979323846;

// 0 up to `low`, 1 from `high`, 3s² − 2s³ between.
inline double smoothstep(double low, double high, double x) {
  const double s = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// To (−½, ½] turns.
inline double wrap_turns(double turns) {
  return turns - std::ceil(turns - 0.5);
}

// To (−π, π] radians.
inline double wrap_radians(double radians) {
  return 2 * pi * wrap_turns(radians / (2 * pi));
}

}  // namespace plisse::reference
