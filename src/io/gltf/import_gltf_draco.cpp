// KHR_draco_mesh_compression: triangles and attributes of a primitive out of one bitstream.
#include <draco/compression/decode.h>
#include <fmt/format.h>

#include "io/gltf/import_gltf_parts.h"

namespace plisse::io {

GltfPrimitive read_gltf_draco(GltfFile& file, const GltfValue& primitive, const GltfValue& compression) {
  const auto bytes = file.view(compression["bufferView"]);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    compression.fail(
        fmt::format("cannot be decompressed: Draco says '{}'", decoded.status().error_msg_string()));
  const draco::Mesh& mesh = *decoded.value();

  GltfPrimitive result;
  result.indexed = true;
  result.vertices = mesh.num_points();
  result.indices.reserve(3 * std::size_t{mesh.num_faces()});
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (std::size_t c = 0; c < 3; ++c) result.indices.push_back(mesh.face(f)[c].value());

  for (const auto& [name, id] : compression["attributes"].members()) {
    const draco::PointAttribute* source = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id.count()));
    if (source == nullptr) id.fail(fmt::format("no attribute {} in the Draco data", id.count()));
    const GltfValue used = primitive["attributes"][name];
    if (!used) continue;
    const GltfValue accessor = file.list("accessors").at(used.index(file.list("accessors")));
    const bool divide = accessor["normalized"].truth(false) && !source->normalized();
    const double scale = divide ? 1 / gltf_normaliser(accessor["componentType"]) : 1;
    GltfArray& array = result.attributes[name];
    array.count = result.vertices;
    array.width = static_cast<std::size_t>(source->num_components());
    file.spend(array.count * array.width * sizeof(double), compression);
    array.values.resize(array.count * array.width);
    for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
      double* to = array.values.data() + p.value() * array.width;
      if (!source->ConvertValue<double>(source->mapped_index(p), static_cast<std::int8_t>(array.width), to))
        id.fail(fmt::format("attribute '{}' of the Draco data is of no type that can be read", name));
      for (std::size_t c = 0; c < array.width; ++c) to[c] *= scale;
    }
  }
  return result;
}

}  // namespace plisse::io
