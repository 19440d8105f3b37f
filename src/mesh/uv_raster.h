// Which point of the surface each texel of a texture belongs to.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "mesh/surface.h"

namespace plisse {

constexpr int most_tiles = 64;  // a side: a texture of 16384 has 256 texels for each

// size² entries, row 0 at the top of the picture (v = 1).
struct UvRaster {
  static constexpr std::int64_t none = -1;
  int size = 0;
  // The square of uv that the texture covers: from `corner` (u, v) on, `side` long. (0, 0) and 1 but where uv
  // reaches further, as that of cloth whose pattern repeats does; then as many whole tiles as it takes.
  glm::dvec2 corner{0};
  int side = 1;
  std::vector<std::int64_t> triangle;   // of the texel's middle; `none` outside of all islands
  std::vector<glm::dvec3> barycentric;  // in that triangle
  // Where the texel's value comes from: itself, a texel of an island at most `widened` texels away, or
  // `none`. So filters that reach over an island's rim find nothing foreign there.
  std::vector<std::int64_t> source;
  std::size_t covered = 0, overlapping = 0;  // texels of islands, and those of more than one place
};

// The square of whole tiles that holds uv between `low` and `high`. Throws Error(bad_input) where it is more
// than most_tiles a side, with `instead` as its last words.
struct UvSquare {
  glm::dvec2 corner{0};
  int side = 1;
  glm::dvec2 place(const glm::dvec2& uv) const { return (uv - corner) / static_cast<double>(side); }  // 0 … 1
};
UvSquare uv_square(const glm::dvec2& low, const glm::dvec2& high, const std::string& instead);

// All triangles of the parts that wrinkle. A texel of several places goes to the first. Throws
// Error(bad_input) where none of them has uv, or where uv reaches over more than most_tiles.
UvRaster uv_raster(const Surface& surface, int size, int widened);

}  // namespace plisse
