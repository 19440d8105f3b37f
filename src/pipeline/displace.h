// A scene's wrinkles as geometry: its surface, split finely and displaced by the waves of one moment in
// double precision (passes/displacement.h displaces on the GPU).
#pragma once

#include "mesh/subdivide.h"
#include "passes/surface_buffers.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/reference_scene.h"

namespace plisse::pipeline {

// How often edges have to be halved so that a wave on the longest edge has at least eight segments in all
// frames; less often where there would be more than four million triangles (with a warning). 0 without waves.
// Those of a smooth surface are among them.
int levels_for(const LoadedScene& scene);

// The scene's surface with every edge halved as often as its own waves need in all frames, but not below a
// pixel of the scene's pictures: cloth without waves stays coarse. All edges are halved less often where
// there would be more than four million triangles (with a warning).
Subdivision split_as_needed(const LoadedScene& scene);

class Displacement {
 public:
  // `mesh`: of the scene's surface.
  Displacement(const LoadedScene& scene, Subdivision mesh);

  const Subdivision& mesh() const { return mesh_; }
  // In model units; `metres` converts them to the world. Throws Error(check_failed) where something is not
  // finite.
  DisplacedSurface at(const WaveSnapshot& snapshot) const;
  DisplacedSurface at(const passes::SurfaceBuffers& surface) const { return at(read_snapshot(surface)); }
  glm::dvec3 metres(const glm::dvec3& x) const { return scene_.units.world_centre + scene_.units.metres * x; }

 private:
  const LoadedScene& scene_;
  ReferenceScene reference_;
  reference::Profile profile_;
  Subdivision mesh_;
};

}  // namespace plisse::pipeline
