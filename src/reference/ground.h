// Reference of the floor's shadows (docs/passes.md, "Ground"): for each place of the floor, the shares of the
// key light and of the sky that the surface blocks.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "reference/shading.h"

namespace plisse::reference {

// Where the map lies. All in one unit.
struct Ground {
  Eigen::Vector3d up, across, along;  // orthonormal
  Eigen::Vector3d origin;             // the map's corner on the floor
  double floor = 0;                   // height of the floor along up
  double side = 0;                    // of the map
  double radius = 0;                  // of the model
};
// `centre`, `radius`: a sphere that contains the model in all frames.
Ground ground_under(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& up, double floor);

// The view from below, which finds the lowest surface: world → clip; depth 0…1 is the height above the floor
// divided by 2.04 radii.
Eigen::Matrix4d view_from_below(const Ground& ground, const Eigen::Vector3d& centre);

// Entry row·size + column, row 0 at the origin: shares of the key light and of the sky, 0…1.
struct GroundMap {
  int size = 0;
  std::vector<Eigen::Vector2d> taken;
};
// `key`: the key light's depth map; `below`: that of view_from_below. Softened.
GroundMap ground_map(const Ground& ground, const ShadowMap& key, const ShadowMap& below);

// The map at a place (0…1 along each axis), bilinear; outside the map its border texels are repeated.
Eigen::Vector2d sample(const GroundMap& map, const Eigen::Vector2d& place);

}  // namespace plisse::reference
