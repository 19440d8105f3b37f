#include "pipeline/verify_displacement.h"
#include "pipeline/look.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace plisse::pipeline {
namespace {

// So there are points at corners, on edges and inside triangles, with many phases.
constexpr int most_levels_compared = 2;
constexpr std::size_t most_points = 4'000'000;  // 64 MB a list: drivers grant 128

int levels_compared(const Surface& surface) {
  int levels = most_levels_compared;
  const auto points = [&] {
    return (std::size_t{1} << levels) * ((std::size_t{1} << levels) + 1) * surface.triangle_count();
  };
  while (levels > 0 && points() > most_points) --levels;
  return levels;
}

// --- tolerances, and why ---------------------------------------------------------------------------------
// A position is a sum of a few products in single precision, for positions within one unit of the origin. The
// phase of its wave has an error of 1e-6 of the turns between corner and point, of which there may be ten and
// more on long triangles.
constexpr double place_tolerance = 1e-6;   // of the bounding box
constexpr double relief_tolerance = 1e-4;  // of the amplitude, or of the sky
// Gradients of barycentric coordinates lose digits by cancellation in slender triangles, and second
// derivatives of the waves add to the error. Where the displaced surface turns over, or a triangle is
// upright, either of two results is right.
constexpr double normal_tolerance = 1e-3;  // of a unit vector
constexpr double fraction = 0.999;

}  // namespace

DisplacementComparison::DisplacementComparison(const LoadedScene& scene, const std::string& shader_folder)
    : scene_(scene),
      displacement_(scene, subdivide(scene.surface(), 1 << levels_compared(scene.surface()))),
      buffers_(scene.surface(), displacement_.mesh()),
      pass_(displacement_.mesh(), scene.profile, scene.settings.shading.blend == config::Blend::smooth,
            look_of(scene).field, scene.settings.shading.cavity, shader_folder),
      place_(place_tolerance, "of the bounding box"),
      relief_(relief_tolerance, "of the amplitude", fraction),
      normal_(normal_tolerance, "of a unit vector", fraction) {}

void DisplacementComparison::compare(const passes::SurfaceBuffers& surface, const WaveSnapshot& gpu) {
  pass_.run(surface, buffers_);
  const DisplacedSurface expected = displacement_.at(gpu);
  const auto places = buffers_.positions.read<glm::vec4>(), relief = buffers_.relief.read<glm::vec4>(),
             vertices = buffers_.render_vertices.read<glm::vec4>();  // two each, the normal first
  const double box = (gpu.positions.rowwise().maxCoeff() - gpu.positions.rowwise().minCoeff()).norm();
  std::vector<char> moved(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    place_.add(glm::distance(glm::dvec3(places[i]), expected.positions[i]) / std::max(box, 1e-30));
    const glm::dvec4 error = glm::dvec4(relief[i]) - expected.relief[i];
    const double amplitude = expected.relief[i].y;
    moved[i] = amplitude > 0;
    if (!moved[i]) continue;
    relief_.add(std::max({std::abs(error.x) / amplitude, std::abs(error.y) / amplitude, std::abs(error.z),
                          std::abs(error.w)}));
  }
  const Subdivision& mesh = displacement_.mesh();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (moved[mesh.vertices[v].position])
      normal_.add(glm::distance(glm::dvec3(vertices[2 * v]), expected.normals[mesh.vertices[v].normal]));
  }
}

void DisplacementComparison::report(std::map<std::string, PassComparison>& passes) const {
  passes["displacement"] = place_.comparison();
  passes["displacement.relief"] = relief_.comparison();
  passes["displacement.normal"] = normal_.comparison();
}

}  // namespace plisse::pipeline
