#include "pipeline/outside.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/eigen_glm.h"
#include "base/error.h"
#include "config/frames.h"
#include "config/suggest.h"
#include "io/import.h"
#include "scene/load_model.h"

namespace plisse::pipeline {
namespace {

// For a model with a size of about one unit: far above the rounding of files in single precision, and too
// small to be visible.
constexpr double gap = 2e-6;

// The share of a path from outside before it enters the body: 1 where it does not.
double entry(const shell::TriangleBody& solid, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const auto enters = [&](double share) { return solid.distance(from + share * (to - from)).value <= 0; };
  double outside = 0, inside = solid.tree().first_hit(from, to);
  if (inside <= 1) return inside;
  // By rounding, a path may pass between two triangles.
  if (!enters(1)) return 1;
  inside = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (outside + inside);
    (enters(middle) ? inside : outside) = middle;
  }
  return outside;
}

}  // namespace

Outside::Outside(const LoadedScene& scene, const std::string& body) : scene_(scene), name_(body) {
  const auto& parts = scene.surface().parts;
  std::set<std::string> known;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].mesh == body || parts[p].material_name == body) parts_.push_back(p);
    known.insert({parts[p].mesh, parts[p].material_name});
  }
  if (!parts_.empty()) return;
  known.erase("");
  const std::vector<std::string> names(known.begin(), known.end());
  std::error_code ignored;
  if (!std::filesystem::exists(body, ignored) && !config::names_many_files(body)) {
    throw Error(
        ExitCode::bad_input,
        fmt::format("--outside {}: there is no such file, and the model has no such mesh or material{}; "
                    "it has: {}",
                    body, config::did_you_mean(body, names), fmt::join(names, ", ")));
  }
  io::ImportOptions options = scene::import_options(scene.settings);
  options.cache.clear();
  const scene::Timeline& clip = scene.animation.timeline();
  scene::AnimationChoice choice;
  choice.frames_per_second = clip.frames_per_second;
  choice.limits = scene.settings.limits;
  model_ = io::import_model(body, options);
  animation_.emplace(model_, choice);
  const int frames = animation_->timeline().frame_count;
  if (frames > 1 && frames < clip.frame_count) {
    throw Error(ExitCode::bad_input,
                fmt::format("--outside {}: has {} frames, the clip has {}; a body has one, or as many", body,
                            frames, clip.frame_count));
  }
}

shell::TriangleBody Outside::body(int frame, const std::vector<glm::dvec3>& base) {
  const Surface& surface = animation_ ? animation_->surface() : scene_.surface();
  std::vector<glm::dvec3> positions = base;  // begins with the welded vertices; a part needs only these
  if (animation_) {
    positions = scene::posed(surface, animation_->pose(std::min(frame, animation_->timeline().frame_count)));
    for (glm::dvec3& x : positions) x = scene_.units.world(x);
  }
  // Only the vertices of the body, not those of other parts.
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> number(surface.vertex_count(), none);
  std::vector<glm::dvec3> places;
  std::vector<std::uint32_t> corners;
  for (std::size_t p = 0; p < surface.parts.size(); ++p) {
    const Part& part = surface.parts[p];
    if (!animation_ && std::count(parts_.begin(), parts_.end(), p) == 0) continue;
    for (std::size_t i = 3 * std::size_t{part.first_triangle};
         i < 3 * (std::size_t{part.first_triangle} + part.triangle_count); ++i) {
      const std::uint32_t v = surface.render_vertices[surface.triangles[i]].welded;
      if (number[v] == none) {
        number[v] = static_cast<std::uint32_t>(places.size());
        places.push_back(positions[v]);
      }
      corners.push_back(number[v]);
    }
  }
  std::vector<TriangleTree::Triangle> triangles;
  for (std::size_t t = 0; t < corners.size(); t += 3)
    triangles.push_back({corners[t], corners[t + 1], corners[t + 2]});
  return {points_to_eigen(places), std::move(triangles), "--outside " + name_};
}

void Outside::take(int frame, const std::vector<glm::dvec3>& welded) {
  const bool still = animation_ && !moves();
  if (!still || !body_) body_.emplace(body(frame, welded));
}

double Outside::free_share(const glm::dvec3& base, const glm::dvec3& to) const {
  const double way = glm::distance(base, to);
  if (!(way > 0)) return 1;
  const double above = body_->distance(to_eigen(base)).value;
  if (above > way) return 1;
  if (!(above > 0)) return body_->distance(to_eigen(to)).value < above ? 0 : 1;
  const double share = entry(*body_, to_eigen(base), to_eigen(to));
  return share < 1 ? std::max(0.0, share - gap / way) : 1;
}

glm::dvec3 Outside::normal_near(const glm::dvec3& x) const {
  const Eigen::Vector3d out = body_->distance(to_eigen(x)).first;
  return {out.x(), out.y(), out.z()};
}

bool Outside::owns(std::size_t triangle) const {
  return std::ranges::any_of(parts_, [&](std::size_t p) {
    const Part& part = scene_.surface().parts[p];
    return triangle >= part.first_triangle &&
           triangle < std::size_t{part.first_triangle} + part.triangle_count;
  });
}

void Outside::hold(int frame, const Subdivision& mesh, DisplacedSurface& moved) {
  const std::vector<glm::dvec3>& base = moved.base;
  take(frame, base);

  std::vector<std::uint8_t> own(base.size(), 0), cut(base.size(), 0);  // own: the body's own surface
  for (const std::size_t p : parts_) {
    const Part& part = scene_.surface().parts[p];
    const auto [first, count] = mesh.small_triangles(part.first_triangle, part.triangle_count);
    for (std::size_t i = 3 * std::size_t{first}; i < 3 * (std::size_t{first} + count); ++i)
      own[mesh.vertices[mesh.triangles[i]].position] = 1;
  }
  tbb::parallel_for(std::size_t{0}, base.size(), [&](std::size_t i) {
    glm::dvec3& x = moved.positions[i];
    const double share = own[i] ? 1 : free_share(base[i], x);
    if (share >= 1) return;
    x = glm::mix(base[i], x, share);
    moved.relief[i].x *= share;
    cut[i] = 1;
  });

  std::vector<std::uint8_t> anew(moved.normals.size(), 0);
  for (const FineVertex& v : mesh.vertices)
    if (cut[v.position]) anew[v.normal] = 1;
  std::vector<glm::dvec3> sums(moved.normals.size(), glm::dvec3(0));
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const FineVertex v[3] = {mesh.vertices[mesh.triangles[t]], mesh.vertices[mesh.triangles[t + 1]],
                             mesh.vertices[mesh.triangles[t + 2]]};
    const glm::dvec3 a = moved.positions[v[0].position];
    const glm::dvec3 area =
        glm::cross(moved.positions[v[1].position] - a, moved.positions[v[2].position] - a);
    for (const FineVertex& corner : v)
      if (anew[corner.normal]) sums[corner.normal] += area;
  }
  for (std::size_t n = 0; n < sums.size(); ++n) {
    if (!anew[n] || !(glm::length(sums[n]) > 0)) continue;
    const glm::dvec3 normal = glm::normalize(sums[n]);
    moved.normals[n] = glm::dot(normal, moved.normals[n]) < 0 ? -normal : normal;
  }
}

}  // namespace plisse::pipeline
