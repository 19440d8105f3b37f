#include "io/import_ply.h"

#include <string_view>

#include "io/import_place.h"
#include "io/ply.h"

namespace plisse::io {

Model import_ply(const std::filesystem::path& path, const ImportOptions& options) {
  const Ply ply = read_ply(path, {"x", "y", "z", "nx", "ny", "nz", "s", "t", "u", "v", "texture_u",
                                  "texture_v", "texture_s", "texture_t", "vertex_indices", "vertex_index"});
  const std::vector<glm::dvec3> positions = ply.vectors("vertex");
  Model model;
  model.path = path;
  model.metres_per_unit = options.metres_per_unit.value_or(1);
  model.up = options.up.empty() ? "y" : options.up;
  const glm::dmat4 world = file_to_world(model.up, model.metres_per_unit);
  model.file_vertex_count = positions.size();
  Node& node = model.nodes.emplace_back();
  node.name = path.stem().string();
  node.meshes = {0};
  Mesh& mesh = model.meshes.emplace_back();
  mesh.name = node.name;
  mesh.positions.reserve(positions.size());
  mesh.file_vertices.reserve(positions.size());
  for (const glm::dvec3& position : positions) {
    mesh.file_vertices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.emplace_back(world * glm::dvec4(position, 1));
  }
  const auto triangles = ply.triangles(Ply::Polygons::cut);
  mesh.triangles.reserve(3 * triangles.size());
  for (const auto& triangle : triangles)
    mesh.triangles.insert(mesh.triangles.end(), triangle.begin(), triangle.end());
  const PlyElement& vertex = ply.element("vertex");
  const auto number = [&](std::initializer_list<std::string_view> names) {
    const PlyProperty* property = vertex.find(names);
    return property && !property->list ? property : nullptr;
  };
  const PlyProperty *u = number({"s", "u", "texture_u", "texture_s"}),
                    *v = number({"t", "v", "texture_v", "texture_t"});
  if (u && v)
    for (std::size_t i = 0; i < vertex.count; ++i) mesh.uvs.emplace_back(u->values[i], v->values[i]);
  const bool has_normals = number({"nx"}) && number({"ny"}) && number({"nz"});
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
  return model;
}

}  // namespace plisse::io
