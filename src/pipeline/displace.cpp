#include "pipeline/displace.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/log.h"
#include "mesh/subdivide.h"
#include "reference/displacement.h"

namespace plisse::pipeline {
namespace {

using Eigen::Index;

constexpr double most_triangles = 4e6;

// The most waves on each edge of the welded surface.
class EdgeWaves {
 public:
  // Compression does not change the number of waves, so it follows from the rest pose; but the bias gathers
  // cloth at rest already.
  explicit EdgeWaves(const LoadedScene& scene) {
    const Surface& surface = scene.surface();
    const VertexWaves& waves = scene.waves;
    const auto length_of_wave = [&](std::size_t v) {
      const glm::dvec3 p = waves.bias.empty() ? glm::dvec3(0) : waves.bias[v];
      return waves.wavelength[v] * (1 - glm::dot(p, p)) / std::max(1, scene.profile.fine_waves);
    };
    for (std::uint32_t v = 0; v < surface.vertex_count(); ++v) {
      for (std::uint32_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i) {
        const std::uint32_t other = surface.neighbours.items[i];
        if (!(std::max(waves.mask[v], waves.mask[other]) > 0)) continue;
        const double length = glm::distance(surface.rest[v], surface.rest[other]);
        add(v, other, length / std::min(length_of_wave(v), length_of_wave(other)));
      }
    }
    std::vector<std::array<double, 3>> on_sides(surface.triangle_count(), {0, 0, 0});  // in any frame
    scene.visit_fields([&](const std::vector<FieldTriangle>& field) {
      for (std::size_t t = 0; t < field.size(); ++t) {
        if (*std::ranges::max_element(field[t].amplitude) == 0) continue;
        for (const auto& turns : field[t].turns)
          for (std::size_t c = 0; c < 3; ++c)
            on_sides[t][c] = std::max(on_sides[t][c], std::abs(turns[(c + 1) % 3] - turns[c]));
      }
    });
    for (std::size_t t = 0; t < on_sides.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto welded = [&](std::size_t k) {
          return surface.render_vertices[surface.triangles[3 * t + k % 3]].welded;
        };
        if (on_sides[t][c] > 0) add(welded(c), welded(c + 1), on_sides[t][c]);
      }
  }
  double on(std::uint32_t a, std::uint32_t b) const {
    const auto found = most_.find(key(a, b));
    return found == most_.end() ? 0 : found->second;
  }
  double most() const {
    double most = 0;
    for (const auto& [edge, waves] : most_) most = std::max(most, waves);
    return most;
  }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
  }
  void add(std::uint32_t a, std::uint32_t b, double waves) {
    double& most = most_[key(a, b)];
    most = std::max(most, waves);
  }
  std::unordered_map<std::uint64_t, double> most_;
};

// The largest number of pixels that a length of one metre at rest may have in the scene's pictures: at the
// shortest distance of the clip's bounds from the eye, and stretched by half.
double most_pixels_a_metre(const LoadedScene& scene) {
  const auto& output = scene.settings.output;
  const int frames = scene.settings.camera.name.empty() ? 1 : scene.animation.timeline().frame_count;
  double most = 0;
  for (int frame = 1; frame <= frames; ++frame) {
    const passes::View view = scene.view(frame);
    const glm::dmat4 rows = glm::transpose(view.view_projection);
    const double nearest = glm::dot(rows[3], glm::dvec4(view.bounds_centre, 1)) -
                           view.bounds_radius * glm::length(glm::dvec3(rows[3]));
    const double across = std::max(output.width * glm::length(glm::dvec3(rows[0])),
                                   output.height * glm::length(glm::dvec3(rows[1])));
    most = std::max(most, 0.5 * across / std::max(nearest, 1e-3 * view.bounds_radius));
  }
  return 1.5 * most / scene.units.metres;
}

}  // namespace

int levels_for(const LoadedScene& scene) {
  return scene.smooth_levels() +
         plisse::levels_for(EdgeWaves(scene).most(), scene.surface().triangle_count(), most_triangles);
}

Subdivision split_as_needed(const LoadedScene& scene) {
  const Surface& surface = scene.surface();
  const EdgeWaves waves(scene);
  const double pixels = most_pixels_a_metre(scene);
  const auto wanted = [&](std::uint32_t a, std::uint32_t b) {
    const double visible = pixels * glm::distance(surface.rest[a], surface.rest[b]);
    return halvings(std::min(segments_per_wave * waves.on(a, b), visible));
  };
  std::vector<std::size_t> triangles(most_levels + 1, 0);  // by their finest edge
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    int finest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto welded = [&](std::size_t k) {
        return surface.render_vertices[surface.triangles[3 * t + k % 3]].welded;
      };
      finest = std::max(finest, wanted(welded(c), welded(c + 1)));
    }
    ++triangles[static_cast<std::size_t>(finest)];
  }
  int fewer = 0;
  const auto small_triangles = [&] {
    double sum = 0;
    for (int level = 0; level <= most_levels; ++level)
      sum += static_cast<double>(triangles[static_cast<std::size_t>(level)]) *
             std::exp2(2 * std::max(level - fewer, 0));
    return sum;
  };
  while (fewer < most_levels && small_triangles() > most_triangles) ++fewer;
  if (fewer > 0) {
    log::warn(fmt::format(
        "edges are halved up to {} times less often than the waves need: there would be more than {:.0f} "
        "triangles",
        fewer, most_triangles));
  }
  return subdivide(surface,
                   [&](std::uint32_t a, std::uint32_t b) { return 1 << std::max(wanted(a, b) - fewer, 0); });
}

Displacement::Displacement(const LoadedScene& scene, Subdivision mesh)
    : scene_(scene), reference_(scene), profile_(reference_profile(scene)), mesh_(std::move(mesh)) {}

DisplacedSurface Displacement::at(const WaveSnapshot& snapshot) const {
  const auto triangles = reference_triangles(reference_, snapshot);
  const auto& shading = scene_.settings.shading;
  const auto blend =
      shading.blend == config::Blend::smooth ? reference::Blend::smooth : reference::Blend::linear;
  std::vector<reference::Displaced> displaced(mesh_.points.size());
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t t) {
    Eigen::Matrix3d directions;
    for (int c = 0; c < 3; ++c)
      directions.col(c) =
          snapshot.frames.normal.col(static_cast<Index>(triangles[t].welded[static_cast<std::size_t>(c)]));
    for (std::uint32_t p = mesh_.first_point[t]; p < mesh_.first_point[t + 1]; ++p) {
      const glm::dvec3 b = mesh_.points[p].barycentric();
      displaced[p] =
          reference::displace(triangles[t], directions, {b.x, b.y, b.z}, profile_, blend, shading.cavity);
    }
  });

  // Adjacent triangles agree in height and position up to rounding, and in the normal where the base is flat;
  // all of them take the mean.
  DisplacedSurface result;
  result.positions.assign(mesh_.position_count, glm::dvec3(0));
  result.base = result.positions;
  result.normals.assign(mesh_.normal_count, glm::dvec3(0));
  result.relief.assign(mesh_.position_count, glm::dvec4(0));
  std::vector<int> counts(mesh_.position_count, 0);
  for (std::size_t i = 0; i < displaced.size(); ++i) {
    const FineVertex vertex = mesh_.vertices[mesh_.points[i].vertex];
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
