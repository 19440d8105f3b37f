// Bone weights of a vertex as files have them, cut down to what io::Mesh keeps.
#pragma once

#include <cstdint>
#include <vector>

#include "io/model.h"

namespace plisse::io {

struct BoneWeight {
  std::uint32_t bone;
  double weight;  // > 0
};

// The strongest eight, renormalised, strongest first; all of it with `unbound` where there are none. Sorts
// `weights`.
Influences strongest(std::vector<BoneWeight>& weights, std::uint32_t unbound);

}  // namespace plisse::io
