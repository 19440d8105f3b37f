// The object of a measurement: a surface with its poses and its look, from a scene of assets/ or generated.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "config/settings.h"
#include "gpu/target.h"
#include "mesh/model_units.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"
#include "passes/crush.h"
#include "passes/profile.h"
#include "passes/relax.h"
#include "passes/render.h"
#include "passes/skin.h"
#include "passes/surface_buffers.h"
#include "pipeline/loaded_scene.h"

namespace plisse::bench {

struct Subject {
  std::string name;
  Surface surface;
  RestFrames rest;
  VertexWaves waves;
  ModelUnits units;
  std::vector<std::vector<glm::dmat4>> palettes;  // one a frame, in model units
  passes::Look look;
  passes::Profile profile;
  std::vector<passes::DrawPart> parts;
  std::vector<std::vector<passes::TextureLevel>> textures;
  passes::View view;
  double dead_zone = 0.005;

  double vertices() const { return static_cast<double>(surface.vertex_count()); }
};

// The poses from a scene's skeleton, frame by frame.
Subject subject_of(pipeline::LoadedScene& scene, const std::string& name);
// A jittered grid in the unit square with about this many vertices, compressed to 75 % along x and bent by
// four bones; its view is for pictures of this size.
Subject grid_subject(std::size_t vertices, int width, int height);

// A subject on the GPU, stepped through its frames. Needs a current context.
class Rig {
 public:
  // shader_folder: in place of the built-in shaders, unless it is empty.
  Rig(const Subject& subject, bool software, const std::string& shader_folder = "");
  // The next frame of the clip, which starts again at its end: skin, crush, relax; and as single passes.
  void step();
  void skin();
  void crush();
  void relax(int rounds, bool onset);
  // Steps to the middle of the clip, where the project's models have most wrinkles.
  void step_to_middle();
  // Resets to before the clip's first frame, without any state.
  void restart();
  // The next frame with these settings: crush and relax only every n-th frame.
  void advance(const config::RelaxSettings& settings);

  passes::SurfaceBuffers& surface() { return surface_; }
  bool software() const { return software_; }

 private:
  static passes::SurfaceBuffers fresh_buffers(const Subject& subject);
  const Subject& subject_;
  bool software_;
  passes::SurfaceBuffers surface_;
  passes::SkinPass skin_;
  passes::CrushPass crush_;
  passes::RelaxPass relax_;
  std::size_t frame_ = 0;
  std::vector<double> no_morphs_;
};

// The scene's own look without ground, shadows and wireframe: the surface alone.
passes::Look bare(passes::Look look);
// Draws and averages the samples, and waits for it.
void draw(passes::RenderPass& pass, Rig& rig, const Subject& subject, const gpu::Target& target);

void finish();  // glFinish

}  // namespace plisse::bench
