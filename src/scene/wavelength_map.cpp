#include "scene/wavelength_map.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "io/picture/image.h"
#include "io/ply.h"
#include "mesh/place_index.h"
#include "mesh/weld.h"

namespace plisse::scene {
namespace {

Error bad(const std::filesystem::path& path, const std::string& what) {
  return {ExitCode::bad_input, fmt::format("{}: {}", path.string(), what)};
}

std::vector<double> by_vertex(const Surface& surface, const std::filesystem::path& path,
                              const glm::dmat4& to_world) {
  const io::Ply ply = io::read_ply(path, {"x", "y", "z", "wavelength"});
  std::vector<glm::dvec3> places = ply.vectors("vertex");
  const std::vector<double>& lengths = ply.numbers("vertex", {"wavelength"});
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = glm::dvec3(to_world * glm::dvec4(places[i], 1));
    if (!(lengths[i] > 0))
      throw bad(path,
                fmt::format("vertex {}: the wavelength is {:g}; it has to be more than 0", i, lengths[i]));
  }
  const PlaceIndex index(places);
  const double metres = glm::length(glm::dvec3(to_world[0])), tolerance = 100 * weld_tolerance(surface.rest);
  std::vector<double> result;
  std::size_t missing = 0;
  for (const glm::dvec3& at : surface.rest) {
    const auto found = index.nearest(at, tolerance);
    missing += found ? 0 : 1;
    result.push_back(found ? metres * lengths[*found] : 1);
  }
  if (missing > 0) {
    throw bad(path,
              fmt::format("{} of the model's {} welded vertices are not among its {}; it has to be over "
                          "the rest pose, in the model's own unit and axes",
                          missing, surface.vertex_count(), places.size()));
  }
  return result;
}

std::vector<double> by_picture(const Surface& surface, const config::WrinkleSettings& settings) {
  const double high = settings.wavelength,
               low = settings.wavelength_low > 0 ? settings.wavelength_low : 0.5 * high;
  const io::Image image = io::load_image(settings.wavelength_map);
  std::vector<double> sum(surface.vertex_count(), 0);
  std::vector<int> count(surface.vertex_count(), 0);
  for (const Part& part : surface.parts) {
    if (!part.has_uv) continue;
    for (std::size_t i = 3 * std::size_t{part.first_triangle};
         i < 3 * (std::size_t{part.first_triangle} + part.triangle_count); ++i) {
      const RenderVertex& vertex = surface.render_vertices[surface.triangles[i]];
      sum[vertex.welded] += io::amount_at(image, glm::dvec2(vertex.uv));
      ++count[vertex.welded];
    }
  }
  bool any = false;
  for (std::size_t v = 0; v < sum.size(); ++v) {
    any = any || count[v] > 0;
    sum[v] = count[v] > 0 ? low + (high - low) * sum[v] / count[v] : high;
  }
  if (!any) throw bad(settings.wavelength_map, "is a picture in uv, but the model has no uv");
  return sum;
}

}  // namespace

void take_wavelengths(const Surface& surface, const config::WrinkleSettings& settings,
                      const glm::dmat4& to_world, VertexWaves& waves) {
  const std::filesystem::path& map = settings.wavelength_map;
  const std::vector<double> wanted = lower_case(map.extension().string()) == ".ply"
                                         ? by_vertex(surface, map, to_world)
                                         : by_picture(surface, settings);
  for (std::size_t v = 0; v < wanted.size(); ++v) waves.wavelength[v] *= wanted[v] / settings.wavelength;
}

}  // namespace plisse::scene
