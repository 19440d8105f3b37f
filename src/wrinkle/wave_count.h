// How many waves a field has.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "wrinkle/surface.h"

namespace plisse::wrinkle {

// The most waves that a loop or a shortest way meets in one patch of visible faces, those whose corners all
// have more than a share of the largest amplitude. Loops are the patch's rims and the shortest ones
// through a few of its vertices (two shortest ways that meet); ways are the shortest between the vertices
// where the phase is farthest apart. Both count ∮ω/2π, so that neither crest lines nor phases need names.
struct WaveCount {
  double waves = 0;    // a whole number around a loop with whole-number periods
  bool round = false;  // a loop; else a path with two ends
  double length = 0;   // its length at rest, metres
};

// `live`: one flag a face, where ω is closed; amplitude one a vertex (metres), one_form one an edge
// (radians).
WaveCount count_waves(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                      const std::vector<bool>& live, const Eigen::VectorXd& amplitude,
                      const Eigen::VectorXd& one_form, double share = 0.01);

// The length of the waves at the highest crest, metres at rest: of the mean frequency of the live faces round
// the vertex of the largest amplitude; 0 where nothing wrinkles.
double wavelength_at_highest(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                             const std::vector<bool>& live, const Eigen::VectorXd& amplitude,
                             const Eigen::VectorXd& one_form);

}  // namespace plisse::wrinkle
