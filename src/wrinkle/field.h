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

// The result of the solver from one start.
struct FieldStart {
  double frequency = 1;
  double start_energy = 0, energy = 0;  // J, as Solution's
  int iterations = 0;
  bool converged = false;
};

struct Field {
  Solution real;                             // real periods: the minimum of the energy
  Solution whole;                            // periods that are multiples of 2π, as a surface must have
  Eigen::VectorXd one_form;                  // ω, radians, one an edge
  std::vector<std::array<double, 3>> phase;  // φ, radians, one a corner of every face
  std::vector<bool> released;                // faces on which ω need not be closed because a = 0 there
  std::vector<FieldStart> starts;            // before any release
  std::vector<SolveStep> trace;              // over all solves with real periods, the lowest energy so far
  double phase_residual = 0, waves = 0;      // see periods.h; waves = count.waves
  WaveCount count;
  WaveCount above_tenth;  // the same among vertices above a tenth of the highest amplitude
  double wavelength = 0;  // at the highest crest, metres
  int solves = 0, iterations = 0, factorisations = 0;  // of all together
  double solve_s = 0, phase_s = 0;                     // seconds
};

// Faces whose corners all have amplitude 0 in the result are released, as in section 5.1, if that lowers the
// energy; compressed ones among them are made live again as long as that lowers it further. At vertices
// around which the waves turn (singularities.h) a face is released from the start. Faces with a = 0 that are
// compressed enough for waves also get a start with waves, since a = 0 is stationary for any phase.
Field solve_field(const shell::Topology& topology, const std::vector<FaceForms>& forms, const Model& model,
                  const std::vector<bool>& wrinkle_free, const std::vector<bool>& clamped = {},
                  const FieldOptions& options = {});

}  // namespace plisse::wrinkle
