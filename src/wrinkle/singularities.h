// Singularities of the wave directions: vertices around which they turn.
#pragma once

#include <vector>

#include "wrinkle/local_waves.h"

namespace plisse::wrinkle {

// Twice the index of the field of directions ŵ (lines, of either sign) round every vertex inside the live
// faces: 0 where it is smooth, ±1 where it turns by 180 degrees, 2 at the centre of circles or rays. 0 at
// boundary vertices. Directions turn by less than 90 degrees between neighbouring faces. (K. Crane, M.
// Desbrun, P. Schröder, Trivial Connections on Discrete Surfaces, 2010.)
std::vector<int> double_index(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                              const std::vector<bool>& live);

}  // namespace plisse::wrinkle
