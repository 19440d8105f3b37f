// From a problem to a wrinkle field: starts, solve, release, whole periods, solve again (Chen et al. 2021,
// section 5).
#pragma once

#include <array>
#include <vector>

#include "wrinkle/periods.h"
#include "wrinkle/solve.h"
#include "wrinkle/wave_count.h"

namespace plisse::wrinkle {

struct FieldOptions {
  SolveOptions solve;
  double frequency = 1;  // of the start, see initial_waves
  // Vandeparre's law in place of the solve (local_law.h): nothing is minimised, periods are rounded.
  bool local_law = false;
  bool all_starts = false;  // also from ½, 1/√2, √2 and 2 times that; patch by patch the lowest is taken
};

// Where the solver came to from a start.
struct FieldStart {
  double frequency = 1;
  double start_energy = 0, energy = 0;  // J, as Solution's
  int iterations = 0;
  bool converged = false;
};

struct Field {
  Solution real;                             // periods of any size: what the energy asks for
  Solution whole;                            // periods multiples of 2π: what a surface can show
  Eigen::VectorXd one_form;                  // ω, radians, one an edge
  std::vector<std::array<double, 3>> phase;  // φ, radians, one a corner of every face
  std::vector<bool> released;                // faces that stopped having to close because a = 0 on them
  std::vector<FieldStart> starts;            // before any release
  std::vector<SolveStep> trace;              // over all solves with real periods, the lowest energy so far
  double phase_residual = 0, waves = 0;      // see periods.h; waves = count.waves
  WaveCount count;
  double solve_s = 0, phase_s = 0;  // seconds
};

// Faces whose corners all come out without amplitude are released, as section 5.1 would have it, if that
// lowers the energy; what is compressed of them is won back, as long as that lowers it again. Vertices round
// which waves turn (singularities.h) have a face released before any is dead. Dead faces that want waves are
// given some, too: a = 0 is stationary whatever the phase.
Field solve_field(const shell::Topology& topology, const std::vector<FaceForms>& forms, const Model& model,
                  const std::vector<bool>& wrinkle_free, const std::vector<bool>& clamped = {},
                  const FieldOptions& options = {});

}  // namespace plisse::wrinkle
