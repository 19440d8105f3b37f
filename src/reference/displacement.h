// The wrinkles as geometry: a point of a triangle moved along its normal by the height field, with the normal
// of the surface that this makes (docs/passes.md, "Displacement").
#pragma once

#include <Eigen/Dense>

#include "reference/shading.h"

namespace plisse::reference {

struct Displaced {
  Eigen::Vector3d base;      // the point of the triangle before displacement, in the triangle's unit
  Eigen::Vector3d position;  // where to
  Eigen::Vector3d normal;    // unit
  double height = 0, amplitude = 0;
  double sky_front = 1, sky_back = 1;  // "Cavity", seen from the side of the normals and from the other side
};

// `directions`: d_j, columns, the unit normals that all triangles at a corner share; at hard edges the
// triangle's own normals may differ. `cavity` as in Shading. Waves are not faded, since geometry does not
// depend on pixels.
Displaced displace(const Triangle& triangle, const Eigen::Matrix3d& directions,
                   const Eigen::Vector3d& barycentric, const Profile& profile, Blend blend, double cavity);

}  // namespace plisse::reference
