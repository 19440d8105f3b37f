// Projected Newton (D. Bertsekas, Projected Newton methods for optimization problems with simple constraints,
// 1982) in place of the paper's sequential quadratic programs: amplitudes that stand at 0 and would go below
// are held there, the others and the phases take a Newton step along the projected line. The Hessian is the
// exact one where that is positive definite on the unknowns that move, else the sum of the faces' own parts
// projected to positive semidefinite ones.
#include "wrinkle/solve.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::SparseMatrix;
using Eigen::VectorXd;
using Clock = std::chrono::steady_clock;

class Newton {
 public:
  Newton(const Problem& problem, const SolveOptions& options)
      : problem_(problem), options_(options), matrix_(problem.pattern()) {
    factor_.analyzePattern(matrix_);
  }

  // −H⁻¹ g on the unknowns that move; whether the Hessian was positive definite.
  bool direction(const VectorXd& x, const std::vector<bool>& held, Problem::Hessian kind, double damping,
                 VectorXd& step) {
    VectorXd first;
    problem_.hessian(x, first, matrix_, kind);
    const double mean = matrix_.diagonal().cwiseAbs().mean();
    hold(matrix_, held, mean > 0 ? mean : 1);
    // A phase where there is no amplitude is free, and one of every component is: neither has a gradient.
    for (Index i = 0; i < matrix_.cols(); ++i) matrix_.coeffRef(i, i) += damping * mean;
    factor_.factorize(matrix_);
    if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0)) return false;
    for (Index i = 0; i < first.size(); ++i) {
      if (held[static_cast<std::size_t>(i)]) first[i] = 0;
    }
    step = -factor_.solve(first);
    for (Index i = 0; i < problem_.amplitude_count(); ++i) {
      if (held[static_cast<std::size_t>(i)]) step[i] = -x[i];  // what is close to its bound goes there
    }
    return step.allFinite();
  }

 private:
  const Problem& problem_;
  SolveOptions options_;
  SparseMatrix<double> matrix_;
  Eigen::SimplicialLDLT<SparseMatrix<double>> factor_;
};

}  // namespace

void hold(SparseMatrix<double>& matrix, const std::vector<bool>& held, double diagonal) {
  for (Index column = 0; column < matrix.cols(); ++column) {
    for (SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      if (held[static_cast<std::size_t>(entry.row())] || held[static_cast<std::size_t>(column)])
        entry.valueRef() = entry.row() == column ? diagonal : 0;
    }
  }
}

double kkt_residual(const Problem& problem, const VectorXd& x, double energy, const VectorXd& first,
                    bool fixed_periods) {
  // max() below would pass over a NaN.
  if (!std::isfinite(energy) || !first.allFinite() || !x.allFinite())
    return std::numeric_limits<double>::infinity();
  const Index amplitudes = problem.amplitude_count();
  const double largest = amplitudes > 0 ? x.head(amplitudes).maxCoeff() : 0;
  double residual = 0;
  for (Index i = 0; i < amplitudes; ++i) {
    const double g = x[i] > 0 ? std::abs(first[i]) : std::max(-first[i], 0.0);
    residual = std::max(residual, g * (largest > 0 ? largest : 1));
  }
  for (Index i = amplitudes; i < (fixed_periods ? problem.period_begin() : problem.size()); ++i)
    residual = std::max(residual, std::abs(first[i]));
  return energy > 0 ? residual / energy : residual;
}

Solution solve(const Problem& problem, const Waves& start, const SolveOptions& options) {
  const auto begin = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const Index amplitudes = problem.amplitude_count();
  const auto bounded = [&](VectorXd x) {
    x.head(amplitudes) = x.head(amplitudes).cwiseMax(0);
    return x;
  };
  Newton newton(problem, options);
  VectorXd x = bounded(problem.pack(start)), first, step, trial_first;
  Solution solution;
  double energy = problem.gradient(x, first);
  solution.start_energy = energy + problem.relaxed_energy();
  solution.trace.push_back({0, seconds(), solution.start_energy});
  std::vector<bool> held(static_cast<std::size_t>(problem.size()), false);
  bool near = false;  // the exact Hessian has a chance
  if (!std::isfinite(energy) || !first.allFinite())
    throw Error(ExitCode::bad_input,
                "the start's energy is not finite: amplitudes or frequencies are out of all proportion");
  int& iteration = solution.iterations;
  while (true) {
    solution.kkt = kkt_residual(problem, x, energy, first, options.fixed_periods);
    if (solution.kkt <= options.kkt) {
      solution.converged = true;
      solution.reason = "stationary";
      break;
    }
    if (iteration == options.max_iterations) {
      solution.reason = "too many iterations";
      break;
    }
    // Bertsekas' ε-active set: close to the bound, and pushed against it.
    const double close = std::min(1e-3, solution.kkt);
    for (Index i = 0; i < problem.size(); ++i) {
      held[static_cast<std::size_t>(i)] = i < amplitudes
                                              ? x[i] <= close && first[i] > 0
                                              : options.fixed_periods && i >= problem.period_begin();
    }
    if (!(near && newton.direction(x, held, Problem::Hessian::exact, 1e-12, step)) &&
        !newton.direction(x, held, Problem::Hessian::projected, 1e-9, step)) {
      solution.reason = "the Hessian cannot be factorised";
      break;
    }
    double length = 1, next = 0;
    VectorXd trial;
    bool down = false;
    for (int halving = 0; halving < 40; ++halving, length /= 2) {
      trial = bounded(x + length * step);
      next = problem.energy(trial);
      // Armijo along the bent line.
      if (next <= energy + 1e-4 * first.dot(trial - x) && next <= energy) {
        down = true;
        break;
      }
    }
    if (!down) {
      solution.reason = "no step lowers the energy any more";
      break;
    }
    const double gain = energy - next;
    ++iteration;
    x = trial;
    energy = problem.gradient(x, first);
    solution.trace.push_back({iteration, seconds(), energy + problem.relaxed_energy()});
    near = gain < 1e-2 * energy;
  }
  solution.waves = problem.unpack(x);
  solution.energy = energy + problem.relaxed_energy();
  return solution;
}

}  // namespace plisse::wrinkle
