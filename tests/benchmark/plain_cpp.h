// Crush and one round of relax as plain C++ would have them, single precision and structures of three floats,
// written from docs/passes.md: a comparison for the shaders' speed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "passes/surface_buffers.h"

namespace plisse::benchmark {

struct PlainSurface {
  struct Constant {
    float wavelength, mask;
  };
  struct RestEdge {
    glm::vec2 row;   // (S + μE)⁻¹ v_i
    glm::vec2 edge;  // v_i
  };
  struct State {
    glm::vec2 direction;  // k in (t, b)
    float compression;    // s = 1 − r
    float certainty;      // g
  };
  struct Wave {
    glm::vec2 wavenumber;  // κ in (t', b')
    float height, weight;
  };
  struct Phase {
    float phase, status;  // radians; 0 idle, 1 set, 2 fresh
  };

  std::vector<std::uint32_t> offsets, neighbours;
  std::vector<RestEdge> rest_edges;  // an entry a neighbour
  std::vector<Constant> constants;
  std::vector<glm::vec3> positions, normals, tangents;
  std::vector<State> states;
  std::vector<Wave> waves;
  std::vector<glm::vec3> world_wavenumbers;
  std::vector<float> weights;
  std::vector<Phase> phases, phases_next;

  // Copies the GPU's buffers, so that both start from the same state.
  explicit PlainSurface(const passes::SurfaceBuffers& gpu);
  std::size_t size() const { return positions.size(); }
};

// docs/passes.md, "Crush", mode `smooth`. With `threads` on all cores, by TBB.
void crush(PlainSurface& surface, float dead_zone, bool threads);
// docs/passes.md, "Relax", descent (eq. 6): one round; reads phases, writes phases_next and swaps them.
void descend(PlainSurface& surface, float epsilon, bool threads);

}  // namespace plisse::benchmark
