// What assimp 5.2.5 does not look at in COLLADA files, and reads whatever lies behind in memory for.
#pragma once

#include <filesystem>

namespace plisse::io {

// Throws Error(bad_input) where an accessor reaches beyond the array that it reads from.
void check_collada_arrays(const std::filesystem::path& path);

}  // namespace plisse::io
