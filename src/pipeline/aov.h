// Arbitrary output variables: pictures of one quantity of the surface each, as a float EXR and as a viewable
// PNG.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/target.h"
#include "passes/render.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/picture.h"

namespace plisse::pipeline {

// From names of the table in passes/aov.cpp. Throws Error(bad_input) for another name.
std::vector<passes::Aov> parse_aovs(const std::vector<std::string>& names);

// Beside the frame `name.png`: `name.height.exr` (metres, unit vectors, radians in (−π, π], 1 − r, or for
// object 1 + the number of the part; 0 where there is no surface) and `name.height.png` (the same, mapped to
// 0…1). `name.beauty.exr` is the frame in linear light, red, green, blue times alpha, and alpha. Whether all
// of them exist beside a frame, complete and with this hash.
bool aovs_are_whole(const std::vector<passes::Aov>& aovs, const std::string& frame_path,
                    const std::string& hash);

class AovWriter {
 public:
  AovWriter(const LoadedScene& scene, passes::RenderPass& pass, std::vector<passes::Aov> aovs);
  // `hash` is the frame's; the PNG, which is written after the EXR, contains it. `frame`: the picture itself.
  void write(const passes::SurfaceBuffers& surface, const passes::View& view, const std::string& frame_path,
             const std::string& hash, Picture& frame);

 private:
  void write_beauty(const passes::SurfaceBuffers& surface, const passes::View& view, const std::string& stem,
                    const std::string& hash, Picture& frame);
  const LoadedScene& scene_;
  passes::RenderPass& pass_;
  std::vector<passes::Aov> aovs_;
  gpu::Target target_;
  std::optional<gpu::Target> beauty_;  // with the frame's samples
};

}  // namespace plisse::pipeline
