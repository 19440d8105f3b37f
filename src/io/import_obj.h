// Models of Wavefront OBJ files with their MTL materials.
#pragma once

#include <filesystem>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// A single OBJ: a static model. Throws Error(bad_input).
Model import_obj(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace plisse::io
