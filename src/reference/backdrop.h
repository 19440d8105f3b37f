// Reference of the backdrop (docs/passes.md, "Backdrop"): one colour, or a floor that passes into a wall
// without a visible edge, with the surface's shadows on it.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "reference/ground.h"

namespace plisse::reference {

// Linear colours of the picture's pixels, rows from the top downward, entry row·width + column.
// `background`: linear; `view_projection`: world → clip.
std::vector<Eigen::Vector3d> backdrop(const Eigen::Vector3d& background,
                                      const Eigen::Matrix4d& view_projection, const Ground& ground,
                                      const GroundMap& map, int width, int height);

}  // namespace plisse::reference
