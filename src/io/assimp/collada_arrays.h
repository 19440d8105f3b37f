// Checks of COLLADA arrays that assimp 5.2.5 lacks, so that it would read memory beyond them.
#pragma once

#include <filesystem>

namespace plisse::io {

// Throws Error(bad_input) where an accessor reaches beyond the array that it reads from.
void check_collada_arrays(const std::filesystem::path& path);

}  // namespace plisse::io
