// Models of PLY files. Our own reader (ply.h), because in a sequence every vertex must keep its number, and
// assimp 5.2.5 crashes on damaged files of this kind.
#pragma once

#include <filesystem>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// A single file: a static model of x, y, z, the faces, and of nx, ny, nz and s, t (or u, v, texture_u,
// texture_v, texture_s, texture_t) where they are there. Throws Error(bad_input).
Model import_ply(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace plisse::io
