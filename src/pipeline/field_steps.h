// How far a solved field's waves are from what was solved, after each step from the solver to the passes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/settings.h"

namespace plisse::pipeline {

// Of heights over the rest pose, on the model's own mesh, against those of the field that is drawn directly:
// the root of the mean square by area, over that of the field's heights.
struct FieldStep {
  std::string step;  // vertices | texture | clip
  double error = 0;
};

// All in the double-precision reference: the waves of the bias that bias_ply holds, and bias_png, where there
// is one ("" if not); and those of bias_ply after all frames of the clip, back in the rest pose (left out
// where vertices times frames are more than 2 million). `field`: as a stroke of kind field takes it. Throws
// as LoadedScene.
std::vector<FieldStep> field_steps(const config::SceneSettings& scene, const std::filesystem::path& field,
                                   const std::filesystem::path& bias_ply,
                                   const std::filesystem::path& bias_png);

}  // namespace plisse::pipeline
