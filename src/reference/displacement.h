// The wrinkles as geometry: a point of a triangle moved along its normal by the height field, with the normal
// of the surface that this makes (docs/passes.md, "Displacement").
#pragma once

#include <Eigen/Dense>

#include "reference/shading.h"

namespace plisse::reference {

struct Displaced {
  Eigen::Vector3d base;      // the point of the triangle that was moved, unit of the triangle
  Eigen::Vector3d position;  // where to
  Eigen::Vector3d normal;    // unit
  double height = 0, amplitude = 0;
  double sky_front = 1, sky_back = 1;  // "Cavity", as seen from the normals' side and from the other
};

// `directions`: d_j, columns, the unit normals of the corners as all triangles around them share them; the
// triangle's own normals may be others, at hard edges. `cavity` as in Shading. Nothing fades: geometry knows
// no pixels.
Displaced displace(const Triangle& triangle, const Eigen::Matrix3d& directions,
                   const Eigen::Vector3d& barycentric, const Profile& profile, Blend blend, double cavity);

}  // namespace plisse::reference
