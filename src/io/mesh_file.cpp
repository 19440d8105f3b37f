// Wavefront OBJ (B1 appendix), PLY through ply.h, binary glTF 2.0 (Khronos, 2.0.1, "GLB File Format").
#include "io/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "base/version.h"
#include "io/ply.h"

namespace plisse::io {
namespace {

void check_finite(const std::filesystem::path& path, const MeshFile& mesh) {
  const auto check = [&](const auto& values, const char* what) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto& x = values[i];
      for (int c = 0; c < x.length(); ++c) {
        if (!std::isfinite(x[c]))
          throw Error(ExitCode::no_output, fmt::format("{}: {} {} is not finite", path.string(), what, i));
      }
    }
  };
  check(mesh.positions, "position");
  check(mesh.normals, "normal");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const glm::vec2 uv = mesh.vertices[i].uv;
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
      throw Error(ExitCode::no_output, fmt::format("{}: uv {} is not finite", path.string(), i));
  }
}

bool any_uv(const MeshFile& mesh) {
  return std::any_of(mesh.parts.begin(), mesh.parts.end(), [](const auto& part) { return part.has_uv; });
}

// OBJ names end at white space.
std::string one_word(std::string name, const char* otherwise) {
  for (char& c : name)
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') c = '_';
  return name.empty() ? otherwise : name;
}

void write_obj(const std::filesystem::path& path, const MeshFile& mesh) {
  std::string text = fmt::format("# plisse {}: metres, y up\n", version);
  auto out = std::back_inserter(text);
  for (const glm::dvec3& x : mesh.positions) fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", x.x, x.y, x.z);
  const bool uv = any_uv(mesh);
  if (uv) {
    for (const auto& vertex : mesh.vertices)
      fmt::format_to(out, "vt {:.9g} {:.9g}\n", vertex.uv.x, vertex.uv.y);
  }
  for (const glm::dvec3& n : mesh.normals) fmt::format_to(out, "vn {:.7g} {:.7g} {:.7g}\n", n.x, n.y, n.z);
  const std::string* named = nullptr;
  for (const auto& part : mesh.parts) {
    // Groups, not objects: programs that take objects apart would number the places of each from 1, and a
    // point cache would not fit.
    if (!named || *named != part.mesh) fmt::format_to(out, "g {}\n", one_word(part.mesh, "mesh"));
    named = &part.mesh;
    fmt::format_to(out, "usemtl {}\n", one_word(part.material, "none"));
    for (std::size_t i = 3 * std::size_t{part.first_triangle};
         i < 3 * (std::size_t{part.first_triangle} + part.triangle_count); ++i) {
      const auto& vertex = mesh.vertices[mesh.triangles[i]];
      fmt::format_to(out, "{}{}/{}/{}", i % 3 == 0 ? "f " : " ", vertex.position + 1,
                     part.has_uv ? fmt::to_string(mesh.triangles[i] + 1) : "", vertex.normal + 1);
      if (i % 3 == 2) text += '\n';
    }
  }
  write_whole_file(path, text);
}

void write_as_ply(const std::filesystem::path& path, const MeshFile& mesh) {
  using Type = PlyProperty::Type;
  PlyElement vertex{"vertex", mesh.vertices.size()};
  const auto add = [&](const char* name, const auto& value) {
    PlyProperty property{name, Type::float32};
    property.values.reserve(mesh.vertices.size());
    for (const auto& v : mesh.vertices) property.values.push_back(static_cast<double>(value(v)));
    vertex.properties.push_back(std::move(property));
  };
  using Vertex = MeshFile::Vertex;
  const char *const axes[] = {"x", "y", "z"}, *const normals[] = {"nx", "ny", "nz"};
  for (int i = 0; i < 3; ++i) add(axes[i], [&](const Vertex& v) { return mesh.positions[v.position][i]; });
  for (int i = 0; i < 3; ++i) add(normals[i], [&](const Vertex& v) { return mesh.normals[v.normal][i]; });
  if (any_uv(mesh)) {
    add("s", [](const Vertex& v) { return v.uv.x; });
    add("t", [](const Vertex& v) { return v.uv.y; });
  }
  PlyElement face{"face", mesh.triangles.size() / 3};
  PlyProperty indices{"vertex_indices", Type::uint32, true};
  indices.values.assign(mesh.triangles.begin(), mesh.triangles.end());
  for (std::size_t i = 3; i <= mesh.triangles.size(); i += 3) indices.ends.push_back(i);
  face.properties.push_back(std::move(indices));
  write_ply(path, {{fmt::format("plisse {}: metres, y up", version)}, {std::move(vertex), std::move(face)}});
}

