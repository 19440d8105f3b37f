// Polygons of model files become triangles that lie inside them, by ear clipping (Meisters 1975, "Polygons
// Have Ears") with exact signs, then edge flips toward larger angles (Lawson 1977).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace plisse {

// n − 2 triangles of a polygon of n ≥ 3 corners, as numbers of corners, in the polygon's own direction. The
// polygon is looked at along its Newell normal; it may be concave, have corners on a straight line, and touch
// itself (as where a bridge leads to a hole). The corners of a quad are joined by the diagonal that gives the
// larger smallest angle, by the first and third where both give the same. A polygon that crosses itself, or
// has no area, still gives n − 2 triangles. Corners must be finite. Deterministic.
std::vector<std::array<std::uint32_t, 3>> cut_polygon(std::span<const glm::dvec3> corners);

// 1 where c lies to the left of the line from a to b, −1 where it lies to the right, 0 on it: exact for
// doubles of ordinary size (Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic").
int side_of_line(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

}  // namespace plisse
