// Comparison of a given mesh with the resolution that its fabric needs.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace plisse::sizing {

struct MeshFit {
  double resolution = 0;          // r of the fabric, m; the finer of weft and warp
  double median_edge = 0;         // m
  double finer = 0, coarser = 0;  // shares of the area whose triangles have mean edges below r/2, above 2r
  double vertices_needed = 0;     // (2/√3) ∫dA/r² + ½ ∮ds/r, over open edges
  // A box around the triangles that are coarser than that.
  glm::dvec3 coarse_low{0}, coarse_high{0};
};

// positions in m, three indices a triangle; triangles without area are ignored.
MeshFit fit_of(const std::vector<glm::dvec3>& positions,
               std::span<const std::array<std::uint32_t, 3>> triangles, double resolution);

}  // namespace plisse::sizing
