// A scene that can be stepped and drawn freely, without files; most suites measure it. Needs a current
// context.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/subject.h"
#include "gpu/target.h"
#include "io/model.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/reference_scene.h"

namespace plisse::bench {

class Film {
 public:
  Film(const config::SceneSettings& settings, const std::string& name, bool software);

  // The surface alone or with all of the scene's light, from the given buffers.
  io::Image picture(const passes::SurfaceBuffers& surface);
  io::Image picture() { return picture(rig.surface()); }
  // 1 where the rig's surface is visible, row by row.
  std::vector<std::uint8_t> covered();
  // Waits until all OpenGL commands are finished.
  void draw(const passes::SurfaceBuffers& surface);

  pipeline::LoadedScene scene;
  Subject subject;
  pipeline::ReferenceScene reference;
  Rig rig;
  passes::View view;
  passes::RenderPass pass;
  gpu::Target target, floats;
  bool software;
};

}  // namespace plisse::bench
