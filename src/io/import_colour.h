// Colours of files into linear light, the space of io::Material.
#pragma once

#include <glm/glm.hpp>

#include "base/colour.h"

namespace plisse::io {

// sRGB to linear per channel; what lies outside 0…1 is clamped.
inline glm::vec3 linear(const glm::vec3& encoded) {
  glm::vec3 result{0};
  for (int c = 0; c < 3; ++c)
    result[c] = static_cast<float>(srgb_to_linear(glm::clamp(static_cast<double>(encoded[c]), 0.0, 1.0)));
  return result;
}

}  // namespace plisse::io
