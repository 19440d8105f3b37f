// The three lights of a picture, key, fill and rim, whose directions are relative to the camera.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "config/settings.h"

namespace plisse::scene {

struct DirectionalLight {
  glm::dvec3 direction{0, 1, 0};  // toward the light, unit
  glm::dvec3 colour{1};           // linear, intensity included
};

struct Lights {
  std::array<DirectionalLight, 3> directional;  // key, fill, rim
  glm::dvec3 ambient{0.3};                      // linear
};

// For a camera that looks along `forward` (unit) where `up` (unit) is up: azimuths count round `up` from
// behind the camera, elevations from the horizon.
Lights lights_for(const config::LightSettings& light, const glm::dvec3& forward, const glm::dvec3& up);

}  // namespace plisse::scene
