// Reads a model file, a numbered sequence (pattern or folder), through the reader that its kind needs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/model.h"

namespace plisse::io {

struct ImportOptions {
  std::optional<double> metres_per_unit;  // overrides the file's own unit
  std::string up;                         // "x", "y", "z", or empty: as the file says
};

// Throws Error(bad_input) with file, what is wrong and what to do. What it returns has been validated.
Model import_model(const std::filesystem::path& path, const ImportOptions& options = {});

// Throws Error(bad_input): no triangles, indices out of range, non-finite numbers, wrong counts, cyclic
// nodes.
void validate(const Model& model);

}  // namespace plisse::io
