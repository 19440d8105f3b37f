// The minimum of a smooth convex energy whose Hessian is near a known matrix: limited-memory BFGS in its
// metric.
//
// J. Nocedal, "Updating Quasi-Newton Matrices with Limited Storage", Mathematics of Computation 35 (1980);
// the metric in place of a multiple of the identity: T. Liu, S. Bouaziz and L. Kavan, "Quasi-Newton Methods
// for Real-Time Simulation of Hyperelastic Materials", ACM TOG 36 (2017).
#pragma once

#include <functional>

#include "shell/rest_shape.h"

namespace plisse::shell {

struct MinimumSettings {
  int memory = 8;  // of the last steps
  int max_iterations = 400;
  double tolerance = 0;    // converged where no coordinate of a step is longer, m
  double good_enough = 0;  // the same, where rounding hides whether a step lowers the energy, m
};

struct Minimum {
  Positions x;  // m, 3×V
  int iterations = 0;
  bool converged = false;
};

struct EnergyValue {
  double energy = 0;    // J
  double summands = 0;  // J: sum of their absolute values; what rounding is relative to
  Positions gradient;   // N, 3×V; 0 at what is held
};

// `metric`: of a gradient, the step that would lead to the minimum if the known matrix were the Hessian (less
// its sign), m. Ends early, not converged, after an interrupt.
Minimum find_minimum(const Positions& start, const std::function<EnergyValue(const Positions&)>& value,
                     const std::function<Positions(const Positions&)>& metric,
                     const MinimumSettings& settings);

}  // namespace plisse::shell
