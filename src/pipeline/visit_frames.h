// Runs of a scene whose results are not pictures of its frames.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "passes/surface_buffers.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/render.h"

namespace plisse::pipeline {

struct Device {
  int number = -1;  // −1: first that works
  std::string shader_folder;
};

// Steps through the scene's history and calls `work` for each requested frame (ascending) with the state of
// the passes; `work` returns the path for the report. False where the run was interrupted before the last of
// them.
bool visit_frames(LoadedScene& scene, const std::vector<int>& frames, const Device& device,
                  const FrameCallback& on_frame,
                  const std::function<std::string(int frame, const passes::SurfaceBuffers& surface)>& work);

}  // namespace plisse::pipeline
