// The skirt among the examples of `plisse drape`: four panels, gathered at the waist, on a body of our own.
#pragma once

#include <cstdint>

#include "cloth/drape_scene.h"

namespace plisse::cloth {

// A closed torso from the thighs to the chest, 27,000 triangles, metres, y up, facing +z. Its motion: for `t`
// in 0 … 1 the hips turn to one side, to the other and back; the chest hardly moves.
shell::Positions torso_points(double t);
std::vector<shell::Face> torso_faces();

DrapeScene skirt_scene(int vertices, std::uint32_t seed);

}  // namespace plisse::cloth
