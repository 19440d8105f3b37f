// Colours of files into linear light, the space of io::Material.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace plisse::io {

// The sRGB transfer function (IEC 61966-2-1), encoded 0…1 to linear 0…1.
inline float linear(float encoded) {
  const float x = glm::clamp(encoded, 0.0F, 1.0F);
  return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
}

inline glm::vec3 linear(const glm::vec3& encoded) {
  return {linear(encoded.r), linear(encoded.g), linear(encoded.b)};
}

}  // namespace plisse::io
