// Solid bodies that a shell may touch but not enter, as signed distances.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <variant>

#include "shell/barrier.h"
#include "shell/triangle_body.h"

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
struct Cylinder {  // round, with flat ends at `first` and `second`, which differ
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = Eigen::Vector3d::UnitY();
  double radius = 1;
};
using Body = std::shared_ptr<const TriangleBody>;
using Obstacle = std::variant<Sphere, Plane, Capsule, Cylinder, Body>;

// A body's has no second derivative: contact() has what solvers need.
Distance distance(const Obstacle& obstacle, const Eigen::Vector3d& point);

// The barrier of a body at a point; infinite in it.
Contact contact(const Obstacle& obstacle, const Eigen::Vector3d& point, double gap, bool curvature);

// The share, at most 1, of a straight way that a point may go without passing through the body: what is left
// of the way may end in it, which shows, but not beyond it.
double free_way(const Obstacle& obstacle, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace plisse::shell
