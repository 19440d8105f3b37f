// A scene stepped in order and looked at between.
#pragma once

#include "gpu/timer.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/stepper.h"
#include "support/sheets.h"

namespace plisse::pipeline {

// Needs a current context.
struct History {
  // `smooth`: LoadedScene's.
  explicit History(const config::SceneSettings& settings, int smooth = LoadedScene::most_smooth,
                   const scene::InMemory& memory = {})
      : scene(settings, memory, smooth), timer(true), stepper(scene, timer, "") {}
  test::Readings at(int frame) {
    stepper.advance_to(scene.step_of_frame(frame));
    return test::read(stepper.surface());
  }
  pipeline::LoadedScene scene;
  gpu::StageTimer timer;
  pipeline::Stepper stepper;
};

}  // namespace plisse::pipeline
