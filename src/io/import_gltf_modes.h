// What assimp 5.2.5 loses of glTF animations: how a sampler goes from key to key.
#pragma once

#include "io/import_assimp_parts.h"

namespace plisse::io {

// Reads the interpolation of every channel from the file's JSON and sets it in the model's clips, which must
// be those that read_clips made. STEP is restored; of CUBICSPLINE assimp keeps the values without their
// tangents, so it stays linear and one warning says so. Does nothing where the JSON cannot be read.
void restore_gltf_modes(const AssimpScene& from, Model& model);

}  // namespace plisse::io
