// Rest triangles laid out in the plane beside each other: texture coordinates of a shell.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "shell/rest_shape.h"

namespace plisse::shell {

// One place a corner, v upward. Triangles are moved rigidly, from the first of each piece on, to where they
// share sides; corners that come within a tenth of a side of where their vertex lies already go there. Where
// the rest shape is cut, or cannot be laid flat, the two sides of the cut have places of their own. Pieces
// (which share no side of the same length) stand side by side, and all of it is scaled by one number into
// 0 … 1.
std::vector<std::array<Eigen::Vector2d, 3>> unrolled(const Topology& topology,
                                                     const std::vector<RestFace>& rest);

}  // namespace plisse::shell
