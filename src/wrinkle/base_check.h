// Whether a surface is one that wrinkles can stand on: what would make a field wrong without a word.
#pragma once

#include <string>
#include <vector>

#include "wrinkle/surface.h"

namespace plisse::wrinkle {

struct BaseFault {
  std::string kind;  // "unit", "kinks", "crest compression"
  std::string text;  // a sentence
};

// At most one of each kind, with the share of the surface's rest area that has it: positions in another unit
// than the rest shape, a tension field that kinks (crests of neighbouring faces that meet at a large angle),
// compression along the crests, which no wave takes up. Empty: none of them.
std::vector<BaseFault> base_faults(const shell::Topology& topology, const std::vector<FaceForms>& forms);

}  // namespace plisse::wrinkle
