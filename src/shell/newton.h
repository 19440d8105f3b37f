// Static equilibrium by a projected Newton method with line search.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "shell/potential.h"

namespace plisse::shell {

struct NewtonSettings {
  int max_iterations = 1000;
  // Converged where the largest unbalanced force is at most this share of the largest sum of forces that meet
  // at a vertex.
  double tolerance = 1e-8;
  double max_seconds = 0;  // 0: no limit
};

struct NewtonStep {
  int iteration = 0;  // 0: the start
  double seconds = 0;
  double energy = 0;        // J
  double gradient_inf = 0;  // N
  double step = 0;          // share of the Newton step that was taken
  double shift = 0;         // N/m³: what was added to the Hessian a rest area
};

struct Equilibrium {
  Positions positions;
  double energy = 0;        // J, with friction's part
  double friction = 0;      // J: the work against friction since the anchors, by the last grips' forces
  double gradient_inf = 0;  // N, of unknowns
  double force_scale = 0;   // N: what it is small against
  int iterations = 0;
  bool converged = false;
  std::string reason;              // why it ended, in words
  std::vector<Positions> anchors;  // with friction: Loads::anchors for what comes next
  std::vector<NewtonStep> trace;
  double assembly_s = 0, factor_s = 0, line_search_s = 0, analysis_s = 0;
  std::size_t factor_nonzeros = 0;
};

// Called after every step; false stops the search, whose last state is kept.
using NewtonProgress = std::function<bool(const NewtonStep&, const Positions&)>;

// Finds the equilibrium nearest downhill. The energy falls with every step (friction's part jumps where its
// forces are looked up anew; what is told at the end is by those of the last state); the search ends
// converged, at the limit of iterations or time, when told to, or where double precision leaves nothing to
// gain, and says which. Throws Error(bad_input) where the start has no finite energy (inside an obstacle, for
// one: the vertex is named). Held coordinates are moved to their places first.
Equilibrium find_equilibrium(const Shell& shell, const Conditions& conditions, const Loads& loads,
                             const Positions& start, const NewtonSettings& settings = {},
                             const NewtonProgress& progress = {});

}  // namespace plisse::shell
