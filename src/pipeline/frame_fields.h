// Solved wrinkle fields, in files or in memory, one for every frame of a sequence of base surfaces.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "config/settings.h"
#include "io/model.h"
#include "io/wrinkle_field.h"
#include "mesh/surface.h"
#include "paint/field.h"

namespace plisse::pipeline {

class FrameFields {
 public:
  FrameFields() = default;  // none
  // The files that settings.bias.field names. Throws Error(bad_input) where their number is not that of the
  // frames.
  FrameFields(const config::SceneSettings& settings, int frame_count);

  // The same of fields in memory, metres, y up.
  FrameFields(std::shared_ptr<const std::vector<io::WrinkleField>> fields, int frame_count);

  bool empty() const { return files_.empty() && !in_memory_; }
  // The field of a frame (from 1) on the surface whose welded vertices are at `positions` then, metres.
  // Throws Error(bad_input) where the field belongs to another surface.
  paint::SurfaceField over(const Surface& surface, const io::Model& model,
                           const std::vector<glm::dvec3>& positions, int frame) const;

 private:
  std::filesystem::path mesh_;                         // the model's own file
  std::vector<std::filesystem::path> files_, meshes_;  // meshes: for text files, the OBJ of each
  std::shared_ptr<const std::vector<io::WrinkleField>> in_memory_;
};

}  // namespace plisse::pipeline
