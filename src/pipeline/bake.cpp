// plisse bake: the wrinkles of a frame as maps in the model's own uv, for use on the coarse mesh.
#include "pipeline/bake.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "base/clock.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/log.h"
#include "config/frames.h"
#include "io/exr.h"
#include "io/png.h"
#include "mesh/tangents.h"
#include "mesh/uv_raster.h"
#include "pipeline/outside.h"
#include "pipeline/reference_scene.h"
#include "pipeline/render.h"
#include "pipeline/visit_frames.h"
#include "reference/displacement.h"

namespace plisse::pipeline {
namespace {

constexpr int widened = 16;  // texels: four levels of mip maps

// The values of the maps at one texel.
struct Texel {
  double height = 0;           // metres
  glm::dvec3 normal{0, 0, 1};  // in the tangent basis, unit
};

// One number for render vertices with the same position, normal and uv: MikkTSpace treats them as one vertex.
std::vector<std::uint32_t> tangent_vertices(const Surface& surface) {
  using Key = std::pair<std::uint32_t, std::array<float, 5>>;
  std::map<Key, std::uint32_t> numbers;
  std::vector<std::uint32_t> of;
  for (const RenderVertex& v : surface.render_vertices) {
    const Key key{v.welded, {v.normal.x, v.normal.y, v.normal.z, v.uv.x, v.uv.y}};
    of.push_back(numbers.try_emplace(key, static_cast<std::uint32_t>(numbers.size())).first->second);
  }
  return of;
}

class Baker {
 public:
  Baker(const pipeline::LoadedScene& scene, int size)
      : scene_(scene),
        reference_(scene),
        profile_(pipeline::reference_profile(scene)),
        raster_(uv_raster(scene.surface(), size, widened)),
        vertices_(tangent_vertices(scene.surface())) {}

  const UvRaster& raster() const { return raster_; }

  // One per texel of the raster; texels outside all islands stay flat.
  // Points that a body stops are on it (`outside`: posed, or null).
  std::vector<Texel> at(const pipeline::WaveSnapshot& snapshot, const pipeline::Outside* outside) const {
    const auto triangles = pipeline::reference_triangles(reference_, snapshot);
    const std::vector<CornerTangent> tangents = mikktspace(corners(triangles));
    const auto blend = scene_.settings.shading.blend == config::Blend::smooth ? reference::Blend::smooth
                                                                              : reference::Blend::linear;
    std::vector<Texel> texels(raster_.triangle.size());
    tbb::parallel_for(std::size_t{0}, texels.size(), [&](std::size_t i) {
      if (raster_.triangle[i] == UvRaster::none) return;
      const auto t = static_cast<std::size_t>(raster_.triangle[i]);
      const reference::Triangle& triangle = triangles[t];
      Eigen::Matrix3d directions;
      for (int c = 0; c < 3; ++c)
        directions.col(c) = snapshot.frames.normal.col(
            static_cast<Eigen::Index>(triangle.welded[static_cast<std::size_t>(c)]));
      const glm::dvec3 b = raster_.barycentric[i];
      const auto point = reference::displace(triangle, directions, {b.x, b.y, b.z}, profile_, blend, 0);
      const bool held = outside && !outside->owns(t);
      const double share = held ? outside->free_share(to_glm(point.base), to_glm(point.position)) : 1;
      const glm::dvec3 normal =
          share < 1 ? lying(*outside, point, share, triangle.normals, b) : to_glm(point.normal);
      texels[i] = {share * point.height * scene_.units.metres,
                   in_basis(normal, &tangents[3 * t], triangle.normals, b)};
    });
    return texels;
  }

 private:
  std::vector<TangentCorner> corners(const std::vector<reference::Triangle>& triangles) const {
    const Surface& surface = scene_.surface();
    std::vector<TangentCorner> result;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t id = surface.triangles[3 * t + static_cast<std::size_t>(c)];
        result.push_back({vertices_[id], to_glm(triangles[t].waves.corners.col(c)),
                          to_glm(triangles[t].normals.col(c)), glm::dvec2(surface.render_vertices[id].uv)});
      }
    }
    return result;
  }

  // The normal of cloth that was stopped: the body's, or the cloth's without waves where it did not move at
  // all.
  static glm::dvec3 lying(const pipeline::Outside& outside, const reference::Displaced& point, double share,
                          const Eigen::Matrix3d& normals, const glm::dvec3& b) {
    const glm::dvec3 own = to_glm(normals * Eigen::Vector3d(b.x, b.y, b.z));
    if (!(share > 0)) return own;
    const glm::dvec3 out = outside.normal_near(glm::mix(to_glm(point.base), to_glm(point.position), share));
    return glm::dot(out, own) < 0 ? -out : out;
  }

  // The components for which a renderer computes this normal: it interpolates tangent and normal without
  // normalising them.
  static glm::dvec3 in_basis(const glm::dvec3& normal, const CornerTangent* corner,
                             const Eigen::Matrix3d& normals, const glm::dvec3& b) {
    const glm::dvec3 tangent = b.x * corner[0].tangent + b.y * corner[1].tangent + b.z * corner[2].tangent;
    const glm::dvec3 n = to_glm(normals * Eigen::Vector3d(b.x, b.y, b.z));
    const glm::dmat3 basis(tangent, corner[0].sign * glm::cross(n, tangent), n);
    if (!(std::abs(glm::determinant(basis)) > 1e-9)) return {0, 0, 1};
    glm::dvec3 m = glm::inverse(basis) * normal;
    m.z = std::max(m.z, 0.0);  // a normal map has no normals that point inward
    const double length = glm::length(m);
    return length > 0 ? m / length : glm::dvec3(0, 0, 1);
  }

