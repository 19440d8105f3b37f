// OBJ through obj.h, PLY through ply.h, binary glTF 2.0 (Khronos, 2.0.1, "GLB File Format").
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
#include "io/obj.h"
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

void write_as_obj(const std::filesystem::path& path, const MeshFile& mesh) {
  ObjWriter obj(fmt::format("plisse {}: metres, y up", version));
  for (const glm::dvec3& x : mesh.positions) obj.position(x);
  if (any_uv(mesh))
    for (const auto& vertex : mesh.vertices) obj.uv(vertex.uv);
  for (const glm::dvec3& n : mesh.normals) obj.normal(n);
  const std::string* named = nullptr;
  for (const auto& part : mesh.parts) {
    // Groups, not objects: programs that take objects apart would number the places of each from 1, and a
    // point cache would not fit.
    if (!named || *named != part.mesh) obj.group(part.mesh.empty() ? "mesh" : part.mesh);
    named = &part.mesh;
    obj.material(part.material.empty() ? "none" : part.material);
    for (std::size_t t = part.first_triangle; t < std::size_t{part.first_triangle} + part.triangle_count;
         ++t) {
      const auto corner = [&](std::size_t c) {
        const std::uint32_t id = mesh.triangles[3 * t + c];
        return ObjFile::Corner{static_cast<std::int32_t>(mesh.vertices[id].position),
                               part.has_uv ? static_cast<std::int32_t>(id) : -1,
                               static_cast<std::int32_t>(mesh.vertices[id].normal)};
      };
      obj.face({corner(0), corner(1), corner(2)});
    }
  }
  obj.write(path);
}

void write_as_ply(const std::filesystem::path& path, const MeshFile& mesh) {
  using Type = PlyProperty::Type;
  PlyElement vertex{"vertex", mesh.vertices.size()}, face{"face", mesh.triangles.size() / 3};
  std::vector<glm::dvec3> positions, normals;
  for (const auto& v : mesh.vertices) {
    positions.push_back(mesh.positions[v.position]);
    normals.push_back(mesh.normals[v.normal]);
  }
  vertex.add_vectors("", Type::float32, positions);
  vertex.add_vectors("n", Type::float32, normals);
  if (any_uv(mesh)) {
    PlyProperty s{"s", Type::float32}, t{"t", Type::float32};
    for (const auto& v : mesh.vertices) {
      s.values.push_back(v.uv.x);
      t.values.push_back(v.uv.y);
    }
    vertex.properties.push_back(std::move(s));
    vertex.properties.push_back(std::move(t));
  }
  face.add_lists("vertex_indices", Type::uint32, 3, {mesh.triangles.begin(), mesh.triangles.end()});
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
  if (ending == ".obj") return write_as_obj(path, mesh);
  if (ending == ".ply") return write_as_ply(path, mesh);
  if (ending == ".glb") return write_glb(path, mesh);
  throw Error(ExitCode::bad_input,
              fmt::format("{}: geometry is written as .ply, .obj or .glb", path.string()));
}

}  // namespace plisse::io
