// A model of an OBJ file (obj.h) and its MTL files.
#include "io/import_obj.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "base/log.h"
#include "base/text.h"
#include "io/import_colour.h"
#include "io/import_place.h"
#include "io/import_texture.h"
#include "io/mtl.h"
#include "io/obj.h"

namespace plisse::io {
namespace {

// A material and where its pictures are looked up.
struct Look {
  int id = -1;  // index into Model::materials
  glm::vec2 scale{1}, offset{0};
};

// The files that a line of `mtllib` names: one whose name may have blanks, or several. A library that is
// missing costs colours, not the model.
std::vector<std::filesystem::path> library_files(const std::filesystem::path& obj, const std::string& line) {
  std::vector<std::filesystem::path> files;
  const std::vector<std::string_view> words = words_of(line);
  for (std::size_t i = 0; i < words.size();) {
    std::filesystem::path found;
    std::size_t end = words.size();
    for (; end > i && found.empty(); --end) {
      std::string name(words[i].data(), words[end - 1].data() + words[end - 1].size());
      std::erase(name, '"');
      found = find_texture(obj, name);
    }
    if (found.empty())
      log::warn(fmt::format("{}: material library '{}' not found; going on without", obj.string(), words[i]));
    else
      files.push_back(found);
    i = found.empty() ? i + 1 : end + 1;
  }
  return files;
}

// How much of a picture is there: its alpha where it has some, else its grey.
std::uint8_t opacity_at(const Image& image, bool by_alpha, std::size_t texel) {
  const std::uint8_t* c = &image.rgba[4 * texel];
  if (by_alpha) return c[3];
  return static_cast<std::uint8_t>((c[0] * 54 + c[1] * 183 + c[2] * 19 + 128) / 256);  // ITU-R BT.709
}

// map_Kd and map_d as one picture with alpha, as large as the larger one; −1 without both. Sets how the
// material's alpha is used where there is a map_d.
int load_pictures(const std::filesystem::path& library, const MtlMaterial& source, Material& material,
                  Model& model) {
  const auto& [name, kd, opacity, picture, opacity_picture] = source;
  if (!opacity_picture)
    return picture ? load_texture_file(library, picture->name, Texture::Use::colour, model) : -1;
  Model loaded;
  const int mask = load_texture_file(library, opacity_picture->name, Texture::Use::colour, loaded);
  if (mask < 0) return picture ? load_texture_file(library, picture->name, Texture::Use::colour, model) : -1;
  const Image alpha = loaded.textures[static_cast<std::size_t>(mask)].image;
  Texture result{loaded.textures[static_cast<std::size_t>(mask)].name + " as opacity",
                 {1, 1, {255, 255, 255, 255}},
                 Texture::Use::colour};
  if (picture) {
    const int id = load_texture_file(library, picture->name, Texture::Use::colour, loaded);
    if (id >= 0) {
      result.image = loaded.textures[static_cast<std::size_t>(id)].image;
      result.name += " of " + loaded.textures[static_cast<std::size_t>(id)].name;
    }
  }
  const Image colour = result.image;
  Image& image = result.image;
  image.width = std::max(colour.width, alpha.width);
  image.height = std::max(colour.height, alpha.height);
  image.rgba.clear();
  bool by_alpha = false, partly = false;
  for (std::size_t i = 3; i < alpha.rgba.size(); i += 4) by_alpha |= alpha.rgba[i] < 255;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto texel = [&](const Image& of) {
        return static_cast<std::size_t>(std::int64_t{y} * of.height / image.height) *
                   static_cast<std::size_t>(of.width) +
               static_cast<std::size_t>(std::int64_t{x} * of.width / image.width);
      };
      const std::uint8_t* c = &colour.rgba[4 * texel(colour)];
      const std::uint8_t a = opacity_at(alpha, by_alpha, texel(alpha));
      partly |= a > 0 && a < 255;
      image.rgba.insert(image.rgba.end(), {c[0], c[1], c[2], a});
    }
  // Holes with sharp edges need no order of what lies behind one another.
  material.alpha = partly || material.base_colour.a < 1 ? Material::Alpha::blend : Material::Alpha::mask;
  for (std::size_t i = 0; i < model.textures.size(); ++i)
    if (model.textures[i].name == result.name) return static_cast<int>(i);
  model.textures.push_back(std::move(result));
  return static_cast<int>(model.textures.size()) - 1;
}

// Kd is sRGB, as modelling programs write it; a map_Kd takes its place.
void read_materials(const std::filesystem::path& library, Model& model, std::map<std::string, Look>& looks) {
  for (const MtlMaterial& source : read_mtl(library)) {
    const auto [entry, fresh] = looks.emplace(source.name, Look{static_cast<int>(model.materials.size())});
    if (!fresh) continue;  // the first of a name counts
    Material material;
    material.name = source.name;
    if (source.colour) material.base_colour = glm::vec4(linear(*source.colour), 1);
    material.base_colour.a = source.opacity;
    material.alpha = source.opacity < 1 ? Material::Alpha::blend : Material::Alpha::opaque;
    material.base_colour_texture = load_pictures(library, source, material, model);
    if (source.picture && material.base_colour_texture >= 0)
      material.base_colour = {1, 1, 1, material.base_colour.a};
    const auto& place = source.picture ? source.picture : source.opacity_picture;
    if (place) entry->second.scale = place->scale, entry->second.offset = place->offset;
    if (source.picture && source.opacity_picture &&
        (source.picture->scale != source.opacity_picture->scale ||
         source.picture->offset != source.opacity_picture->offset))
      log::warn(
          fmt::format("{}: material '{}' has other texture options in map_d than in map_Kd; those of map_Kd "
                      "are used for both",
                      library.string(), source.name));
    model.materials.push_back(std::move(material));
  }
}

}  // namespace

