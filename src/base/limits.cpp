#include "base/limits.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace plisse {

std::uint64_t Limits::with_factor(int limit) const {
  const double value = std::floor(limit * factor);
  // A double beyond 2^63 cannot be converted to an integer; no file is that large.
  return value < 9e18 ? static_cast<std::uint64_t>(value) : std::numeric_limits<std::uint64_t>::max();
}

std::string over_limit(const Limits& limits, int Limits::*limit, std::string_view key, std::uint64_t found,
                       std::string_view what) {
  const std::uint64_t allowed = limits.with_factor(limits.*limit);
  if (found <= allowed) return {};
  const double enough = std::ceil(static_cast<double>(found) / static_cast<double>(limits.*limit));
  return fmt::format(
      "{} {} are more than the limit of {}; if the file is meant to be so large, raise '{}' under [limits] "
      "of a scene, "
      "or all limits with --limits {:g}",
      found, what, allowed, key, enough);
}

}  // namespace plisse
