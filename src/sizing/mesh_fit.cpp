#include "sizing/mesh_fit.h"

#include <algorithm>
#include <limits>
#include <map>

#include "sizing/sample.h"

namespace plisse::sizing {

MeshFit fit_of(const std::vector<glm::dvec3>& positions,
               std::span<const std::array<std::uint32_t, 3>> triangles, double resolution) {
  MeshFit fit;
  fit.resolution = resolution;
  fit.coarse_low = glm::dvec3(std::numeric_limits<double>::max());
  fit.coarse_high = -fit.coarse_low;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  double area = 0, finer = 0, coarser = 0;
  for (const auto& [a, b, c] : triangles) {
    const glm::dvec3 &p = positions[a], &q = positions[b], &s = positions[c];
    const double own = glm::length(glm::cross(q - p, s - p)) / 2;
    if (!(own > 0)) continue;
    for (const auto& edge : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)}) ++uses[edge];
    const double mean = (glm::distance(p, q) + glm::distance(q, s) + glm::distance(s, p)) / 3;
    area += own;
    if (mean < resolution / 2) finer += own;
    if (mean > 2 * resolution) {
      coarser += own;
      fit.coarse_low = glm::min(fit.coarse_low, glm::min(p, glm::min(q, s)));
      fit.coarse_high = glm::max(fit.coarse_high, glm::max(p, glm::max(q, s)));
    }
  }
  if (coarser == 0) fit.coarse_low = fit.coarse_high = glm::dvec3(0);
  std::vector<double> lengths;
  double open = 0;
  for (const auto& [edge, count] : uses) {
    lengths.push_back(glm::distance(positions[edge.first], positions[edge.second]));
    if (count == 1) open += lengths.back();
  }
  if (lengths.empty()) return fit;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  fit.median_edge = *middle;
  fit.finer = finer / area;
  fit.coarser = coarser / area;
  fit.vertices_needed = vertex_density * area / (resolution * resolution) + open / resolution / 2;
  return fit;
}

}  // namespace plisse::sizing
