// A scene that is stepped and drawn at will, without files: what most suites measure. Needs a current
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

  // The surface alone or with all of the scene's light, from whatever holds its waves.
  io::Image picture(const passes::SurfaceBuffers& surface);
  io::Image picture() { return picture(rig.surface()); }
  // 1 where the rig's surface is seen, row by row.
  std::vector<std::uint8_t> covered();
  // Waits until all that was ordered is done.
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
