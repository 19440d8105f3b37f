// Displacement: the wrinkles as geometry, a finer surface moved by the waves of the coarse one
// (docs/passes.md, "Displacement").
#pragma once

#include <string>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "mesh/subdivide.h"
#include "passes/profile_texture.h"
#include "passes/surface_buffers.h"

namespace plisse::passes {

class DisplacementPass {
 public:
  // `fine`: the subdivision of the surface that will be shown. `cavity` and `smooth_blend` as in Look;
  // `field`: whether the surface carries one. Throws Error(try_again) when there is not enough memory.
  DisplacementPass(const Subdivision& fine, const Profile& profile, bool smooth_blend, bool field,
                   double cavity, const std::string& shader_folder);
  // Reads the results of skin, crush and relax in `surface`; writes positions, relief and normals of `fine`,
  // the surface of the subdivision. Throws Error(check_failed) where something is not finite.
  void run(const SurfaceBuffers& surface, SurfaceBuffers& fine);

 private:
  // The points that belong to one vertex: the entries of row v are at offsets[v] ≤ i < offsets[v + 1].
  struct Rows {
    gpu::Buffer offsets, points;
  };
  void take_together(const SurfaceBuffers& surface, SurfaceBuffers& fine);

  ProfileTexture profile_;
  gpu::Program points_program_, places_program_, normals_program_;
  std::size_t point_count_, position_count_, vertex_count_;
  bool field_;
  double cavity_;
  gpu::Buffer points_, places_, normals_, skies_, shared_normals_, counter_;
  Rows position_rows_, normal_rows_;
};

}  // namespace plisse::passes
