#include "pipeline/displace.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/log.h"
#include "pipeline.h"
#include "reference/displacement.h"

namespace plisse::pipeline {
namespace {

using Eigen::Index;

// Straight between them the middle of a crest is a thirteenth of its height too low (1 − cos π/8); normals
// are exact at every vertex.
constexpr double segments_per_wave = 8;
constexpr double most_triangles = 4e6;

glm::dvec3 to_glm(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// The waves on the edge that has most of them. Squeezed cloth keeps its waves, so the rest pose tells; but
// what the bias gathers it gathers at rest.
double most_waves_on_an_edge(const LoadedScene& scene) {
  const Surface& surface = scene.surface();
  const VertexWaves& waves = scene.waves;
  const auto length_of_wave = [&](std::size_t v) {
    const glm::dvec3 p = waves.bias.empty() ? glm::dvec3(0) : waves.bias[v];
    return waves.wavelength[v] * (1 - glm::dot(p, p)) / std::max(1, scene.profile.fine_waves);
  };
  double most = 0;
  for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
    for (std::uint32_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i) {
      const std::uint32_t other = surface.neighbours.items[i];
      if (!(std::max(waves.mask[v], waves.mask[other]) > 0)) continue;
      const double length = glm::distance(surface.rest[v], surface.rest[other]);
      most = std::max(most, length / std::min(length_of_wave(v), length_of_wave(other)));
    }
  }
  scene.visit_fields([&](const std::vector<FieldTriangle>& field) {
    for (const FieldTriangle& triangle : field) {
      if (*std::max_element(triangle.amplitude.begin(), triangle.amplitude.end()) == 0) continue;
      for (const auto& turns : triangle.turns) {
        const auto [low, high] = std::minmax_element(turns.begin(), turns.end());
        most = std::max(most, *high - *low);
      }
    }
  });
  return most;
}

int chosen_levels(const LoadedScene& scene, std::optional<int> given) {
  return given ? *given : levels_for(scene);
}

}  // namespace

int levels_for(const LoadedScene& scene) {
  return levels_for(most_waves_on_an_edge(scene), scene.surface().triangle_count(), most_triangles);
}

int levels_for(double waves, std::size_t triangles, double most) {
  const double segments = segments_per_wave * waves;
  int levels = 0;
  while (levels < most_levels && std::exp2(levels) < segments) ++levels;
  const int wanted = levels;
  while (levels > 0 && static_cast<double>(triangles) * std::exp2(2 * levels) > most) --levels;
  if (levels < wanted || std::exp2(levels) < segments) {
    log::warn(fmt::format(
        "the longest edge has {:.1f} waves; edges are halved {} times, which gives a wave {:.1f} segments "
        "there in place of {:.0f}",
        waves, levels, std::exp2(levels) * segments_per_wave / segments, segments_per_wave));
  }
  return levels;
}

Displacement::Displacement(const LoadedScene& scene, std::optional<int> levels)
    : scene_(scene),
      reference_(scene),
      profile_(reference_profile(scene)),
      levels_(chosen_levels(scene, levels)),
      mesh_(subdivide(scene.surface(), 1 << levels_)) {}

DisplacedSurface Displacement::at(const WaveSnapshot& snapshot) const {
  const auto triangles = reference_triangles(reference_, snapshot);
  const auto& shading = scene_.settings.shading;
  const auto blend = shading.blend == Blend::smooth ? reference::Blend::smooth : reference::Blend::linear;
  const std::size_t points = mesh_.lattice.size();
  std::vector<reference::Displaced> displaced(triangles.size() * points);
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t t) {
    Eigen::Matrix3d directions;
    for (int c = 0; c < 3; ++c)
      directions.col(c) =
          snapshot.frames.normal.col(static_cast<Index>(triangles[t].welded[static_cast<std::size_t>(c)]));
    for (std::size_t p = 0; p < points; ++p) {
      const glm::dvec3 b = mesh_.lattice[p];
      displaced[t * points + p] =
          reference::displace(triangles[t], directions, {b.x, b.y, b.z}, profile_, blend, shading.cavity);
    }
  });

  // Where triangles meet they agree on height and place but for rounding, and on the normal where the base is
  // flat; the mean is for all of them.
  DisplacedSurface result;
  result.positions.assign(mesh_.position_count, glm::dvec3(0));
  result.base = result.positions;
  result.normals.assign(mesh_.normal_count, glm::dvec3(0));
  result.relief.assign(mesh_.position_count, glm::dvec4(0));
  std::vector<int> counts(mesh_.position_count, 0);
  for (std::size_t i = 0; i < displaced.size(); ++i) {
    const FineVertex vertex = mesh_.vertices[mesh_.points[i]];
    const reference::Displaced& point = displaced[i];
    result.positions[vertex.position] += to_glm(point.position);
    result.base[vertex.position] += to_glm(point.base);
    result.normals[vertex.normal] += to_glm(point.normal);
    result.relief[vertex.position] +=
        glm::dvec4(point.height, point.amplitude, point.sky_front, point.sky_back);
    ++counts[vertex.position];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) {  // of no triangle
      const auto v = static_cast<Index>(i);
      if (v < snapshot.positions.cols())
        result.positions[i] = result.base[i] = to_glm(snapshot.positions.col(v));
      continue;
    }
    result.positions[i] /= counts[i];
    result.base[i] /= counts[i];
    result.relief[i] /= counts[i];
    if (!std::isfinite(result.positions[i].x + result.positions[i].y + result.positions[i].z))
      throw Error(ExitCode::check_failed, "a displaced vertex is not finite");
  }
  for (glm::dvec3& normal : result.normals) {
    const double length = glm::length(normal);
    normal = length > 0 && std::isfinite(length) ? normal / length : glm::dvec3(0, 1, 0);
  }
  return result;
}

}  // namespace plisse::pipeline
