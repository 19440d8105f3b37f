// Reference of the depth maps (docs/passes.md, "Depth maps"): the depth of the surface in a parallel view
// along a direction, for shadows and for the darkness close to the floor.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "reference/shading.h"

namespace plisse::reference {

// World → clip space of the parallel view along the unit vector `direction` that holds a sphere: NDC are the
// components of (x − centre)/radius along right, up and the direction.
Eigen::Matrix4d parallel_view(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& direction);

// The allowed values of the texels (column, row) of a map, entry row·size + column, row 0 at y = −1: depths
// 0…1, 1 where there is no surface. `nearest` and `farthest` bound the values of correct rasterisers
// (vertices snap to 1/256 of a texel, so an edge within reach = .01 texel of a centre may or may not cover
// it).
struct DepthMap {
  int size = 0;
  std::vector<double> depth, nearest, farthest;
};
DepthMap depth_map(const std::vector<Triangle>& triangles, const Eigen::Matrix4d& view, int size);

}  // namespace plisse::reference
