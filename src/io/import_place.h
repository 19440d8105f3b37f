// Turning and scaling a file's own space into ours: metres, y up, right-handed.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>

namespace plisse::io {

// Rotation from a space whose up axis is "x", "y" or "z" to y up. Right-handed: z up becomes (x, z, −y), x up
// becomes (−y, x, z). Throws Error(bad_input) for any other name.
glm::dmat4 upright(const std::string& up);

// upright(up) and then metres. Throws Error(bad_input) where metres_per_unit is not a positive, finite
// number.
glm::dmat4 file_to_world(const std::string& up, double metres_per_unit);

}  // namespace plisse::io
