// Skin: posed positions and tangent frames (docs/passes.md, "Skin"; Loviscach 2006, 4.1).
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "passes/surface_buffers.h"

namespace plisse::passes {

class SkinPass {
 public:
  // palette_size: matrices a pose has.
  SkinPass(std::size_t palette_size, std::size_t target_count, const std::string& shader_folder);
  // palette: model units, rest → world. Positions and frames of `surface` are overwritten.
  void run(SurfaceBuffers& surface, const std::vector<glm::dmat4>& palette,
           const std::vector<double>& target_weights);
  // A vertex cache in place of bones: posed positions in model units.
  void run_cache(SurfaceBuffers& surface, const std::vector<glm::vec4>& positions);

 private:
  void frames(SurfaceBuffers& surface);
  gpu::Program skin_, frame_;
  gpu::Buffer palette_, weights_;
};

}  // namespace plisse::passes
