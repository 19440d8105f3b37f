// Solid bodies that a shell may touch but not enter, as signed distances.
#pragma once

#include <Eigen/Core>
#include <variant>

namespace plisse::shell {

// All lengths in metres.
struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1;
};
struct Plane {  // solid behind it
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  // unit, pointing out
};
struct Capsule {  // all that is within `radius` of the segment from `first` to `second`
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = Eigen::Vector3d::UnitY();
  double radius = 1;
};
using Obstacle = std::variant<Sphere, Plane, Capsule>;

struct Distance {
  double value = 0;                                  // m; positive outside
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   // unit: the way out
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // 1/m
};
Distance distance(const Obstacle& obstacle, const Eigen::Vector3d& point);

// What keeps points out: per area, J/m² over a stiffness in N/m³ (a pressure a metre):
//   b(d) = −(d − g)² ln(d/g)   for 0 < d < g, 0 beyond, infinite for d ≤ 0
// (Li et al. 2020, Incremental Potential Contact, eq. 6), twice continuously differentiable.
struct Barrier {
  double value = 0, first = 0, second = 0;  // by d
};
Barrier barrier(double distance, double gap);

}  // namespace plisse::shell
