// plisse bake: the wrinkles of a frame as maps in the model's own uv, for use on the coarse mesh.
#include "pipeline/bake.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "base/eigen_glm.h"
#include "base/error.h"
#include "base/log.h"
#include "base/message_scope.h"
#include "config/frames.h"
#include "io/picture/exr.h"
#include "io/picture/png.h"
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

// The tangent basis of the mesh that the maps are for, at each texel: of the model's own mesh, also where its
// surface is drawn smooth.
class Basis {
 public:
  Basis(const pipeline::ReferenceScene& reference, const UvRaster& raster)
      : reference_(reference), raster_(raster), vertices_(tangent_vertices(reference.scene.surface())) {}

  void take(const std::vector<reference::Triangle>& triangles) {
    tangents_ = mikktspace(corners(triangles));
    normals_.clear();
    places_.clear();
    for (const reference::Triangle& triangle : triangles) {
      normals_.push_back(triangle.normals);
      places_.push_back(triangle.waves.corners);
    }
  }

  // The point of the mesh at a texel, and its normal; none on an island's rim.
  struct Point {
    Eigen::Vector3d place, normal;
  };
  std::optional<Point> at(std::size_t texel) const {
    if (raster_.triangle[texel] == UvRaster::none) return std::nullopt;
    const auto t = static_cast<std::size_t>(raster_.triangle[texel]);
    const glm::dvec3& b = raster_.barycentric[texel];
    const Eigen::Vector3d weights(b.x, b.y, b.z);
    return Point{places_[t] * weights, (normals_[t] * weights).normalized()};
  }

  // The components of a normal for which a renderer computes it: it interpolates tangent and normal without
  // normalising them.
  glm::dvec3 components(const glm::dvec3& normal, std::size_t texel) const {
    // Rounding may leave a texel on an island's rim out.
    const std::int64_t from =
        raster_.triangle[texel] == UvRaster::none ? raster_.source[texel] : static_cast<std::int64_t>(texel);
    if (from == UvRaster::none) return {0, 0, 1};
    const auto t = static_cast<std::size_t>(raster_.triangle[static_cast<std::size_t>(from)]);
    const glm::dvec3 b = raster_.barycentric[static_cast<std::size_t>(from)];
    const CornerTangent* corner = &tangents_[3 * t];
    const glm::dvec3 tangent = b.x * corner[0].tangent + b.y * corner[1].tangent + b.z * corner[2].tangent;
    const glm::dvec3 n = to_glm(normals_[t] * Eigen::Vector3d(b.x, b.y, b.z));
    const glm::dmat3 basis(tangent, corner[0].sign * glm::cross(n, tangent), n);
    if (!(std::abs(glm::determinant(basis)) > 1e-9)) return {0, 0, 1};
    glm::dvec3 m = glm::inverse(basis) * normal;
    m.z = std::max(m.z, 0.0);  // a normal map has no normals that point inward
    const double length = glm::length(m);
    return length > 0 ? m / length : glm::dvec3(0, 0, 1);
  }

 private:
  std::vector<TangentCorner> corners(const std::vector<reference::Triangle>& triangles) const {
    const Surface& surface = reference_.scene.surface();
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

  const pipeline::ReferenceScene& reference_;
  const UvRaster& raster_;
  std::vector<std::uint32_t> vertices_;
  std::vector<CornerTangent> tangents_;            // of the frame, a corner
  std::vector<Eigen::Matrix3d> normals_, places_;  // of each triangle's corners
};

// The triangles of a surface beside each other.
class Neighbours {
 public:
  explicit Neighbours(const Surface& surface) : across_(surface.triangle_count(), {none, none, none}) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::uint32_t>> open;
    for (std::uint32_t t = 0; t < surface.triangle_count(); ++t)
      for (std::uint32_t c = 0; c < 3; ++c) {
        const auto id = [&](std::uint32_t k) {
          return surface.render_vertices[surface.triangles[3 * t + k % 3]].welded;
        };
        const auto side = std::minmax(id(c + 1), id(c + 2));
        const auto [entry, fresh] = open.try_emplace(side, t, c);
        if (fresh) continue;
        across_[t][c] = entry->second.first;
        across_[entry->second.first][entry->second.second] = t;
      }
  }
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  // Across the side opposite to a corner.
  std::uint32_t across(std::size_t triangle, std::size_t corner) const { return across_[triangle][corner]; }

