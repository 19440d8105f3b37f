// The units in which the passes work (docs/passes.md, "Units"): the model's centre is the origin and its size
// about 1, so that rounding in single precision does not depend on the model's position and size.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace plisse {

struct ModelUnits {
  double metres = 1;           // of one unit: a power of two, so that scaling costs no digit
  glm::dvec3 rest_centre{0};   // origin of rest and bind positions, metres
  glm::dvec3 world_centre{0};  // origin of posed positions, metres

  static double unit_for(double size_in_metres) {
    return size_in_metres > 0 && std::isfinite(size_in_metres)
               ? std::exp2(std::ceil(std::log2(size_in_metres)))
               : 1.0;
  }
  glm::dvec3 rest(const glm::dvec3& x) const { return (x - rest_centre) / metres; }
  glm::dvec3 world(const glm::dvec3& x) const { return (x - world_centre) / metres; }
  // A matrix rest metres → world metres as a matrix rest units → world units.
  glm::dmat4 matrix(const glm::dmat4& m) const {
    glm::dmat4 result = m;
    const glm::dvec4 centre = m * glm::dvec4(rest_centre, 1.0) - glm::dvec4(world_centre, 0.0);
    result[3] = glm::dvec4(glm::dvec3(centre) / metres, 1.0);
    return result;
  }
};

}  // namespace plisse
