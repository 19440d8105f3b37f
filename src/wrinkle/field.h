// From a problem to a wrinkle field: start, solve, release, whole periods, solve again (Chen et al. 2021,
// section 5).
#pragma once

#include <array>
#include <vector>

#include "wrinkle/periods.h"
#include "wrinkle/solve.h"

namespace plisse::wrinkle {

struct FieldOptions {
  SolveOptions solve;
  double frequency = 1;  // of the start, see initial_waves
};

struct Field {
  Solution real;                             // periods of any size: what the energy asks for
  Solution whole;                            // periods multiples of 2π: what a surface can show
  Eigen::VectorXd one_form;                  // ω, radians, one an edge
  std::vector<std::array<double, 3>> phase;  // φ, radians, one a corner of every face
  std::vector<bool> released;                // faces that stopped having to close because a = 0 on them
  double phase_residual = 0, waves = 0;      // see periods.h
  double solve_s = 0, phase_s = 0;           // seconds
};

// Faces whose corners all come out without amplitude are released, as section 5.1 would have it, if that
// lowers the energy. Where a start ends with no waves at all though faces are compressed, it is tried again
// with other frequencies: a = 0 is stationary whatever the phase.
Field solve_field(const shell::Topology& topology, const std::vector<FaceForms>& forms, const Model& model,
                  const std::vector<bool>& wrinkle_free, const std::vector<bool>& clamped = {},
                  const FieldOptions& options = {});

}  // namespace plisse::wrinkle
