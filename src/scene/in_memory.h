// What a user of the library has in memory, in place of files that a scene would name.
#pragma once

#include <memory>
#include <vector>

#include "io/model.h"
#include "io/wrinkle_field.h"
#include "mesh/solved_clip.h"

namespace plisse::scene {

struct InMemory {
  std::shared_ptr<const io::Model> model;  // in place of [model] path or garment, validated; null: none
  // In place of [bias] field, metres, y up: one of the rest pose, or one a frame; null: none.
  std::shared_ptr<const std::vector<io::WrinkleField>> fields;
  std::shared_ptr<const SolvedClip> solved;  // of this model; null: nothing was
};

}  // namespace plisse::scene
