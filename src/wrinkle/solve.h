// Minimises the wrinkle energy (39) with bounds on the amplitudes.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "wrinkle/problem.h"

namespace plisse::wrinkle {

// ½ Σ stiffness_i (x_i − to_i)², J: keeps a state near another one; both by the problem's unknowns,
// stiffness ≥ 0 (Problem::taken_up, times a number).
struct Tether {
  Eigen::VectorXd to, stiffness;
  double nothing = 0;  // J: the search ends where this is all that a step would gain
};

struct SolveOptions {
  int max_iterations = 500;
  double kkt = 1e-6;           // stop where the scaled residual is at most this and
  double energy = 1e-9;        // the last step gained at most this part of the energy above the relaxed one
  bool fixed_periods = false;  // periods stay as they are
  // λ of the trust region at the start. Less where the start is near the answer: without the Newton steps
  // that begin a search (solve.cpp).
  double trust = 1;
  // J: a search that is not to end below this is given up, see Solution::reason: where a step gains less than
  // a twentieth of what lacks to it.
  double target = std::numeric_limits<double>::infinity();
};

struct SolveStep {
  int iteration = 0;
  double seconds = 0;  // since the solve began
  double energy = 0;   // J, as Solution::energy, but with the tether's
};

struct Solution {
  Waves waves;
  double start_energy = 0, energy = 0;  // J, (37): the relaxed energy included, a tether's not
  double kkt = 0;                       // scaled residual, see kkt_residual
  int iterations = 0;
  int assemblies = 0, factorisations = 0;  // of the Hessian
  bool converged = false;
  std::string reason;  // one phrase
  std::vector<SolveStep> trace;
};

// The largest of |a_s ∂E/∂a_v|, |∂E/∂φ_i| and |∂E/∂τ_k| over the free unknowns, divided by E, the
// energy above the relaxed one, where
// a_s is the largest amplitude of the state (the problem's scale where all are 0); at a_v = 0 only negative
// ∂E/∂a_v count, at its upper bound only positive ones. Dimensionless: the relative change of E is less than
// this when the largest wave changes by its own height, or one phase by a radian. `first`: dE by the
// problem's unknowns.
double kkt_residual(const Problem& problem, const Eigen::VectorXd& x, double energy,
                    const Eigen::VectorXd& first, bool fixed_periods = false);

// Replaces rows and columns of held unknowns by those of `diagonal` times the identity; `matrix`: the
// lower half.
void hold(Eigen::SparseMatrix<double>& matrix, const std::vector<bool>& held, double diagonal);

// With a tether the sum of both is minimised, and stationary at the end.
Solution solve(const Problem& problem, const Waves& start, const SolveOptions& options = {},
               const std::optional<Tether>& tether = {});

}  // namespace plisse::wrinkle
