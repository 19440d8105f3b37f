// Loop subdivision as masks: which vertices of a mesh, with what weights, make each vertex of the next finer
// one, of the limit surface and of its tangents (C. Loop, Smooth Subdivision Surfaces Based on Triangles,
// 1987). OpenSubdiv computes them; here they become plain rows, so that values can be subdivided that are not
// one per vertex, such as phases with jumps.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/surface.h"

namespace plisse {

struct LoopWeight {
  std::uint32_t vertex = 0;
  double weight = 0;
};

struct LoopLevel {
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  std::uint32_t vertex_count = 0;
  std::vector<std::array<std::uint32_t, 3>> faces;
  // Side s of a face leads from its corner s to corner s + 1. Beyond it: 3 · face + side of the neighbour, or
  // none.
  std::vector<std::array<std::uint32_t, 3>> across;

  // From level 1 on. The mask of each vertex, over vertices of the level before; weights sum to 1, none is
  // negative.
  Rows<LoopWeight> masks;
  // The face of the level before that a face is a quarter of, and what its corners are there: corner 0 … 2,
  // or 3 + s, the point on side s.
  std::vector<std::uint32_t> parent;
  std::vector<std::array<std::uint8_t, 3>> place;
};

struct LoopSubdivision {
  std::vector<LoopLevel> levels;  // the mesh itself first
  // Over vertices of the last level, a row for each of them: its place on the limit surface, and two tangents
  // there, the first × the second being along the normal. Vertices that no face has stay where they are, with
  // no tangents.
  Rows<LoopWeight> limit;
  std::array<Rows<LoopWeight>, 2> tangents;
};

// Boundaries are cubic B-spline curves that do not depend on the interior; boundary vertices of only one
// face, and all vertices in `sharp`, stay in place. Throws Error(bad_input) where a face names a vertex that
// is not there or one twice, an edge has more than two faces, two faces run along an edge the same way, or
// the faces at a vertex are not connected around it.
LoopSubdivision subdivide_loop(const std::vector<std::array<std::uint32_t, 3>>& faces,
                               std::uint32_t vertex_count, int levels,
                               const std::vector<std::uint32_t>& sharp = {});

// Values of the vertices that rows of masks make, from those of the vertices that they are over.
template <typename Value>
std::vector<Value> applied(const Rows<LoopWeight>& masks, const std::vector<Value>& values) {
  std::vector<Value> result(masks.offsets.size() - 1, Value(0));
  for (std::size_t v = 0; v < result.size(); ++v)
    for (std::uint32_t i = masks.offsets[v]; i < masks.offsets[v + 1]; ++i)
      result[v] += masks.items[i].weight * values[masks.items[i].vertex];
  return result;
}

}  // namespace plisse
