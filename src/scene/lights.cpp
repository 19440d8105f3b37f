#include "scene/lights.h"

#include <cmath>

namespace plisse::scene {

Lights lights_for(const config::LightSettings& light, const glm::dvec3& forward, const glm::dvec3& up) {
  glm::dvec3 back(-forward.x, 0, -forward.z);
  back = glm::length(back) > 1e-6 ? glm::normalize(back) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::cross(up, back);
  const auto direction = [&](double azimuth, double elevation) {
    const double a = glm::radians(azimuth), e = glm::radians(elevation);
    return std::cos(e) * (std::cos(a) * back + std::sin(a) * right) + std::sin(e) * up;
  };
  const glm::dvec3 key(light.key_colour), fill(light.fill_colour);
  Lights lights;
  lights.directional[0] = {direction(light.key_azimuth, light.key_elevation), light.key_intensity * key};
  lights.directional[1] = {direction(light.fill_azimuth, light.fill_elevation),
                           light.key_intensity * light.fill_ratio * fill};
  lights.directional[2] = {direction(light.rim_azimuth, light.rim_elevation),
                           light.rim_intensity * glm::dvec3(1)};
  lights.ambient = light.ambient * 0.5 * (fill + glm::dvec3(1));
  return lights;
}

}  // namespace plisse::scene
