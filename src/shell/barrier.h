// The barrier that keeps points out of solid bodies: a smooth potential that is infinite at their surface.
#pragma once

#include <Eigen/Core>

namespace plisse::shell {

struct Distance {
  double value = 0;                                  // m; positive outside
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   // unit: the direction out of the body
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // 1/m
};

// Per area, J/m² over a stiffness in N/m³ (a pressure a metre):
//   b(d) = −(d − g)² ln(d/g)   for 0 < d < g, 0 beyond, infinite for d ≤ 0
// (Li et al. 2020, Incremental Potential Contact, eq. 6), twice continuously differentiable.
struct Barrier {
  double value = 0, first = 0, second = 0;  // by d
};
Barrier barrier(double distance, double gap);

// The same by a point's position.
struct Contact {
  double value = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};
// Adds `weight` times b of a distance.
void add_barrier(Contact& contact, const Distance& distance, double gap, double weight, bool curvature);

}  // namespace plisse::shell
