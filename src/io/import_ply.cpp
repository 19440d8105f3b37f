#include "io/import_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "base/log.h"
#include "base/text.h"
#include "io/import_colour.h"
#include "io/import_place.h"
#include "io/import_texture.h"
#include "io/ply.h"

namespace plisse::io {
namespace {

using Names = std::initializer_list<std::string_view>;

// The number property of the first of these names.
const PlyProperty* number(const PlyElement& element, Names names) {
  const PlyProperty* property = element.find(names);
  return property && !property->list ? property : nullptr;
}

// Colours of an element's items, linear, or none. As programs show them, so sRGB; whole numbers to the end of
// their type, floats to 1 (or to 255, which some programs write).
std::vector<glm::vec4> colours_of(const Ply& ply, const PlyElement& element) {
  const std::array<const PlyProperty*, 4> channels{
      number(element, {"red", "diffuse_red", "r"}), number(element, {"green", "diffuse_green", "g"}),
      number(element, {"blue", "diffuse_blue", "b"}), number(element, {"alpha", "diffuse_alpha", "a"})};
  if (!channels[0] || !channels[1] || !channels[2]) return {};
  std::array<double, 4> full{1, 1, 1, 1};
  double most = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    if (!channels[c]) continue;
    using Type = PlyProperty::Type;
    const Type type = channels[c]->type;
    if (type != Type::float32 && type != Type::float64) full[c] = type == Type::uint16 ? 65535 : 255;
    for (const double value : channels[c]->values) {
      if (full[c] == 1) most = std::max(most, value);
      if (std::isfinite(value)) continue;
      log::warn(fmt::format("{}: the colours of element '{}' are not all finite; they are left out", ply.file,
                            element.name));
      return {};
    }
  }
  for (double& end : full)
    if (end == 1 && most > 1.5) end = 255;
  std::vector<glm::vec4> colours;
  colours.reserve(element.count);
  bool tinted = false;
  for (std::size_t i = 0; i < element.count; ++i) {
    glm::dvec4 colour{1};
    for (int c = 0; c < 4; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      if (channels[channel]) colour[c] = std::clamp(channels[channel]->values[i] / full[channel], 0.0, 1.0);
    }
    colours.emplace_back(linear(glm::vec3(colour)), static_cast<float>(colour.a));
    tinted |= colours.back() != glm::vec4(1);
  }
  // White ones say nothing.
  return tinted ? colours : std::vector<glm::vec4>{};
}

// MeshLab's uv per corner of a face: two numbers each, or none for a face.
struct CornerUvs {
  const PlyProperty* list;
  std::size_t begin(std::size_t face) const { return face > 0 ? list->ends[face - 1] : 0; }
  bool fit(const PlyProperty& corners) const {
    for (std::size_t f = 0; f < corners.ends.size(); ++f) {
      const std::size_t count = corners.ends[f] - (f > 0 ? corners.ends[f - 1] : 0);
      const std::size_t found = list->ends[f] - begin(f);
      if (found != 0 && found != 2 * count) return false;
    }
    return std::all_of(list->values.begin(), list->values.end(), [](double x) { return std::isfinite(x); });
  }
  glm::vec2 at(std::size_t face, std::uint32_t corner) const {
    const std::size_t place = begin(face) + 2 * std::size_t{corner};
    return place + 2 <= list->ends[face] ? glm::vec2(list->values[place], list->values[place + 1])
                                         : glm::vec2(0);
  }
};

// The pictures that "comment TextureFile NAME" names, as materials. Empty names keep their numbers.
void read_textures(const Ply& ply, Model& model) {
  for (const std::string& comment : ply.comments) {
    std::string_view rest = comment;
    if (lower_case(std::string(next_word(rest))) != "texturefile") continue;
    const std::string name(trimmed(rest));
    Material& material = model.materials.emplace_back();
    material.name = name;
    material.base_colour_texture = load_texture_file(model.path, name, Texture::Use::colour, model);
  }
}

// A vertex for every different uv, colour and picture that faces give it: appends to the meshes, one for each
// picture.
class CornerReader {
 public:
  CornerReader(const Ply& ply, const Mesh& whole, std::optional<CornerUvs> uvs,
               std::vector<glm::vec4> colours, Model& model)
      : whole_(whole), uvs_(uvs), colours_(std::move(colours)), model_(model) {
    textures_ = number(ply.element("face"), {"texnumber"});
  }

