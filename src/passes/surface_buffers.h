// The welded surface on the GPU: constant data, data of the current frame, and state from frame to frame.
// Layouts are those of shaders/common/surface.glsl; bindings are given there and in each shader.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/buffer.h"
#include "mesh/model_units.h"
#include "mesh/subdivide.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"

namespace plisse::passes {

struct SurfaceBuffers {
  // Throws Error(try_again) when there is not enough memory. `seed` decides the phases at the start.
  SurfaceBuffers(const Surface& surface, const RestFrames& frames, const VertexWaves& waves,
                 const ModelUnits& units, std::uint32_t seed);
  // A displaced surface. DisplacementPass writes its points and normals, or `show` where they were computed
  // on the CPU; it is drawn only with Look::displaced.
  SurfaceBuffers(const Surface& surface, const Subdivision& fine);
  void show(const Subdivision& fine, const DisplacedSurface& displaced);
  // Another carried field, where the surface was made with one.
  void carry(const std::vector<FieldTriangle>& field, const ModelUnits& units);

  // Static.
  std::size_t vertex_count = 0, target_count = 0, triangle_count = 0;
  gpu::Buffer bind_places, influences, target_deltas;
  gpu::Buffer offsets, neighbours, rest_rows, constants, biases;
  gpu::Buffer carried;  // VertexWaves::carried in (t, b), or nothing
  gpu::Buffer corner_offsets, corners, tangent_neighbours;
  gpu::Buffer render_vertices, triangle_corners;
  gpu::Buffer render_colours;  // one per render vertex where a part has colours, else nothing
  gpu::Buffer field;           // a corner each: its plane's turns at the three corners, amplitude; or nothing
  gpu::Buffer relief;          // DisplacedSurface::relief
  // Per frame.
  gpu::Buffer positions, frames, world_waves;
  // State over time (docs/contract.md).
  gpu::Buffer states, waves, phases;
  // Work space of relax: the phases of the round before; the number of fresh vertices, whether all are idle,
  // and, for render, whether any has a height (taken as true before crush has run).
  gpu::Buffer phases_next, counter;
  bool any_height() const;

  // The bias and the wavelengths of another pose, whose frames are `posed` (VertexWaves::unstrained).
  void take_bias(const VertexWaves& waves, const RestFrames& rest, const RestFrames& posed,
                 const ModelUnits& units);

  // For shaders/common/surface.glsl to fetch from. `phases` alone where relax has swapped them.
  void bind_for_reading() const;
  void bind_phases_for_reading() const;
  static constexpr int own_unit = 17;  // the first of a pass's own texture units
};

// The uniform start of a phase for (seed, vertex), in (−π, π].
float initial_phase(std::uint32_t seed, std::uint32_t vertex);

}  // namespace plisse::passes
