#include "shell/solid.h"

#include <Eigen/Geometry>

namespace plisse::shell {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Distance round_body(const Vector3d& point, const Vector3d& nearest, double radius, const Matrix3d& curved) {
  Distance d;
  const Vector3d away = point - nearest;
  const double length = away.norm();
  d.value = length - radius;
  if (length > 0) {
    d.first = away / length;
    d.second = (curved - d.first * d.first.transpose()) / length;
  } else {
    d.first = Vector3d::UnitY();  // on the core itself: any direction
  }
  return d;
}

Vector3d turned(const Vector3d& from, const Vector3d& to, const Vector3d& way) {
  return Eigen::Quaterniond::FromTwoVectors(from, to) * way;
}

}  // namespace plisse::shell