  void read(const std::vector<Ply::FaceTriangle>& triangles) {
    for (const Ply::FaceTriangle& triangle : triangles) {
      const std::size_t part = part_of(triangle.face);
      for (std::size_t c = 0; c < 3; ++c) add(part, triangle, c);
    }
  }

 private:
  using Key = std::tuple<std::uint32_t, float, float, float, float, float, float>;

  std::size_t part_of(std::uint32_t face) {
    // Without a number, or with one that no picture has, the first; −1: none.
    const double number = textures_ ? textures_->values[face] : 0;
    const bool known = number >= 0 && number < static_cast<double>(model_.materials.size());
    const int material = model_.materials.empty() || number == -1 ? -1 : known ? static_cast<int>(number) : 0;
    const auto [entry, fresh] = parts_.try_emplace(material, model_.meshes.size());
    if (fresh) {
      Mesh& mesh = model_.meshes.emplace_back();
      mesh.name = whole_.name;
      mesh.material = material;
      model_.nodes[0].meshes.push_back(static_cast<int>(entry->second));
      known_.emplace_back();
    }
    return entry->second;
  }

  void add(std::size_t part, const Ply::FaceTriangle& triangle, std::size_t c) {
    const std::uint32_t vertex = triangle.vertex[c];
    const glm::vec2 uv = uvs_                 ? uvs_->at(triangle.face, triangle.corner[c])
                         : whole_.uvs.empty() ? glm::vec2(0)
                                              : whole_.uvs[vertex];
    const glm::vec4 colour = !colours_.empty()        ? colours_[triangle.face]
                             : whole_.colours.empty() ? glm::vec4(1)
                                                      : whole_.colours[vertex];
    Mesh& mesh = model_.meshes[part];
    const auto [entry, fresh] =
        known_[part].try_emplace(Key(vertex, uv.x, uv.y, colour.r, colour.g, colour.b, colour.a),
                                 static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      mesh.positions.push_back(whole_.positions[vertex]);
      mesh.file_vertices.push_back(vertex);
      if (!whole_.normals.empty()) mesh.normals.push_back(whole_.normals[vertex]);
      if (uvs_ || !whole_.uvs.empty()) mesh.uvs.push_back(uv);
      if (!colours_.empty() || !whole_.colours.empty()) mesh.colours.push_back(colour);
    }
    mesh.triangles.push_back(entry->second);
  }

  const Mesh& whole_;
  std::optional<CornerUvs> uvs_;
  std::vector<glm::vec4> colours_;
  const PlyProperty* textures_;
  Model& model_;
  std::map<int, std::size_t> parts_;  // material → mesh
  std::vector<std::map<Key, std::uint32_t>> known_;
};

void warn_of_the_rest(const Ply& ply) {
  for (const char* name : {"edge", "tristrips", "multi_texture_vertex"})
    if (const PlyElement* element = ply.find(name); element && element->count > 0)
      log::warn(fmt::format("{}: its element '{}' is not read", ply.file, name));
}

}  // namespace

