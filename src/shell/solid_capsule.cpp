// A cylinder with round ends.
#include <algorithm>

#include "shell/obstacle.h"

namespace plisse::shell {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Distance Capsule::distance(const Vector3d& point) const {
  const Vector3d axis = second - first;
  const double length2 = axis.squaredNorm();
  const double along = length2 > 0 ? (point - first).dot(axis) / length2 : 0;
  Matrix3d curved = Matrix3d::Identity();
  if (along > 0 && along < 1) curved -= axis * axis.transpose() / length2;
  return round_body(point, first + std::clamp(along, 0.0, 1.0) * axis, radius, curved);
}

double Capsule::thickness() const {
  return 0.5 * radius;
}

Vector3d Capsule::carried_along(const Capsule& after, const Vector3d& point) const {
  return after.first + turned(second - first, after.second - after.first, point - first);
}

}  // namespace plisse::shell
