// Flat parallelograms for tests of depth maps and shadows.
#pragma once

#include <vector>

#include "reference/depth.h"

namespace plisse::reference::test {

inline std::vector<Triangle> plate(const Eigen::Vector3d& corner, const Eigen::Vector3d& side,
                                   const Eigen::Vector3d& other) {
  std::vector<Triangle> triangles(2);
  triangles[0].waves.corners << corner, corner + side, corner + other;
  triangles[1].waves.corners << corner + side, corner + side + other, corner + other;
  triangles[0].welded = {0, 1, 2};
  triangles[1].welded = {1, 3, 2};
  for (Triangle& t : triangles) t.normals = Eigen::Vector3d(side.cross(other).normalized()).replicate(1, 3);
  return triangles;
}

// The depth map of some triangles as a GPU would store it.
inline ShadowMap stored(const std::vector<Triangle>& triangles, const Eigen::Matrix4d& view, int size,
                        double radius) {
  ShadowMap map;
  map.matrix = view;
  map.size = size;
  map.texel_size = 2 * radius / size;
  for (const double depth : depth_map(triangles, view, size).depth)
    map.depth.push_back(static_cast<float>(depth));
  return map;
}

}  // namespace plisse::reference::test