Model import_ply(const std::filesystem::path& path, const ImportOptions& options) {
  const Ply ply = read_ply(path,
                           {"x", "y", "z", "nx", "ny", "nz", "s", "t", "u", "v", "texture_u", "texture_v",
                            "texture_s", "texture_t", "vertex_indices", "vertex_index"},
                           {"red", "green", "blue", "alpha", "diffuse_red", "diffuse_green", "diffuse_blue",
                            "diffuse_alpha", "r", "g", "b", "a", "texcoord", "texnumber"});
  const std::vector<glm::dvec3> positions = ply.vectors("vertex");
  Model model;
  model.path = path;
  model.metres_per_unit = options.metres_per_unit.value_or(1);
  model.up = options.up.empty() ? "y" : options.up;
  const glm::dmat4 world = file_to_world(model.up, model.metres_per_unit);
  model.file_vertex_count = positions.size();
  Node& node = model.nodes.emplace_back();
  node.name = path.stem().string();
  Mesh mesh;
  mesh.name = node.name;
  mesh.positions.reserve(positions.size());
  mesh.file_vertices.reserve(positions.size());
  for (const glm::dvec3& position : positions) {
    mesh.file_vertices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.emplace_back(world * glm::dvec4(position, 1));
  }
  const PlyElement& vertex = ply.element("vertex");
  const PlyProperty *u = number(vertex, {"s", "u", "texture_u", "texture_s"}),
                    *v = number(vertex, {"t", "v", "texture_v", "texture_t"});
  if (u && v)
    for (std::size_t i = 0; i < vertex.count; ++i) mesh.uvs.emplace_back(u->values[i], v->values[i]);
  const bool has_normals = number(vertex, {"nx"}) && number(vertex, {"ny"}) && number(vertex, {"nz"});
  const glm::dmat3 turn(upright(model.up));
  for (const glm::dvec3& given : has_normals ? ply.vectors("vertex", "n") : std::vector<glm::dvec3>{}) {
    const glm::dvec3 normal(glm::vec3{given});
    const double length = glm::length(normal);
    // Normals that are missing on some vertices cannot be told from damage; the surface's own are used then.
    if (!(length > 0)) {
      mesh.normals.clear();
      break;
    }
    mesh.normals.emplace_back(turn * normal / length);
  }
  mesh.colours = colours_of(ply, vertex);
  read_textures(ply, model);
  warn_of_the_rest(ply);

  const PlyElement* face = ply.find("face");
  const PlyProperty* list = face ? face->find("texcoord") : nullptr;
  std::optional<CornerUvs> corner_uvs;
  if (list && list->list) corner_uvs = CornerUvs{list};
  const PlyProperty* corners = face ? face->find({"vertex_indices", "vertex_index"}) : nullptr;
  if (corner_uvs && corners && corners->list && !corner_uvs->fit(*corners)) {
    log::warn(fmt::format(
        "{}: 'texcoord' has not two finite numbers for each corner of a face; it is left out", ply.file));
    corner_uvs.reset();
  }
  std::vector<glm::vec4> face_colours = face ? colours_of(ply, *face) : std::vector<glm::vec4>{};
  if (!face_colours.empty() && !mesh.colours.empty()) {
    log::warn(
        fmt::format("{}: both vertices and faces have colours; those of the vertices are used", ply.file));
    face_colours.clear();
  }
  if (!model.materials.empty() && !corner_uvs && mesh.uvs.empty())
    log::warn(
        fmt::format("{}: names a texture, but has no uv (s and t of vertices, texcoord of faces)", ply.file));
  const bool by_corners = corner_uvs || !face_colours.empty() || model.materials.size() > 1;
  if (by_corners) {
    const auto triangles = ply.face_triangles(Ply::Polygons::cut);
    CornerReader(ply, mesh, corner_uvs, std::move(face_colours), model).read(triangles);
  } else {
    const auto triangles = ply.triangles(Ply::Polygons::cut);
    mesh.triangles.reserve(3 * triangles.size());
    for (const auto& triangle : triangles)
      mesh.triangles.insert(mesh.triangles.end(), triangle.begin(), triangle.end());
    mesh.material = model.materials.empty() ? -1 : 0;
    node.meshes = {0};
    model.meshes.push_back(std::move(mesh));
  }
  // Colours that are partly transparent need a material that says so.
  for (Mesh& part : model.meshes) {
    if (std::none_of(part.colours.begin(), part.colours.end(), [](const glm::vec4& c) { return c.a < 1; }))
      continue;
    if (part.material < 0) {
      part.material = static_cast<int>(model.materials.size());
      model.materials.emplace_back().name = part.name;
    }
    model.materials[static_cast<std::size_t>(part.material)].alpha = Material::Alpha::blend;
  }
  return model;
}

}  // namespace plisse::io
