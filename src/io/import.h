// Reads a model file, a numbered sequence (pattern or folder), through the reader that its kind needs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/limits.h"
#include "io/model.h"

namespace plisse::io {

struct ImportOptions {
  std::optional<double> metres_per_unit;  // overrides the file's own unit
  std::string up;                         // "x", "y", "z", or empty: as the file says
  std::filesystem::path cache = {};       // MDD or PC2 over the model's mesh; empty: none
  Limits limits = {};                     // of the resources for one file
};

// Throws Error(bad_input) with file, what is wrong and what to do. The result has been validated. Files are
// read in a separate process (io/isolated_import.h), so that a damaged one can do no harm.
Model import_model(const std::filesystem::path& path, const ImportOptions& options = {});

// Throws Error(bad_input): no triangles, indices out of range, non-finite numbers, wrong counts, cyclic
// nodes, more of anything than the limits allow.
void validate(const Model& model, const Limits& limits = {});

}  // namespace plisse::io
