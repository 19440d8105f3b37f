// The middle of values that have weights.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace plisse {

// Of pairs of a value and its weight, ≥ 0: the value at which the values up to it have half of all weight; 0
// where there are none.
inline double weighted_median(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double all = 0, below = 0, middle = 0;
  for (const auto& [value, weight] : values) all += weight;
  for (const auto& [value, weight] : values) {
    middle = value;
    below += weight;
    if (below >= all / 2) break;
  }
  return middle;
}

}  // namespace plisse
