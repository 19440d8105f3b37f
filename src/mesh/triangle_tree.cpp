#include "mesh/triangle_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace plisse {

using Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

Vector3d nearest_weights(const Matrix3d& corners, const Vector3d& p) {
  const Vector3d a = corners.col(0), b = corners.col(1), c = corners.col(2);
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = d1 / (d1 - d3);
    return {1 - t, t, 0};
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d2 / (d2 - d6);
    return {1 - t, 0, t};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = (d4 - d3) / (d4 - d3 + (d5 - d6));
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

TriangleTree::TriangleTree(Matrix3Xd points, std::vector<Triangle> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)), order_(triangles_.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  Matrix3Xd middles(3, static_cast<Eigen::Index>(triangles_.size()));
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) middles.col(t) = corners(t).rowwise().mean();
  nodes_.reserve(2 * triangles_.size() + 1);
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(order_.size()), middles);
}

Matrix3d TriangleTree::corners(std::uint32_t triangle) const {
  const auto [a, b, c] = triangles_[triangle];
  Matrix3d corners;
  corners << points_.col(a), points_.col(b), points_.col(c);
  return corners;
}

// Halves by number, along the longest side of the box round the triangles' middles.
void TriangleTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
                         const Matrix3Xd& middles) {
  AlignedBox3d box, about;
  for (std::uint32_t k = begin; k < end; ++k) {
    for (const std::uint32_t v : triangles_[order_[k]]) box.extend(points_.col(v));
    about.extend(middles.col(order_[k]));
  }
  nodes_[node].box = box;
  constexpr std::uint32_t leaf = 4;
  if (end - begin <= leaf) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  Eigen::Index axis = 0;
  about.sizes().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(middles(axis, a), a) < std::pair(middles(axis, b), b);
                   });
  const auto halves = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = halves;
  nodes_.resize(nodes_.size() + 2);
  split(halves, begin, middle, middles);
  split(halves + 1, middle, end, middles);
}

void TriangleTree::nearest_in(std::uint32_t index, const Vector3d& p, Nearest& best) const {
  const Node& node = nodes_[index];
  for (std::uint32_t k = 0; k < node.count; ++k) {
    const std::uint32_t triangle = order_[node.first + k];
    const Matrix3d at = corners(triangle);
    const Vector3d weights = nearest_weights(at, p), point = at * weights;
    const double distance = (p - point).norm();
    if (distance < best.distance) best = {triangle, weights, point, distance};
  }
  if (node.count > 0) return;
  std::array<std::pair<double, std::uint32_t>, 2> halves;
  for (std::uint32_t h = 0; h < 2; ++h)
    halves[h] = {nodes_[node.first + h].box.exteriorDistance(p), node.first + h};
  std::sort(halves.begin(), halves.end());
  for (const auto& [distance, half] : halves)
    if (distance < best.distance) nearest_in(half, p, best);
}

TriangleTree::Nearest TriangleTree::nearest(const Vector3d& p, double reach) const {
  Nearest best;
  best.distance = reach;
  nearest_in(0, p, best);
  if (best.triangle == Nearest::nothing) best.distance = std::numeric_limits<double>::infinity();
  return best;
}

namespace {

// The share of the way inside a box begins at, infinite where it misses.
bool meets(const AlignedBox3d& box, const Vector3d& from, const Vector3d& way, double until) {
  double enter = 0, leave = until;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (from[axis] < box.min()[axis] || from[axis] > box.max()[axis]) return false;
      continue;
    }
    double a = (box.min()[axis] - from[axis]) / way[axis], b = (box.max()[axis] - from[axis]) / way[axis];
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a);
    leave = std::min(leave, b);
  }
  return enter <= leave * (1 + 1e-12);
}

}  // namespace

double TriangleTree::first_hit(const Vector3d& from, const Vector3d& to) const {
  const Vector3d way = to - from;
  double first = std::numeric_limits<double>::infinity();
  walk(
      0, [&](const Node& node) { return meets(node.box, from, way, std::min(first, 1.0)); },
      [&](std::uint32_t triangle) {
        const Matrix3d at = corners(triangle);
        const Vector3d ab = at.col(1) - at.col(0), ac = at.col(2) - at.col(0), normal = ab.cross(ac);
        const double steep = -way.dot(normal);
        if (steep == 0) return;  // along its plane: through an edge, if at all, which a neighbour has too
        const Vector3d ap = from - at.col(0);
        const double share = ap.dot(normal) / steep;
        if (!(share >= 0 && share <= 1 && share < first)) return;
        const Vector3d hit = ap + share * way, beside = ab.cross(hit), before = hit.cross(ac);
        const double area2 = normal.squaredNorm(), v = before.dot(normal) / area2,
                     w = beside.dot(normal) / area2;
        // A little wider than it is, so that nothing slips between two.
        constexpr double slack = -1e-9;
        if (v >= slack && w >= slack && v + w <= 1 - slack) first = share;
      });
  return first;
}

}  // namespace plisse
