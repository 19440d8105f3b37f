// FBX, COLLADA, X and other formats through assimp (5.2.5, Debian 12).
#pragma once

#include <filesystem>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// Throws Error(bad_input) with assimp's own message where it cannot read the file. The result is not yet
// validated.
Model import_assimp(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace plisse::io
