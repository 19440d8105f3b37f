// What the kinds of solids (obstacle.h) are made from and share.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "shell/barrier.h"

namespace plisse::shell {

// What scene files say of a solid; each kind takes what it needs. Metres, in the place where it is now.
struct SolidShape {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();       // centre, a point of a plane, or one end of an axis
  Eigen::Vector3d to = Eigen::Vector3d::UnitY();      // the axis' other end
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  // unit, out of the solid side
  double radius = 0;
};

struct SolidWords {
  std::string_view name;              // its plural ends in s
  bool axis = false, radius = false;  // whether `to` (not the same place as `at`), `radius` must be there
};

// From the point `nearest` of a core, round which the body has a radius; `curved`: the directions in which
// the distance is curved.
Distance round_body(const Eigen::Vector3d& point, const Eigen::Vector3d& nearest, double radius,
                    const Eigen::Matrix3d& curved);

// A way, turned as the unit vector or axis `from` is turned into `to` by the shortest turn.
Eigen::Vector3d turned(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& way);

}  // namespace plisse::shell
