// Welding: vertices that a file splits at seams of uv or normal become one again, so that waves cross the
// seam (Loviscach 2006, section 3). One vertex means: one place, moved by the same matrices and the same
// morph deltas.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface.h"

namespace plisse {

struct WeldInput {
  std::vector<glm::dvec3> positions;          // V of them
  std::vector<PaletteInfluences> influences;  // one per vertex
  std::size_t target_count = 0;
  std::vector<glm::vec3> target_deltas;  // [target·V + v], unit of positions
};

struct Weld {
  std::vector<std::uint32_t> welded;          // per vertex: id of its welded vertex
  std::vector<std::uint32_t> representative;  // per welded vertex: the first vertex of it; ids ascend with it
};

// Joins a vertex to the first earlier one within `tolerance` (unit of positions) whose influences differ by
// at most 1e-4 per entry and whose deltas differ by at most `tolerance` each. Deterministic; a vertex is
// compared with representatives only, so a row of close points does not run together. Positions must be
// finite. `also_same`, where given, must hold as well.
Weld weld(const WeldInput& input, double tolerance,
          const std::function<bool(std::uint32_t, std::uint32_t)>& also_same = {});

// 1e-6 of the diagonal of the positions' bounding box: well above what single precision leaves between copies
// of a vertex (6e-8 of its coordinates), well below any edge.
double weld_tolerance(const std::vector<glm::dvec3>& positions);

}  // namespace plisse
