// A scene with [solve]: its model → base surfaces that follow it → wrinkle fields, ready to be drawn.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cloth/follow_model.h"
#include "scene/in_memory.h"
#include "wrinkle/take_up.h"

namespace plisse::cloth {

struct SolveRequest {
  config::SceneSettings scene;
  std::filesystem::path cache;  // of bases and fields that were found before; empty: none
  std::function<void(std::string_view what, int done, int of)> progress;
};

struct SolvedFrame {
  FollowedFrame followed;
  double waves = 0, max_amplitude = 0;  // as WrinkleSequenceFrame's
  wrinkle::TakeUp taken;
  bool converged = true;  // base and field
  std::string reason;     // why not
  double solve_s = 0;
};

struct SolvedScene {
  scene::InMemory memory;                           // the model, and what was solved on it
  std::vector<SolvedFrame> frames;                  // from the first of the clip to the last that is drawn
  std::size_t vertices = 0, faces = 0, shells = 0;  // of the cloth
  double follow = 0, thickness = 0;                 // m
  Reuse reuse;
  bool interrupted = false;
};

// Frames that did not converge are kept as they are; the report says which. Throws Error(bad_input).
SolvedScene solve_scene(const SolveRequest& request);

}  // namespace plisse::cloth
