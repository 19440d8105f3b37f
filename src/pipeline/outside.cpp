#include "pipeline/outside.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/eigen_glm.h"

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

Outside::Outside(const LoadedScene& scene, const std::string& body)
    : scene_(scene),
      name_(body),
      source_(scene.settings, scene.surface(), scene.animation.timeline(), body, "--outside") {}

shell::TriangleBody Outside::body(int frame, const std::vector<glm::dvec3>& base) {
  scene::MovingBody::Triangles found = source_.at(frame, scene_.surface(), base);
  if (!source_.own())
    for (glm::dvec3& x : found.places) x = scene_.units.world(x);
  return {points_to_eigen(found.places), std::move(found.triangles), "--outside " + name_};
}

void Outside::take(int frame, const std::vector<glm::dvec3>& welded) {
  const bool still = !source_.own() && !moves();
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
  return std::ranges::any_of(source_.parts(), [&](std::size_t p) {
    const Part& part = scene_.surface().parts[p];
    return triangle >= part.first_triangle &&
           triangle < std::size_t{part.first_triangle} + part.triangle_count;
  });
}

void Outside::hold(int frame, const Subdivision& mesh, DisplacedSurface& moved) {
  const std::vector<glm::dvec3>& base = moved.base;
  take(frame, base);

  std::vector<std::uint8_t> own(base.size(), 0), cut(base.size(), 0);  // own: the body's own surface
  for (const std::size_t p : source_.parts()) {
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
