// glTF 2.0 (Khronos, ISO/IEC 12113), as .gltf with its files or as .glb. Our own reader: animation modes,
// sparse and quantized accessors, compressed meshes and every index of them are read and checked here.
//
// Extensions: KHR_mesh_quantization, KHR_texture_transform, EXT_meshopt_compression,
// KHR_draco_mesh_compression, KHR_materials_pbrSpecularGlossiness (its colour). Extensions that only concern
// reflection and lights are ignored; any other that the file requires is an error.
#pragma once

#include <filesystem>

#include "io/import.h"
#include "io/model.h"

namespace plisse::io {

// Throws Error(bad_input) naming the file, the place in its JSON and what is wrong. The result is not yet
// validated.
Model import_gltf(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace plisse::io
