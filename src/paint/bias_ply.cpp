#include <fmt/format.h>

#include "base/error.h"
#include "io/ply.h"
#include "mesh/weld.h"
#include "paint/bias_file.h"

namespace plisse::paint {

void write_bias_ply(const std::filesystem::path& path, const Surface& surface, const Painting& painting) {
  using Type = io::PlyProperty::Type;
  io::PlyElement vertex{"vertex", surface.vertex_count()}, face{"face", surface.triangle_count()};
  vertex.add_vectors("", Type::float64, surface.rest);
  vertex.add_vectors("bias_", Type::float64, painting.bias);
  if (painting.has_waves()) {
    vertex.add_vectors("wave_", Type::float64, painting.gradient);
    vertex.properties.push_back({"phase", Type::float64, false, painting.phase});
  }
  std::vector<double> corners;
  for (const std::uint32_t corner : surface.triangles)
    corners.push_back(surface.render_vertices[corner].welded);
  face.add_lists("vertex_indices", Type::uint32, 3, std::move(corners));
  io::write_ply(path, {{"plisse: painted wrinkles, welded vertices of the rest pose, metres, y up"},
                       {std::move(vertex), std::move(face)}});
}

Painting read_bias_ply(const std::filesystem::path& path, const Surface& surface) {
  const auto bad = [&](const std::string& what) {
    return Error(ExitCode::bad_input, fmt::format("{}: {}", path.string(), what));
  };
  const io::Ply ply = io::read_ply(
      path, {"x", "y", "z", "bias_x", "bias_y", "bias_z", "wave_x", "wave_y", "wave_z", "phase"});
  if (const std::size_t count = ply.element("vertex").count; count != surface.vertex_count()) {
    throw bad(fmt::format("has {} vertices, the model has {} welded ones; paint it anew for this model",
                          count, surface.vertex_count()));
  }
  const std::vector<glm::dvec3> positions = ply.vectors("vertex");
  Painting painting(surface.vertex_count());
  std::vector<glm::dvec3>& bias = painting.bias;
  bias = ply.vectors("vertex", "bias_");
  if (ply.element("vertex").find("wave_x")) {
    painting.gradient = ply.vectors("vertex", "wave_");
    painting.phase = ply.numbers("vertex", {"phase"});
  }
  // A hundred times the welding tolerance: another program may have written the file in single precision.
  const double tolerance = 100 * weld_tolerance(surface.rest);
  for (std::size_t v = 0; v < bias.size(); ++v) {
    if (!(glm::distance(positions[v], surface.rest[v]) <= tolerance)) {
      throw bad(
          fmt::format("vertex {} is {:.3g} m from the model's; it was painted on another model or rest pose",
                      v, glm::distance(positions[v], surface.rest[v])));
    }
    if (!(glm::length(bias[v]) < 1)) {
      throw bad(fmt::format("vertex {}: bias has a length of {:.4g}; it has to be less than 1", v,
                            glm::length(bias[v])));
    }
  }
  return painting;
}

}  // namespace plisse::paint
