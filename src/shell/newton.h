// Static equilibrium by a projected Newton method with line search.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "shell/potential.h"

namespace plisse::shell {

struct NewtonSettings {
  int max_iterations = 1000;
  // Converged where the largest unbalanced force is at most this share of the largest sum of absolute forces
  // at a vertex.
  double tolerance = 1e-8;
  double max_seconds = 0;  // 0: no limit
};

struct NewtonStep {
  int iteration = 0;  // 0: the start
  double seconds = 0;
  double energy = 0;        // J
  double gradient_inf = 0;  // N
  double step = 0;          // the accepted share of the Newton step
  double shift = 0;         // N/m³: the shift of the Hessian per rest area
};

struct Equilibrium {
  Positions positions;
  double energy = 0;        // J, with friction's part
  double friction = 0;      // J: the work against friction since the anchors, by the last grips' forces
  double gradient_inf = 0;  // N, of unknowns
  double force_scale = 0;   // N: the scale of forces for it
  int iterations = 0;
  bool converged = false;
  std::string reason;              // why the search ended, in words
  std::vector<Positions> anchors;  // with friction: Loads::anchors for what comes next
  std::vector<NewtonStep> trace;
  double assembly_s = 0, factor_s = 0, line_search_s = 0, analysis_s = 0;
  std::size_t factor_nonzeros = 0;
};

// Called after every step; false stops the search, whose last state is kept.
using NewtonProgress = std::function<bool(const NewtonStep&, const Positions&)>;

// Finds an equilibrium by descent. The energy falls with every step (friction's part jumps where its forces
// are updated; the reported values use the forces of the last state). The search ends when it has converged,
// at the limit of iterations or time, when `progress` returns false, or where double precision allows no
// further decrease; `reason` says which. Throws Error(bad_input) where the start has no finite energy (for
// example inside an obstacle: the vertex is named). Held coordinates are set first.
Equilibrium find_equilibrium(const Shell& shell, const Conditions& conditions, const Loads& loads,
                             const Positions& start, const NewtonSettings& settings = {},
                             const NewtonProgress& progress = {});

}  // namespace plisse::shell
