// Coulomb friction of a shell on obstacles, smoothed at rest and lagged: M. Li et al., "Incremental Potential
// Contact", ACM TOG 2020, section 5. For equilibria, the position at the start of the time step is replaced
// by that of the last equilibrium, or of the first contact.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "shell/barrier.h"

namespace plisse::shell {

// A vertex in contact with an obstacle: the force and direction of the contact that friction uses, and the
// anchor.
struct Grip {
  std::uint32_t vertex = 0, obstacle = 0;
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  // unit, out of the obstacle
  double force = 0;                                   // N, ≥ 0, along it
};

// μ F f₀(|u|) and its derivatives by the vertex' place, u its displacement along the surface from the anchor,
// F the force: f₀ has the slope 1 from the slip length ε on, where friction has its full force, and f₀ =
// −y³/3ε² + y²/ε below, so that its force grows with y from 0 (IPC, eq. 16, less its constant ε/3: without
// slip there is no energy). J, convex.
Contact friction(const Grip& grip, const Eigen::Vector3d& x, double coefficient, double slip);

}  // namespace plisse::shell
