// A half-space.
#include <limits>

#include "shell/obstacle.h"

namespace plisse::shell {

using Eigen::Vector3d;

Distance Plane::distance(const Vector3d& at) const {
  return {normal.dot(at - point), normal, Eigen::Matrix3d::Zero()};
}

double Plane::thickness() const {
  return std::numeric_limits<double>::infinity();  // it has no far side
}

Vector3d Plane::carried_along(const Plane& after, const Vector3d& at) const {
  return after.point + turned(normal, after.normal, at - point);
}

}  // namespace plisse::shell
