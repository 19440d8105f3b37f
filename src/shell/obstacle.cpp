#include "shell/obstacle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

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

// Beside the mantle, over an end, or off the rim where both meet.
Distance distance_to(const Cylinder& cylinder, const Vector3d& point) {
  const Vector3d middle = 0.5 * (cylinder.first + cylinder.second), span = cylinder.second - cylinder.first;
  const double half = 0.5 * span.norm();
  Vector3d axis = span / (2 * half);
  double along = axis.dot(point - middle);
  if (along < 0) axis = -axis;
  along = std::abs(along);
  const Vector3d across = point - middle - along * axis;
  const double radius = across.norm(), beside = radius - cylinder.radius, over = along - half;
  const Vector3d out = radius > 0 ? Vector3d(across / radius) : axis.unitOrthogonal();
  const Vector3d round = axis.cross(out);
  Distance d;
  if (beside > 0 && over > 0) {
    d.value = std::hypot(beside, over);
    d.first = (beside * out + over * axis) / d.value;
    const Vector3d turn = (over * out - beside * axis) / d.value;
    d.second = turn * turn.transpose() / d.value + beside / (d.value * radius) * round * round.transpose();
  } else if (over > beside) {
    d.value = over;
    d.first = axis;
  } else {
    d.value = beside;
    d.first = out;
    if (radius > 0) d.second = round * round.transpose() / radius;
  }
  return d;
}

Distance distance_to(const Body& body, const Vector3d& point) {
  return body->distance(point);
}

// No straight way of this length leads through its middle; the far side of a plane is inside for ever.
double thickness(const Sphere& sphere) {
  return 0.5 * sphere.radius;
}
double thickness(const Plane&) {
  return std::numeric_limits<double>::infinity();
}
double thickness(const Capsule& capsule) {
  return 0.5 * capsule.radius;
}
double thickness(const Cylinder& cylinder) {
  return 0.5 * std::min(cylinder.radius, (cylinder.second - cylinder.first).norm());
}

}  // namespace

Distance distance(const Obstacle& obstacle, const Vector3d& point) {
  return std::visit([&](const auto& body) { return distance_to(body, point); }, obstacle);
}

Contact contact(const Obstacle& obstacle, const Vector3d& point, double gap, bool curvature) {
  if (const auto* body = std::get_if<Body>(&obstacle)) return (*body)->contact(point, gap, curvature);
  Contact contact;
  add_barrier(contact, distance(obstacle, point), gap, 1, curvature);
  return contact;
}

double free_way(const Obstacle& obstacle, const Vector3d& from, const Vector3d& to) {
  if (const auto* body = std::get_if<Body>(&obstacle)) return (*body)->free_way(from, to);
  const double length = (to - from).norm();
  if (length == 0) return 1;
  return std::visit(
      [&](const auto& solid) {
        if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, Body>) {
          return 1.0;
        } else {
          return std::min(1.0, std::max(thickness(solid), distance_to(solid, from).value) / length);
        }
      },
      obstacle);
}

}  // namespace plisse::shell
