// Tangent frames along the uv coordinates, one per render vertex; the angles of the uv texture refer to them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface.h"

namespace plisse::paint {

struct UvFrame {
  glm::dvec3 along_u{0};  // unit, tangent to the rest pose, where u grows; 0 where there is no uv
  glm::dvec3 along_v{
      0};  // unit, tangent, at right angles to along_u, on the side where v grows: mirrored uv stays right
  // ∂x/∂u and ∂x/∂v of the triangles around, weighted by their areas; metres per unit of uv.
  glm::dvec3 per_u{0}, per_v{0};
  bool valid() const { return along_u != glm::dvec3(0); }
};
std::vector<UvFrame> uv_frames(const Surface& surface, const RestFrames& rest);

}  // namespace plisse::paint
