#include "shell/obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plisse::shell {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// From the point `nearest` of a core, round which the body has a radius; `curved`: the directions in which
// the distance is curved.
Distance round_body(const Vector3d& point, const Vector3d& nearest, double radius, const Matrix3d& curved) {
  Distance d;
  const Vector3d away = point - nearest;
  const double length = away.norm();
  d.value = length - radius;
  if (length > 0) {
    d.first = away / length;
    d.second = (curved - d.first * d.first.transpose()) / length;
  } else {
    d.first = Vector3d::UnitY();  // in the core itself: any way out
  }
  return d;
}

Distance distance_to(const Sphere& sphere, const Vector3d& point) {
  return round_body(point, sphere.centre, sphere.radius, Matrix3d::Identity());
}

Distance distance_to(const Plane& plane, const Vector3d& point) {
  return {plane.normal.dot(point - plane.point), plane.normal, Matrix3d::Zero()};
}

Distance distance_to(const Capsule& capsule, const Vector3d& point) {
  const Vector3d axis = capsule.second - capsule.first;
  const double length2 = axis.squaredNorm();
  const double along = length2 > 0 ? (point - capsule.first).dot(axis) / length2 : 0;
  Matrix3d curved = Matrix3d::Identity();
  if (along > 0 && along < 1) curved -= axis * axis.transpose() / length2;
  return round_body(point, capsule.first + std::clamp(along, 0.0, 1.0) * axis, capsule.radius, curved);
}

}  // namespace

Distance distance(const Obstacle& obstacle, const Vector3d& point) {
  return std::visit([&](const auto& body) { return distance_to(body, point); }, obstacle);
}

Barrier barrier(double distance, double gap) {
  if (distance <= 0) return {std::numeric_limits<double>::infinity(), 0, 0};
  if (distance >= gap) return {};
  const double inside = distance - gap, log = std::log(distance / gap);
  return {-inside * inside * log, -2 * inside * log - inside * inside / distance,
          -2 * log - 4 * inside / distance + inside * inside / (distance * distance)};
}

}  // namespace plisse::shell
