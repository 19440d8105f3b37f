// The glTF reader: from the file to the Model, piece by piece (see import_gltf.h).
#include "io/gltf/import_gltf.h"

#include "io/gltf/import_gltf_parts.h"
#include "io/import_place.h"

namespace plisse::io {

Model import_gltf(const std::filesystem::path& path, const ImportOptions& options) {
  GltfFile file(path);
  Model model;
  model.path = path;
  model.metres_per_unit = options.metres_per_unit.value_or(1);  // glTF 2.0, 3.4: metres, y up
  model.up = options.up.empty() ? "y" : options.up;
  const std::vector<GltfLook> looks = read_gltf_materials(file, model);
  const std::vector<int> nodes =
      read_gltf_nodes(file, file_to_world(model.up, model.metres_per_unit), looks, model);
  read_gltf_clips(file, nodes, model);
  return model;
}

}  // namespace plisse::io
