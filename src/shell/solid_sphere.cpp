// A ball.
#include "shell/obstacle.h"

namespace plisse::shell {

using Eigen::Vector3d;

Distance Sphere::distance(const Vector3d& point) const {
  return round_body(point, centre, radius, Eigen::Matrix3d::Identity());
}

double Sphere::thickness() const {
  return 0.5 * radius;
}

Vector3d Sphere::carried_along(const Sphere& after, const Vector3d& point) const {
  return point + after.centre - centre;
}

}  // namespace plisse::shell