class Glb {
 public:
  // Adds floats or indices as an accessor and returns its number.
  template <typename Item>
  std::size_t add(const std::vector<Item>& items, int component, const char* type, int target,
                  bool with_range) {
    json_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", bytes_.size()},
                                    {"byteLength", items.size() * sizeof(Item)},
                                    {"target", target}});
    const auto* data = reinterpret_cast<const std::uint8_t*>(items.data());
    bytes_.insert(bytes_.end(), data, data + items.size() * sizeof(Item));  // all items are whole words
    nlohmann::ordered_json accessor = {{"bufferView", json_["bufferViews"].size() - 1},
                                       {"componentType", component},
                                       {"count", items.size()},
                                       {"type", type}};
    if constexpr (std::is_same_v<Item, glm::vec3>) {
      if (with_range) {
        glm::vec3 low(INFINITY), high(-INFINITY);
        for (const glm::vec3& x : items) low = glm::min(low, x), high = glm::max(high, x);
        accessor["min"] = {low.x, low.y, low.z};
        accessor["max"] = {high.x, high.y, high.z};
      }
    }
    json_["accessors"].push_back(accessor);
    return json_["accessors"].size() - 1;
  }
  nlohmann::ordered_json& json() { return json_; }

  void write(const std::filesystem::path& path) {
    json_["buffers"].push_back({{"byteLength", bytes_.size()}});
    std::string text = json_.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    text.append((4 - text.size() % 4) % 4, ' ');
    std::vector<std::uint8_t> file;
    const auto word = [&](std::size_t value) {
      const auto w = static_cast<std::uint32_t>(value);
      for (int i = 0; i < 4; ++i) file.push_back(static_cast<std::uint8_t>(w >> (8 * i)));
    };
    const std::size_t size = 12 + 8 + text.size() + 8 + bytes_.size();
    if (size > 0xffffffffU) {
      throw Error(ExitCode::no_output,
                  fmt::format("{}: would take {} bytes; a GLB holds 4 GiB at most", path.string(), size));
    }
    word(0x46546C67);  // glTF
    word(2);
    word(size);
    word(text.size());
    word(0x4E4F534A);  // JSON
    file.insert(file.end(), text.begin(), text.end());
    word(bytes_.size());
    word(0x004E4942);  // BIN
    file.insert(file.end(), bytes_.begin(), bytes_.end());
    write_whole_file(path, file);
  }

 private:
  nlohmann::ordered_json json_;
  std::vector<std::uint8_t> bytes_;
};

void write_glb(const std::filesystem::path& path, const MeshFile& mesh) {
  static_assert(std::endian::native == std::endian::little, "a GLB holds numbers as they lie in memory");
  constexpr int float32 = 5126, uint32 = 5125, array = 34962, elements = 34963, triangles = 4;
  Glb glb;
  auto& json = glb.json();
  json["asset"] = {{"version", "2.0"}, {"generator", fmt::format("plisse {}", version)}};
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec4> colours;
  for (const auto& vertex : mesh.vertices) {
    positions.emplace_back(mesh.positions[vertex.position]);
    normals.emplace_back(mesh.normals[vertex.normal]);
    uvs.emplace_back(vertex.uv.x, 1 - vertex.uv.y);
    colours.push_back(vertex.colour);
  }
  const auto any_colours =
      std::any_of(mesh.parts.begin(), mesh.parts.end(), [](const auto& part) { return part.has_colours; });
  const std::size_t position = glb.add(positions, float32, "VEC3", array, true),
                    normal = glb.add(normals, float32, "VEC3", array, false);
  const std::size_t uv = any_uv(mesh) ? glb.add(uvs, float32, "VEC2", array, false) : 0;
  const std::size_t colour = any_colours ? glb.add(colours, float32, "VEC4", array, false) : 0;
  auto primitives = nlohmann::ordered_json::array();
  for (const auto& part : mesh.parts) {
    if (part.triangle_count == 0) continue;
    const auto first = mesh.triangles.begin() + 3 * static_cast<std::ptrdiff_t>(part.first_triangle);
    const std::vector<std::uint32_t> indices(first,
                                             first + 3 * static_cast<std::ptrdiff_t>(part.triangle_count));
    const glm::vec4 base = part.base_colour;
    json["materials"].push_back({{"name", part.material},
                                 {"pbrMetallicRoughness",
                                  {{"baseColorFactor", {base.r, base.g, base.b, base.a}},
                                   {"metallicFactor", 0},
                                   {"roughnessFactor", 0.75}}},
                                 {"doubleSided", part.two_sided}});
    nlohmann::ordered_json attributes = {{"POSITION", position}, {"NORMAL", normal}};
    if (part.has_uv) attributes["TEXCOORD_0"] = uv;
    if (part.has_colours) attributes["COLOR_0"] = colour;
    primitives.push_back({{"attributes", attributes},
                          {"indices", glb.add(indices, uint32, "SCALAR", elements, false)},
                          {"material", json["materials"].size() - 1},
                          {"mode", triangles}});
  }
  const std::string name = mesh.parts.empty() ? "mesh" : mesh.parts.front().mesh;
  json["meshes"].push_back({{"name", name}, {"primitives", primitives}});
  json["nodes"].push_back({{"mesh", 0}});
  json["scenes"].push_back({{"nodes", {0}}});
  json["scene"] = 0;
  glb.write(path);
}

}  // namespace

void write_mesh(const std::filesystem::path& path, const MeshFile& mesh) {
  check_finite(path, mesh);
  const std::string ending = lower_case(path.extension().string());
  if (ending == ".obj") return write_obj(path, mesh);
  if (ending == ".ply") return write_as_ply(path, mesh);
  if (ending == ".glb") return write_glb(path, mesh);
  throw Error(ExitCode::bad_input,
              fmt::format("{}: geometry is written as .ply, .obj or .glb", path.string()));
}

}  // namespace plisse::io