 private:
  std::vector<std::array<std::uint32_t, 3>> across_;
};

// A place on a surface: a triangle, and weights of its corners.
struct OnSurface {
  std::size_t triangle = 0;
  Eigen::Vector3d weights;
};

// Where a line through a point, along its normal, meets a surface, as a walk from triangle to triangle finds
// it: a smooth surface and the mesh that it is of do not lie over each other corner by corner. `start` where
// the walk does not end, as in folds.
OnSurface below(const Basis::Point& point, const OnSurface& start,
                const std::vector<reference::Triangle>& triangles, const Neighbours& neighbours) {
  constexpr int most_steps = 32;  // a mesh's triangle has sixteen of the surface
  const Eigen::Vector3d t = point.normal.unitOrthogonal(), b = point.normal.cross(t);
  OnSurface at = start;
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::Matrix3d& corners = triangles[at.triangle].waves.corners;
    Eigen::Matrix3d flat;  // in the plane across the line
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d from = corners.col(c) - point.place;
      flat.col(c) = Eigen::Vector3d(t.dot(from), b.dot(from), 1);
    }
    const double area = flat.determinant();
    if (!(area > 0)) return start;
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector2d u = flat.col((c + 1) % 3).head<2>(), v = flat.col((c + 2) % 3).head<2>();
      at.weights[c] = (u.x() * v.y() - u.y() * v.x()) / area;
    }
    Eigen::Index least = 0;
    if (at.weights.minCoeff(&least) >= 0) return at;
    const std::uint32_t next = neighbours.across(at.triangle, static_cast<std::size_t>(least));
    if (next == Neighbours::none) {  // beyond the hem
      at.weights = at.weights.cwiseMax(0);
      at.weights /= at.weights.sum();
      return at;
    }
    at.triangle = next;
  }
  return start;
}

// The model's own mesh in a scene whose surface is drawn smooth.
struct OwnMesh {
  OwnMesh(const BakeRequest& request, const UvRaster& like)
      : scene(request.scene, request.memory, 0),
        reference(scene),
        raster(uv_raster(scene.surface(), like.size, widened)) {}

  // Its triangles in a frame, without waves; frames in order.
  std::vector<reference::Triangle> at(int frame) {
    const int step = scene.step_of_frame(frame);
    pipeline::WaveSnapshot still;
    const scene::Pose& pose = scene.pose(step);
    still.positions = reference.positions(pose);
    still.frames = reference.frames(pose, still.positions);
    scene.drop_poses_before(step);
    const Eigen::Index count = still.positions.cols();
    still.wavenumbers.setZero(2, count);
    for (auto* values : {&still.heights, &still.weights, &still.phases, &still.compression})
      values->setZero(count);
    still.states.resize(static_cast<std::size_t>(count));
    return pipeline::reference_triangles(reference, still);
  }

  pipeline::LoadedScene scene;
  pipeline::ReferenceScene reference;
  UvRaster raster;
};

class Baker {
 public:
  Baker(const BakeRequest& request, const pipeline::LoadedScene& scene)
      : scene_(scene),
        reference_(scene),
        profile_(pipeline::reference_profile(scene)),
        raster_(uv_raster(scene.surface(), request.texture_size, widened)) {
    if (scene.smooth_levels() > 0) {
      const log::Scope unheard(log::Sink{});  // the scene has told it all
      own_ = std::make_unique<OwnMesh>(request, raster_);
      neighbours_.emplace(scene.surface());
    }
    basis_ = std::make_unique<Basis>(own_ ? own_->reference : reference_, own_ ? own_->raster : raster_);
  }

