// Relax: aligns the phases of neighbouring waves (docs/passes.md, "Relax"; Loviscach 2006, 5.2).
#pragma once

#include <string>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "passes/surface_buffers.h"

namespace plisse::passes {

struct RelaxOptions {
  int rounds = 1;              // descent rounds
  double epsilon = 13.2;       // ε of eq. 6
  bool onset = true;           // mode `smooth`: rule 3 of the state over time
  int onset_rounds = 8;        // P
  int smoothing_rounds = 300;  // S
};

class RelaxPass {
 public:
  explicit RelaxPass(const std::string& shader_folder);
  // Reads positions, world_waves and surface.counter (the fresh vertices); advances phases.
  void run(SurfaceBuffers& surface, const RelaxOptions& options);
  // Whether crush found no vertex with a wave: then run would change nothing.
  static bool idle(const SurfaceBuffers& surface);
  // Moves the phases of set vertices by a fraction of their distance to the phases of another moment, given
  // by its phases and states; used to close a loop.
  void lead(SurfaceBuffers& surface, const gpu::Buffer& phases, const gpu::Buffer& states, double fraction);
  // Fresh vertices that have a phase in that other moment take it and are set.
  void begin_as(SurfaceBuffers& surface, const gpu::Buffer& phases, const gpu::Buffer& states);

 private:
  void bind(SurfaceBuffers& surface);
  void lead(SurfaceBuffers& surface, const gpu::Buffer& phases, const gpu::Buffer& states, double fraction,
            bool fresh_ones);
  void round(const gpu::Program& program,
             SurfaceBuffers& surface);  // reads phases, writes phases_next, swaps both
  void smooth(SurfaceBuffers& surface, int rounds);
  gpu::Program descent_, spread_, rotors_, smooth_, finish_, lead_;
  gpu::Buffer numbers_, numbers_next_, rotor_list_;  // made at the first onset
};

}  // namespace plisse::passes
