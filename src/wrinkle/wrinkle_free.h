// The faces without wrinkles: W of section 5.1, from the strain alone.
#pragma once

#include <vector>

#include "wrinkle/surface.h"

namespace plisse::wrinkle {

enum class WrinkleFreeRule {
  paper,   // λ₂ averaged with the neighbours' is positive; then single faces join the faces around them
  authors  // their program's: λ₂ ≥ 0, then also faces whose three vertices belong to such faces
};

// One flag a face. Compression that is no more than noise (FaceForms::noise) is none.
std::vector<bool> wrinkle_free_faces(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                                     WrinkleFreeRule rule);

}  // namespace plisse::wrinkle
