// plisse measure: the waves of a mesh.
#include "pipeline/measure.h"

#include "io/import.h"
#include "mesh/measure_waves.h"

#include <fmt/format.h>

#include "base/error.h"
#include "scene/animation.h"

namespace plisse::pipeline {
namespace {

struct Plain {
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> triangles;
};

// Welded, in metres, as its file or first frame has it.
Plain read_mesh(const std::filesystem::path& path, const io::ImportOptions& options) {
  const io::Model model = io::import_model(path, options);
  scene::AnimationChoice choice;
  choice.limits = options.limits;
  scene::Animation animation(model, choice);
  const Surface& surface = animation.surface();
  Plain mesh{scene::posed(surface, animation.pose(1)), {}};
  for (const std::uint32_t v : surface.triangles) mesh.triangles.push_back(surface.render_vertices[v].welded);
  return mesh;
}

}  // namespace

MeshSpectrum measure(const MeasureRequest& request) {
  const Plain mesh = read_mesh(request.mesh, request.options);
  if (request.base.empty()) return measure_waves(height_over_own_shape(mesh.positions, mesh.triangles));
  const Plain base = read_mesh(request.base, request.options);
  return measure_waves(height_over_base(mesh.positions, mesh.triangles, base.positions, base.triangles));
}

}  // namespace plisse::pipeline
