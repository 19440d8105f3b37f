// How many waves a field has.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "wrinkle/surface.h"

namespace plisse::wrinkle {

// The largest number of waves along a loop or a shortest path in one patch of visible faces, those whose
// corners all have more than a hundredth of the largest amplitude. Loops are the patch's boundaries and the
// shortest ones through a few of its vertices (two shortest paths that meet); paths are the shortest ones
// between the vertices with the largest difference of phase. Both count ∮ω/2π, so that crests need not be
// identified.
struct WaveCount {
  double waves = 0;    // a whole number around a loop with whole-number periods
  bool round = false;  // a loop; else a path with two ends
  double length = 0;   // its length at rest, metres
};

// `live`: one flag a face, where ω is closed; amplitude one a vertex (metres), one_form one an edge
// (radians).
WaveCount count_waves(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                      const std::vector<bool>& live, const Eigen::VectorXd& amplitude,
                      const Eigen::VectorXd& one_form);

}  // namespace plisse::wrinkle
