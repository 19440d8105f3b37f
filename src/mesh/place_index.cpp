#include "mesh/place_index.h"

#include <algorithm>

namespace plisse {

PlaceIndex::PlaceIndex(const std::vector<glm::dvec3>& points) {
  along_x_.reserve(points.size());
  for (const glm::dvec3& x : points) along_x_.emplace_back(x, static_cast<std::uint32_t>(along_x_.size()));
  std::stable_sort(along_x_.begin(), along_x_.end(),
                   [](const auto& a, const auto& b) { return a.first.x < b.first.x; });
}

std::optional<std::uint32_t> PlaceIndex::nearest(const glm::dvec3& x, double reach) const {
  std::optional<std::uint32_t> found;
  auto at = std::lower_bound(along_x_.begin(), along_x_.end(), x.x - reach,
                             [](const auto& entry, double low) { return entry.first.x < low; });
  for (; at != along_x_.end() && at->first.x <= x.x + reach; ++at) {
    const double distance = glm::distance(at->first, x);
    if (distance > reach || (found && distance == reach && at->second > *found)) continue;
    reach = distance;
    found = at->second;
  }
  return found;
}

}  // namespace plisse
