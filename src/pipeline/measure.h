// plisse measure: the waves on a mesh.
#pragma once

#include <filesystem>

#include "io/import.h"
#include "mesh/measure_waves.h"

namespace plisse::pipeline {

struct MeasureRequest {
  std::filesystem::path mesh, base;  // base: empty for the mesh's own shape
  io::ImportOptions options;
};

// Throws Error(bad_input).
MeshSpectrum measure(const MeasureRequest& request);

}  // namespace plisse::pipeline
