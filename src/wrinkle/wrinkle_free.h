// Which faces have no wrinkles: W of section 5.1, found from the strain alone.
#pragma once

#include <vector>

#include "wrinkle/surface.h"

namespace plisse::wrinkle {

enum class WrinkleFreeRule {
  paper,   // λ₂ averaged with the neighbours' is positive; then lone faces join what is all round them
  authors  // their program's: λ₂ ≥ 0, then also faces whose three vertices belong to such faces
};

// One flag a face.
std::vector<bool> wrinkle_free_faces(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                                     WrinkleFreeRule rule);

}  // namespace plisse::wrinkle
