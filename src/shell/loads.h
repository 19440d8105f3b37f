// What acts on a shell: gravity, pressure, forces, obstacles and their friction.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "shell/obstacle.h"
#include "shell/rest_shape.h"

namespace plisse::shell {

struct Loads {
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // m/s², on density × thickness × rest area
  double pressure = 0;  // Pa, along the faces' normals; of parts that are open see OpenSide
  Positions forces;     // N, 3×V or empty
  std::vector<Obstacle> obstacles;
  double gap = 1e-3;             // m: obstacles begin to push this far off
  double contact_stiffness = 0;  // N/m³ for the barrier; 0: chosen from the loads
  double friction = 0;           // μ, Coulomb's, on all obstacles
  double slip = 0;               // m: slip length ε, from which on friction has its full force; 0: gap/10
  // The anchors of vertices that touch an obstacle at the start: 3×V for each obstacle, NaN for vertices
  // without earlier contact; for these, or if it is empty: the start positions. After obstacles have moved,
  // see carried_along.
  std::vector<Positions> anchors;

  double slip_length() const { return slip > 0 ? slip : 0.1 * gap; }

  // Hands every member to `visit`, in one call: for what must miss none, such as the key of a cache. A member
  // that is not here does not compile.
  void visit_members(auto& visit) const {
    const auto& [gravity_, pressure_, forces_, obstacles_, gap_, contact_stiffness_, friction_, slip_,
                 anchors_] = *this;
    visit(gravity_, pressure_, forces_, obstacles_, gap_, contact_stiffness_, friction_, slip_, anchors_);
  }
};

}  // namespace plisse::shell
