// Coulomb friction of a shell on obstacles, smoothed at rest and lagged: M. Li et al., "Incremental Potential
// Contact", ACM TOG 2020, section 5. For equilibria the time step's start becomes where a vertex was when it
// was last at rest, or when it came into contact.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "shell/barrier.h"

namespace plisse::shell {

// A vertex that an obstacle pushes at: how hard and which way, as far as friction knows, and where it would
// stay.
struct Grip {
  std::uint32_t vertex = 0, obstacle = 0;
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  // unit, out of the obstacle
  double force = 0;                                   // N, ≥ 0, along it
};

// μ F f₀(|u|) and its derivatives by the vertex' place, u its way along the surface since the anchor, F the
// force: f₀ has the slope 1 from the slip length ε on, where friction is all that it can be, and
// f₀ = −y³/3ε² + y²/ε below, so that its force grows with y from 0 (IPC, eq. 16, less its constant ε/3: what
// has not slipped has cost nothing). J, convex.
Contact friction(const Grip& grip, const Eigen::Vector3d& x, double coefficient, double slip);

}  // namespace plisse::shell
