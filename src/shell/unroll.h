// Rest triangles unrolled into the plane: texture coordinates of a shell.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "shell/rest_shape.h"

namespace plisse::shell {

// One place a corner, v upward. Triangles are moved rigidly, beginning with the first of each piece, so that
// they share sides; a corner within a tenth of a side from the existing position of its vertex takes that
// position. Where the rest shape is cut, or cannot be flattened, the two sides of the cut have separate
// positions. Pieces (which share no side of the same length) stand side by side, and all of it is scaled by
// one number into 0 … 1.
std::vector<std::array<Eigen::Vector2d, 3>> unrolled(const Topology& topology,
                                                     const std::vector<RestFace>& rest);

}  // namespace plisse::shell
