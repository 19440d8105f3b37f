// Bone weights of a vertex from files, reduced to those of io::Mesh.
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
