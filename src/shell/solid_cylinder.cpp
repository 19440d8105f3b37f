// A cylinder with flat ends: nearest points are on its side, on an end, or on the edge between them.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "shell/obstacle.h"

namespace plisse::shell {

using Eigen::Vector3d;

Distance Cylinder::distance(const Vector3d& point) const {
  const Vector3d middle = 0.5 * (first + second), span = second - first;
  const double half = 0.5 * span.norm();
  Vector3d axis = span / (2 * half);
  double along = axis.dot(point - middle);
  if (along < 0) axis = -axis;
  along = std::abs(along);
  const Vector3d across = point - middle - along * axis;
  const double away = across.norm(), beside = away - radius, over = along - half;
  const Vector3d out = away > 0 ? Vector3d(across / away) : axis.unitOrthogonal();
  const Vector3d round = axis.cross(out);
  Distance d;
  if (beside > 0 && over > 0) {
    d.value = std::hypot(beside, over);
    d.first = (beside * out + over * axis) / d.value;
    const Vector3d turn = (over * out - beside * axis) / d.value;
    d.second = turn * turn.transpose() / d.value + beside / (d.value * away) * round * round.transpose();
  } else if (over > beside) {
    d.value = over;
    d.first = axis;
  } else {
    d.value = beside;
    d.first = out;
    if (away > 0) d.second = round * round.transpose() / away;
  }
  return d;
}

double Cylinder::thickness() const {
  return 0.5 * std::min(radius, (second - first).norm());
}

Vector3d Cylinder::carried_along(const Cylinder& after, const Vector3d& point) const {
  return after.first + turned(second - first, after.second - after.first, point - first);
}

}  // namespace plisse::shell
