#include "pipeline/frame_fields.h"

#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "config/frames.h"
#include "io/import_place.h"
#include "io/sequence.h"
#include "io/wrinkle_field.h"
#include "paint/field.h"

namespace plisse::pipeline {

FrameFields::FrameFields(const config::SceneSettings& settings, int frame_count)
    : mesh_(settings.model.path), files_(io::sequence_files(settings.bias.field)) {
  const auto frames = static_cast<std::size_t>(frame_count);
  if (files_.size() != frames) {
    throw Error(ExitCode::bad_input,
                fmt::format("{}: there are {} fields, {} to {}, but the clip has {} frames; each needs one",
                            settings.bias.field.string(), files_.size(), files_.front().filename().string(),
                            files_.back().filename().string(), frames));
  }
  if (std::filesystem::is_directory(mesh_) || config::names_many_files(mesh_))
    meshes_ = io::sequence_files(mesh_);
}

FrameFields::FrameFields(std::shared_ptr<const std::vector<io::WrinkleField>> fields, int frame_count)
    : in_memory_(std::move(fields)) {
  if (in_memory_->size() != static_cast<std::size_t>(frame_count))
    throw Error(
        ExitCode::bad_input,
        fmt::format("there are {} wrinkle fields, but the clip has {} frames; give one, or one a frame",
                    in_memory_->size(), frame_count));
}

paint::SurfaceField FrameFields::over(const Surface& surface, const io::Model& model,
                                      const std::vector<glm::dvec3>& positions, int frame) const {
  const auto index = static_cast<std::size_t>(frame - 1);
  Surface base = surface;
  base.rest = positions;
  if (in_memory_)
    return paint::field_on(base, in_memory_->at(index), glm::dmat4(1),
                           fmt::format("wrinkle field of frame {}", frame));
  const auto file = io::read_wrinkle_field(files_.at(index), index < meshes_.size() ? meshes_[index] : mesh_);
  return paint::field_on(base, file, io::file_to_world(model.up, model.metres_per_unit),
                         files_[index].string());
}

}  // namespace plisse::pipeline
