// The pieces of the glTF reader, one file each: the file and its bytes (import_gltf_file.cpp), accessors,
// materials, meshes, nodes, clips.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf/import_gltf_json.h"
#include "io/model.h"

namespace plisse::io {

class GltfFile {
 public:
  // Reads the JSON and a .glb's own chunk of bytes; checks version and required extensions.
  explicit GltfFile(const std::filesystem::path& path);
  ~GltfFile();
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  GltfValue root() const;
  GltfValue list(const std::string& name) const { return root()[name]; }

  // A buffer view's bytes, decompressed; `at` is the value that names it. They live as long as the file.
  std::span<const std::byte> view(const GltfValue& at);
  // What "data:…" holds; nothing for other texts.
  static std::optional<std::vector<std::byte>> data_of_uri(const GltfValue& uri);

  // To be called before memory is allocated that the file's size does not limit (compressed or absent data).
  void spend(std::uint64_t bytes, const GltfValue& for_what);

 private:
  std::span<const std::byte> buffer(const GltfValue& at);
  std::span<const std::byte> part(std::span<const std::byte> bytes, const GltfValue& of) const;
  std::vector<std::byte> decompressed(const GltfValue& compression);

  std::filesystem::path path_;
  std::unique_ptr<nlohmann::json> json_;
  std::vector<std::byte> chunk_;  // a .glb's
  std::map<std::size_t, std::vector<std::byte>> buffers_, decompressed_views_;
  std::uint64_t spent_ = 0;
};

// An accessor's elements, one after the other: count × width numbers. Normalised integers are divided
// already.
struct GltfArray {
  std::size_t count = 0, width = 0;
  std::vector<double> values;
  const double* operator[](std::size_t i) const { return values.data() + i * width; }
};

// `at` names the accessor, `types` are those it may have ("VEC3").
GltfArray read_gltf_accessor(GltfFile& file, const GltfValue& at,
                             std::initializer_list<std::string_view> types);
// Divides integers of that accessor into 0…1 or −1…1 (glTF 2.0, 3.11); 1 for floats.
double gltf_normaliser(const GltfValue& component_type);

// The uv set of a texture, and the transform of its uv (KHR_texture_transform).
struct GltfUvs {
  std::size_t set = 0;
  glm::dmat3 transform{1};
  bool operator==(const GltfUvs&) const = default;
};
struct GltfLook {
  GltfUvs colour, normal;
};
// Fills model.materials and textures; one look per material.
std::vector<GltfLook> read_gltf_materials(GltfFile& file, Model& model);

// The triangles of a primitive, decompressed by Draco or read from accessors.
struct GltfPrimitive {
  std::size_t vertices = 0;
  std::map<std::string, GltfArray> attributes;
  std::vector<std::uint32_t> indices;  // as in the file: a list, strip or fan
  bool indexed = false;
};
GltfPrimitive read_gltf_draco(GltfFile& file, const GltfValue& primitive, const GltfValue& compression);

// The triangle primitives of mesh `id` under a node of the model, moved by skin `skin` (−1 none). `nodes`:
// the file's nodes → the model's.
std::vector<Mesh> read_gltf_mesh(GltfFile& file, std::size_t id, int skin, int holder,
                                 const std::vector<int>& nodes, const std::vector<GltfLook>& looks);

// Adds the nodes below a root node with the matrix `world`, with their meshes and cameras. Returns the file's
// nodes → the model's.
std::vector<int> read_gltf_nodes(GltfFile& file, const glm::dmat4& world, const std::vector<GltfLook>& looks,
                                 Model& model);

void read_gltf_clips(GltfFile& file, const std::vector<int>& nodes, Model& model);

}  // namespace plisse::io
