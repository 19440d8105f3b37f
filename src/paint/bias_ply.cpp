#include <fmt/format.h>

#include "base/error.h"
#include "io/ply.h"
#include "mesh/weld.h"
#include "paint/bias_file.h"

namespace plisse::paint {

void write_bias_ply(const std::filesystem::path& path, const Surface& surface,
                    const std::vector<glm::dvec3>& bias) {
  using Type = io::PlyProperty::Type;
  io::PlyElement vertex{"vertex", surface.vertex_count()};
  const char* const axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    io::PlyProperty property{axes[i], Type::float64};
    for (const glm::dvec3& x : surface.rest) property.values.push_back(x[i]);
    vertex.properties.push_back(std::move(property));
  }
  for (int i = 0; i < 3; ++i) {
    io::PlyProperty property{std::string("bias_") + axes[i], Type::float64};
    for (const glm::dvec3& p : bias) property.values.push_back(p[i]);
    vertex.properties.push_back(std::move(property));
  }
  io::PlyElement face{"face", surface.triangle_count()};
  io::PlyProperty indices{"vertex_indices", Type::uint32, true};
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    indices.values.push_back(surface.render_vertices[surface.triangles[i]].welded);
    if (i % 3 == 2) indices.ends.push_back(i + 1);
  }
  face.properties.push_back(std::move(indices));
  io::write_ply(path, {{"plisse: painted wrinkles, welded vertices of the rest pose, metres, y up"},
                       {std::move(vertex), std::move(face)}});
}

std::vector<glm::dvec3> read_bias_ply(const std::filesystem::path& path, const Surface& surface) {
  const std::string file = path.string();
  const auto bad = [&](const std::string& what) {
    return Error(ExitCode::bad_input, fmt::format("{}: {}", file, what));
  };
  const io::Ply ply = io::read_ply(path);
  const io::PlyElement* vertex = ply.find("vertex");
  if (!vertex) throw bad("has no element 'vertex'");
  if (vertex->count != surface.vertex_count()) {
    throw bad(fmt::format("has {} vertices, the model has {} welded ones; paint it anew for this model",
                          vertex->count, surface.vertex_count()));
  }
  const auto vectors = [&](const std::string& prefix) {
    std::vector<glm::dvec3> result(vertex->count);
    const char* const axes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
      const auto& values = io::ply_values(*vertex, {prefix + axes[i]}, file);
      for (std::size_t v = 0; v < result.size(); ++v) result[v][i] = values[v];
    }
    return result;
  };
  const std::vector<glm::dvec3> positions = vectors(""), bias = vectors("bias_");
  // A hundred times what makes two vertices one: a file may have been through a program with single
  // precision.
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
  return bias;
}

}  // namespace plisse::paint
