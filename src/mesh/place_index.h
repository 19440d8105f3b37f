// Finds points by their position: files of other programs may have the same points in another order.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace plisse {

class PlaceIndex {
 public:
  explicit PlaceIndex(const std::vector<glm::dvec3>& points);
  // The nearest point within `reach`, if there is one; of equally near ones the first.
  std::optional<std::uint32_t> nearest(const glm::dvec3& x, double reach) const;

 private:
  std::vector<std::pair<glm::dvec3, std::uint32_t>> along_x_;
};

}  // namespace plisse