Model import_obj(const std::filesystem::path& path, const ImportOptions& options) {
  const ObjFile file = read_obj(path, {.looks = true, .polygons = ObjWanted::Polygons::cut});
  Model model;
  model.file_vertex_count = file.positions.size();
  model.path = file.path;
  model.metres_per_unit = options.metres_per_unit.value_or(1);
  model.up = options.up.empty() ? "y" : options.up;
  const glm::dmat4 world = file_to_world(model.up, model.metres_per_unit);
  model.nodes.emplace_back().name = file.path.stem().string();

  if (!file.left_out.empty())
    log::warn(fmt::format("{}: {} are not read; only its faces are", file.path.string(),
                          fmt::join(file.left_out, ", ")));
  std::map<std::string, Look> looks;
  for (const std::string& line : file.libraries)
    for (const auto& library : library_files(file.path, line)) read_materials(library, model, looks);
  const bool has_libraries = !looks.empty();
  const auto look_of = [&](const std::string& name) {
    if (name.empty()) return Look{};
    const auto [entry, added] = looks.emplace(name, Look{static_cast<int>(model.materials.size())});
    if (!added) return entry->second;
    model.materials.emplace_back().name = name;
    if (has_libraries)
      log::warn(fmt::format("{}: no library has the material '{}'; it is white", file.path.string(), name));
    return entry->second;
  };
  // As programs show them, so sRGB; white ones say nothing.
  const bool has_colours = std::any_of(file.colours.begin(), file.colours.end(),
                                       [](const glm::vec4& colour) { return colour != glm::vec4(1); });

  // Runs of one name and material are one mesh, in the order of their first triangle.
  std::map<std::pair<std::string, std::string>, std::size_t> mesh_ids;
  using Key = std::tuple<std::int32_t, std::int32_t, std::int32_t>;
  std::vector<std::map<Key, std::uint32_t>> vertex_ids;
  std::vector<Look> mesh_looks;
  for (std::size_t r = 0; r < file.runs.size(); ++r) {
    const ObjFile::Run& run = file.runs[r];
    const std::size_t end =
        r + 1 < file.runs.size() ? file.runs[r + 1].first_triangle : file.triangles.size();
    if (run.first_triangle == end) continue;
    const auto [entry, added] = mesh_ids.try_emplace({run.name, run.material}, model.meshes.size());
    const std::size_t id = entry->second;
    if (added) {
      Mesh& mesh = model.meshes.emplace_back();
      mesh.name = run.name.empty() ? file.path.stem().string() : run.name;
      mesh_looks.push_back(look_of(run.material));
      mesh.material = mesh_looks.back().id;
      vertex_ids.emplace_back();
      model.nodes[0].meshes.push_back(static_cast<int>(id));
    }
    Mesh& mesh = model.meshes[id];
    for (std::size_t t = run.first_triangle; t < end; ++t)
      for (const ObjFile::Corner& corner : file.triangles[t]) {
        const auto [vertex, fresh] = vertex_ids[id].try_emplace(
            {corner.position, corner.uv, corner.normal}, static_cast<std::uint32_t>(mesh.positions.size()));
        if (fresh) {
          mesh.positions.emplace_back(
              world * glm::dvec4(file.positions[static_cast<std::size_t>(corner.position)], 1));
          mesh.file_vertices.push_back(static_cast<std::uint32_t>(corner.position));
          // A corner without uv or normal gets a blank, and the mesh loses the array where all are blank.
          mesh.uvs.push_back(corner.uv < 0
                                 ? glm::vec2{0}
                                 : file.uvs[static_cast<std::size_t>(corner.uv)] * mesh_looks[id].scale +
                                       mesh_looks[id].offset);
          if (has_colours) {
            const glm::vec4 colour = file.colours[static_cast<std::size_t>(corner.position)];
            mesh.colours.emplace_back(linear(glm::vec3(colour)), glm::clamp(colour.a, 0.0F, 1.0F));
          }
          const glm::dvec3 normal = corner.normal < 0
                                        ? glm::dvec3{0}
                                        : glm::dvec3(file.normals[static_cast<std::size_t>(corner.normal)]);
          const double length = glm::length(normal);
          mesh.normals.emplace_back(length > 0 ? glm::dmat3(world) * normal / (length * model.metres_per_unit)
                                               : glm::dvec3{0});
        }
        mesh.triangles.push_back(vertex->second);
      }
  }
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    Mesh& mesh = model.meshes[m];
    const auto blank = [](const std::map<Key, std::uint32_t>& ids, auto member) {
      for (const auto& [key, id] : ids)
        if (member(key) >= 0) return false;
      return true;
    };
    if (blank(vertex_ids[m], [](const Key& key) { return std::get<1>(key); })) mesh.uvs.clear();
    // Normals on some corners only cannot be told from damage; the surface's own are used then.
    for (const glm::vec3& normal : mesh.normals)
      if (glm::dot(normal, normal) < 0.5F) {
        mesh.normals.clear();
        break;
      }
  }
  return model;
}

}  // namespace plisse::io
