// A model of an OBJ file (obj.h) and its MTL files.
#include "io/import_obj.h"

#include <fmt/format.h>

#include <map>
#include <sstream>
#include <string_view>
#include <tuple>

#include "base/log.h"
#include "base/text.h"
#include "io/import_colour.h"
#include "io/import_place.h"
#include "io/import_texture.h"
#include "io/obj.h"

namespace plisse::io {
namespace {

// Kd (sRGB, as modelling programs write it), d or Tr, map_Kd. A library that is missing costs colours, not
// the model.
void read_materials(const std::filesystem::path& obj, const std::string& library, Model& model,
                    std::map<std::string, int>& ids) {
  const std::filesystem::path path = find_texture(obj, library);
  if (path.empty()) {
    log::warn(fmt::format("{}: material library '{}' not found; going on without", obj.string(), library));
    return;
  }
  Material* material = nullptr;
  for_each_line(read_obj_text(path), [&](std::string_view line, std::size_t) {
    std::istringstream words{std::string(line)};
    std::string key;
    words >> key;
    float value = 1;
    if (key == "newmtl") {
      const std::string name(trimmed(line.substr(line.find("newmtl") + 6)));
      ids.emplace(name, static_cast<int>(model.materials.size()));
      material = &model.materials.emplace_back();
      material->name = name;
    } else if (material == nullptr) {
      return;
    } else if (glm::vec3 colour{1}; key == "Kd" && words >> colour.r >> colour.g >> colour.b) {
      if (material->base_colour_texture < 0)
        material->base_colour = {linear(colour), material->base_colour.a};
    } else if ((key == "d" || key == "Tr") && words >> value) {
      const float alpha = key == "d" ? value : 1 - value;
      // Some writers use 0 for Tr and d alike; an invisible material is not what they mean.
      material->base_colour.a = alpha > 0 && alpha <= 1 ? alpha : 1;
      material->alpha = material->base_colour.a < 1 ? Material::Alpha::blend : Material::Alpha::opaque;
    } else if (key == "map_Kd") {
      // Options stand before the name; names with blanks are taken when there are no options.
      std::string name(trimmed(line.substr(line.find("map_Kd") + 6)));
      if (name.starts_with('-')) name = name.substr(name.find_last_of(" \t") + 1);
      material->base_colour_texture = load_texture_file(path, name, Texture::Use::colour, model);
      if (material->base_colour_texture >= 0) material->base_colour = {1, 1, 1, material->base_colour.a};
    }
  });
}

}  // namespace

Model import_obj(const std::filesystem::path& path, const ImportOptions& options) {
  const ObjFile file = read_obj(path, {.uvs_and_normals = true, .polygons = ObjWanted::Polygons::cut});
  Model model;
  model.file_vertex_count = file.positions.size();
  model.path = file.path;
  model.metres_per_unit = options.metres_per_unit.value_or(1);
  model.up = options.up.empty() ? "y" : options.up;
  const glm::dmat4 world = file_to_world(model.up, model.metres_per_unit);
  model.nodes.emplace_back().name = file.path.stem().string();

  std::map<std::string, int> material_ids;
  for (const std::string& library : file.libraries) read_materials(file.path, library, model, material_ids);
  const auto material_id = [&](const std::string& name) {
    if (name.empty()) return -1;
    const auto [entry, added] = material_ids.emplace(name, static_cast<int>(model.materials.size()));
    if (added) model.materials.emplace_back().name = name;
    return entry->second;
  };

  // Runs of one name and material are one mesh, in the order of their first triangle.
  std::map<std::pair<std::string, std::string>, std::size_t> mesh_ids;
  using Key = std::tuple<std::int32_t, std::int32_t, std::int32_t>;
  std::vector<std::map<Key, std::uint32_t>> vertex_ids;
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
      mesh.material = material_id(run.material);
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
          mesh.uvs.push_back(corner.uv < 0 ? glm::vec2{0} : file.uvs[static_cast<std::size_t>(corner.uv)]);
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
