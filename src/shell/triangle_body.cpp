#include "shell/triangle_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "shell/statics.h"

namespace plisse::shell {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Triangle = TriangleTree::Triangle;

namespace {

// Outside is where the normals point.
std::vector<Triangle> wound_outward(const Matrix3Xd& points, std::vector<Triangle> triangles,
                                    const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}", name, what));
  };
  if (triangles.empty()) fail("has no faces");
  if (!points.allFinite()) fail("has a vertex that is not finite");
  Topology topology;
  try {
    topology = build_topology(triangles, static_cast<std::size_t>(points.cols()));
  } catch (const Error& error) {
    fail(error.what());
  }
  for (const Edge& edge : topology.edges)
    if (edge.boundary())
      fail(fmt::format("is open at the edge between vertices {} and {}; a body must be closed",
                       edge.vertex[0], edge.vertex[1]));
  const Vector3d middle = points.rowwise().mean();
  const double volume = enclosed_volume(triangles, points.colwise() - middle);
  if (!(std::abs(volume) > 0)) fail("has no inside");
  if (volume < 0)
    for (Triangle& triangle : triangles) std::swap(triangle[1], triangle[2]);
  return triangles;
}

// From the nearest point of a face (`spans` 2), an edge (1, along the unit vector `along`) or a vertex (0).
Distance distance_from(const Vector3d& point, const Vector3d& nearest, int spans, const Vector3d& along,
                       bool curvature) {
  Distance d;
  d.first = point - nearest;
  d.value = d.first.norm();
  if (d.value == 0) return d;
  d.first /= d.value;
  if (!curvature || spans == 2) return d;
  d.second = Matrix3d::Identity() - d.first * d.first.transpose();
  if (spans == 1) d.second -= along * along.transpose();
  d.second /= d.value;
  return d;
}

}  // namespace

TriangleBody::TriangleBody(Matrix3Xd points, std::vector<Triangle> triangles, const std::string& name)
    : tree_(points, wound_outward(points, std::move(triangles), name)) {
  const auto& faces = tree_.triangles();
  const Topology topology = build_topology(faces, static_cast<std::size_t>(points.cols()));
  face_normals_.resize(3, static_cast<Eigen::Index>(faces.size()));
  vertex_normals_.setZero(3, points.cols());
  valence_.setZero(points.cols());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const Matrix3d at = tree_.corners(f);
    face_normals_.col(f) = (at.col(1) - at.col(0)).cross(at.col(2) - at.col(0)).stableNormalized();
    for (int k = 0; k < 3; ++k) {
      const Vector3d ahead = at.col((k + 1) % 3) - at.col(k), back = at.col((k + 2) % 3) - at.col(k);
      const double angle = std::atan2(ahead.cross(back).norm(), ahead.dot(back));
      const std::uint32_t v = faces[f][static_cast<std::size_t>(k)];
      vertex_normals_.col(v) += angle * face_normals_.col(f);
      valence_[v] += 1;
    }
  }
  edge_normals_.resize(faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge& edge = topology.edges[topology.face_edges[f][i]];
      edge_normals_[f].col(static_cast<int>(i)) =
          face_normals_.col(edge.face[0]) + face_normals_.col(edge.face[1]);
    }
}

Vector3d TriangleBody::normal_at(const TriangleTree::Nearest& nearest) const {
  const auto zeros = (nearest.weights.array() == 0).count();
  Eigen::Index corner = 0;
  if (zeros == 2) {
    nearest.weights.maxCoeff(&corner);
    return vertex_normals_.col(tree_.triangles()[nearest.triangle][static_cast<std::size_t>(corner)]);
  }
  if (zeros == 1) {
    nearest.weights.minCoeff(&corner);  // the edge opposite to it
    return edge_normals_[nearest.triangle].col(corner);
  }
  return face_normals_.col(nearest.triangle);
}

Distance TriangleBody::distance(const Vector3d& point) const {
  const TriangleTree::Nearest nearest = tree_.nearest(point);
  const Vector3d normal = normal_at(nearest), away = point - nearest.point;
  Distance d;
  const double sign = away.dot(normal) < 0 ? -1 : 1;
  d.value = sign * nearest.distance;
  d.first = nearest.distance > 0 ? Vector3d(sign * away / nearest.distance) : normal.stableNormalized();
  return d;
}

Contact TriangleBody::contact(const Vector3d& point, double gap, bool curvature) const {
  Contact contact;
  if (tree_.box().exteriorDistance(point) >= gap) return contact;
  TriangleTree::Nearest nearest = tree_.nearest(point, gap);
  const bool near = nearest.triangle != TriangleTree::Nearest::nothing;
  if (!near) nearest = tree_.nearest(point);  // deep inside, or far away
  if (!(nearest.distance > 0) || (point - nearest.point).dot(normal_at(nearest)) < 0) {
    contact.value = std::numeric_limits<double>::infinity();
    return contact;
  }
  if (!near) return contact;
  const auto add = [&](const Vector3d& at, int spans, const Vector3d& along, double weight) {
    add_barrier(contact, distance_from(point, at, spans, along, curvature), gap, weight, curvature);
  };
  tree_.each_near(point, gap, [&](std::uint32_t triangle) {
    const Matrix3d corners = tree_.corners(triangle);
    const Vector3d weights = nearest_weights(corners, point), at = corners * weights;
    if ((point - at).norm() >= gap) return;  // then so are its edges and vertices
    Eigen::Index corner = 0;
    weights.minCoeff(&corner);
    const Vector3d along = (corners.col((corner + 2) % 3) - corners.col((corner + 1) % 3)).stableNormalized();
    add(at, 2 - static_cast<int>((weights.array() == 0).count()), along, 1);
    // Every edge has two triangles, every vertex its valence of them: each adds its share.
    for (int k = 0; k < 3; ++k) {
      const Vector3d a = corners.col(k), edge = corners.col((k + 1) % 3) - a;
      const double length2 = edge.squaredNorm();
      const double share = length2 > 0 ? std::clamp((point - a).dot(edge) / length2, 0.0, 1.0) : 0;
      add(a + share * edge, share > 0 && share < 1 ? 1 : 0, edge.stableNormalized(), -0.5);
      add(a, 0, Vector3d::Zero(), 1 / valence_[tree_.triangles()[triangle][static_cast<std::size_t>(k)]]);
    }
  });
  return contact;
}

double TriangleBody::free_way(const Vector3d& from, const Vector3d& to) const {
  return std::min(1.0, 0.9 * tree_.first_hit(from, to));
}

}  // namespace plisse::shell
