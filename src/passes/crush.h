// Crush: strength, direction, height and wavenumber of the wave at every vertex (docs/passes.md, "Crush";
// Loviscach 2006, 4.2 and 5.1).
#pragma once

#include <string>

#include "gpu/program.h"
#include "passes/surface_buffers.h"

namespace plisse::passes {

class CrushPass {
 public:
  explicit CrushPass(const std::string& shader_folder);
  // Reads positions and frames; advances states, waves, world_waves and the status in phases. always_set:
  // relax mode `descent`, in which every vertex has a phase. unstrained: VertexWaves::unstrained. Leaves the
  // number of fresh vertices in surface.counter.
  void run(SurfaceBuffers& surface, double dead_zone, bool always_set, bool unstrained = false);

 private:
  gpu::Program crush_;
};

}  // namespace plisse::passes
