// <plisse/mesh.h>: meshes from and to files.
#include "plisse/mesh.h"

#include "api/convert.h"
#include "io/import.h"
#include "io/mesh_file.h"
#include "scene/animation.h"

namespace plisse {

Mesh load_mesh(const std::filesystem::path& path, const LoadOptions& options) {
  const log::Scope scope(api::sink_of(options.messages));
  io::ImportOptions how;
  how.up = options.up;
  if (options.metres_per_unit > 0) how.metres_per_unit = options.metres_per_unit;
  const io::Model model = io::import_model(path, how);
  scene::Animation animation(model, {});
  const Surface& surface = animation.surface();
  Mesh mesh;
  mesh.positions = api::points_from(scene::posed(surface, animation.pose(1)));
  bool has_uv = false;
  for (const plisse::Part& part : surface.parts) {
    mesh.parts.push_back({part.mesh, part.material_name, part.first_triangle, part.triangle_count});
    has_uv = has_uv || part.has_uv;
  }
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    Triangle triangle;
    std::array<Vector2, 3> uv;
    for (std::size_t c = 0; c < 3; ++c) {
      const RenderVertex& vertex = surface.render_vertices[surface.triangles[3 * t + c]];
      triangle[c] = vertex.welded;
      uv[c] = {vertex.uv.x, vertex.uv.y};
    }
    mesh.triangles.push_back(triangle);
    if (has_uv) mesh.uv.push_back(uv);
  }
  return mesh;
}

void save_mesh(const std::filesystem::path& path, const Mesh& mesh) {
  api::check_mesh(path.string(), mesh);
  io::write_mesh(path, api::file_of(mesh));
}

}  // namespace plisse