  const UvRaster& raster() const { return raster_; }

  // One per texel of the raster; texels outside all islands stay flat.
  // Points that a body stops are on it (`outside`: posed, or null).
  std::vector<Texel> at(int frame, const pipeline::WaveSnapshot& snapshot, const pipeline::Outside* outside) {
    const auto triangles = pipeline::reference_triangles(reference_, snapshot);
    basis_->take(own_ ? own_->at(frame) : triangles);
    const auto blend = scene_.settings.shading.blend == config::Blend::smooth ? reference::Blend::smooth
                                                                              : reference::Blend::linear;
    std::vector<Texel> texels(raster_.triangle.size());
    tbb::parallel_for(std::size_t{0}, texels.size(), [&](std::size_t i) {
      if (raster_.triangle[i] == UvRaster::none) return;
      const glm::dvec3 own = raster_.barycentric[i];
      OnSurface on{static_cast<std::size_t>(raster_.triangle[i]), {own.x, own.y, own.z}};
      if (own_)
        if (const auto point = basis_->at(i)) on = below(*point, on, triangles, *neighbours_);
      const std::size_t t = on.triangle;
      const reference::Triangle& triangle = triangles[t];
      Eigen::Matrix3d directions;
      for (int c = 0; c < 3; ++c)
        directions.col(c) = snapshot.frames.normal.col(
            static_cast<Eigen::Index>(triangle.welded[static_cast<std::size_t>(c)]));
      const glm::dvec3 b = to_glm(on.weights);
      const auto point = reference::displace(triangle, directions, on.weights, profile_, blend, 0);
      const bool held = outside && !outside->owns(t);
      const double share = held ? outside->free_share(to_glm(point.base), to_glm(point.position)) : 1;
      const glm::dvec3 normal =
          share < 1 ? lying(*outside, point, share, triangle.normals, b) : to_glm(point.normal);
      texels[i] = {share * point.height * scene_.units.metres, basis_->components(normal, i)};
    });
    return texels;
  }

 private:
  // The normal of cloth that was stopped: the body's, or the cloth's without waves where it did not move at
  // all.
  static glm::dvec3 lying(const pipeline::Outside& outside, const reference::Displaced& point, double share,
                          const Eigen::Matrix3d& normals, const glm::dvec3& b) {
    const glm::dvec3 own = to_glm(normals * Eigen::Vector3d(b.x, b.y, b.z));
    if (!(share > 0)) return own;
    const glm::dvec3 out = outside.normal_near(glm::mix(to_glm(point.base), to_glm(point.position), share));
    return glm::dot(out, own) < 0 ? -out : out;
  }

  const pipeline::LoadedScene& scene_;
  pipeline::ReferenceScene reference_;
  reference::Profile profile_;
  UvRaster raster_;
  std::unique_ptr<OwnMesh> own_;  // where it is not what is drawn
  std::optional<Neighbours> neighbours_;
  std::unique_ptr<Basis> basis_;
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

void check(const BakeRequest& request) {
  check_request(request);
  const log::Scope unheard(log::Sink{});  // the run itself tells
  const pipeline::LoadedScene scene(request.scene, request.memory, 0);
  config::select_frames(scene.settings.model.frames, scene.animation.timeline().frame_count);
  constexpr int small = 64;  // texels a side: nothing is kept of it
  uv_raster(scene.surface(), small, widened);
}

BakeReport bake_maps(const BakeRequest& request, const FrameCallback& on_frame) {
  const double started = wall_seconds();
  check_request(request);
  pipeline::LoadedScene scene(request.scene, request.memory);
  const auto frames =
      config::select_frames(scene.settings.model.frames, scene.animation.timeline().frame_count);
  Baker baker(request, scene);
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
        const std::vector<Texel> texels = baker.at(frame, snapshot, outside ? &*outside : nullptr);
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