  const pipeline::LoadedScene& scene_;
  pipeline::ReferenceScene reference_;
  reference::Profile profile_;
  UvRaster raster_;
  std::vector<std::uint32_t> vertices_;
};

// The largest height that is possible in any frame, metres: white of the viewable map, and black its
// negative.
double largest_height(const pipeline::LoadedScene& scene) {
  double waves = 0, field = 0;
  for (std::size_t v = 0; v < scene.waves.wavelength.size(); ++v)
    waves = std::max(waves, scene.waves.mask[v] * scene.waves.wavelength[v] / 4);
  scene.visit_fields([&](const std::vector<FieldTriangle>& of_frame) {
    for (const FieldTriangle& triangle : of_frame)
      for (const double a : triangle.amplitude) field = std::max(field, a);
  });
  return (scene.profile.coarse + scene.profile.fine) * waves + field;
}

// The maps' texels, islands widened; `value` gives what a map has of one.
template <typename Value>
auto map_of(const UvRaster& raster, const std::vector<Texel>& texels, const Value& value) {
  std::vector<decltype(value(Texel{}))> values;
  values.reserve(texels.size());
  for (const std::int64_t source : raster.source)
    values.push_back(value(source == UvRaster::none ? Texel{} : texels[static_cast<std::size_t>(source)]));
  return values;
}

std::uint8_t byte(double x) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
}

// A picture of the maps' texels; `shown` gives 0…1.
template <typename Shown>
io::Image picture(const UvRaster& raster, const std::vector<Texel>& texels, const Shown& shown) {
  io::Image image{raster.size, raster.size, {}};
  image.rgba.reserve(4 * texels.size());
  for (const glm::dvec3& value : map_of(raster, texels, shown)) {
    image.rgba.insert(image.rgba.end(), {byte(value.x), byte(value.y), byte(value.z), 255});
  }
  return image;
}

void check_request(const BakeRequest& request) {
  if (request.output.empty() && !request.on_maps)
    throw Error(ExitCode::bad_input, "plisse bake: name the folder with -o");
  if (!request.height && !request.normal)
    throw Error(ExitCode::bad_input, "--maps: none named; there are: height, normal");
}

}  // namespace

BakeReport bake_maps(const BakeRequest& request, const FrameCallback& on_frame) {
  const double started = wall_seconds();
  check_request(request);
  pipeline::LoadedScene scene(request.scene, request.memory, 0);  // the map is for the mesh as it is
  const auto frames =
      config::select_frames(scene.settings.model.frames, scene.animation.timeline().frame_count);
  const Baker baker(scene, request.texture_size);
  std::optional<pipeline::Outside> outside;
  if (!request.outside.empty()) outside.emplace(scene, request.outside);
  const UvRaster& raster = baker.raster();
  BakeReport report;
  report.scale_m = largest_height(scene);
  report.corner = raster.corner;
  report.side = raster.side;
  if (raster.side > 1 || raster.corner != glm::dvec2(0)) {
    log::notice(
        fmt::format("uv leaves 0…1; the maps cover {0}×{0} tiles from ({1:g}, {2:g}) on: look them up at "
                    "((u − {1:g})/{0}, (v − {2:g})/{0})",
                    raster.side, raster.corner.x, raster.corner.y));
  }
  report.covered = raster.covered;
  report.overlapping = raster.overlapping;
  if (raster.overlapping > 0) {
    log::warn(fmt::format(
        "{:.1f} % of the texels with cloth belong to several places of it, whose wrinkles differ; "
        "the map has the first one's",
        100.0 * static_cast<double>(raster.overlapping) / static_cast<double>(raster.covered)));
  }
  const double scale = std::max(report.scale_m, 1e-30), green = request.green_up ? 1 : -1;
  const std::filesystem::path folder = request.output;
  report.interrupted = !pipeline::visit_frames(
      scene, frames, {request.device, request.shader_folder}, on_frame,
      [&](int frame, const passes::SurfaceBuffers& surface) {
        const pipeline::WaveSnapshot snapshot = pipeline::read_snapshot(surface);
        if (outside) outside->take(frame, points_to_glm(snapshot.positions));
        const std::vector<Texel> texels = baker.at(snapshot, outside ? &*outside : nullptr);
        const auto metres = [](const Texel& texel) { return static_cast<float>(texel.height); };
        const auto normal = [&](const Texel& texel) {
          return glm::dvec3(texel.normal.x, green * texel.normal.y, texel.normal.z);
        };
        if (request.on_maps) {
          request.on_maps({frame, raster.size, raster.corner, raster.side, map_of(raster, texels, metres),
                           map_of(raster, texels, normal)});
          return std::string();
        }
        const auto path = [&](const char* kind, const char* ending) {
          const auto named = folder / fmt::format("{}_{:04}{}", kind, frame, ending);
          report.outputs.push_back({named.string(), kind, frame});
          return named;
        };
        if (request.height) {
          io::write_exr(path("height", ".exr"), raster.size, raster.size, 1, map_of(raster, texels, metres));
          io::write_png(path("height", ".png"), picture(raster, texels, [&](const Texel& texel) {
                          return glm::dvec3(0.5 + 0.5 * texel.height / scale);
                        }));
        }
        if (request.normal) {
          io::write_png(path("normal", ".png"), picture(raster, texels, [&](const Texel& texel) {
                          return 0.5 + 0.5 * normal(texel);
                        }));
        }
        return folder.string();
      });
  report.wall_s = wall_seconds() - started;
  return report;
}

}  // namespace plisse::pipeline
