// Projected Newton (D. Bertsekas, Projected Newton methods for optimization problems with simple constraints,
// 1982) in place of the paper's sequential quadratic programs: amplitudes that stand at 0 and would go below
// are held there, the others and the phases take a Newton step along the projected line. The Hessian is the
// exact one where that is positive definite on the unknowns that move, else the sum of the faces' own parts
// projected to positive semidefinite ones.
#include "wrinkle/solve.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/clock.h"
#include "base/error.h"
#include "shell/cholesky.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::SparseMatrix;
using Eigen::VectorXd;

// Factors the lower half of a symmetric matrix of a fixed pattern, in an order of elimination of its own
// (minimum degree).
class Factor {
 public:
  explicit Factor(const SparseMatrix<double>& lower) {
    Eigen::AMDOrdering<int> ordering;
    ordering(SparseMatrix<double>(lower.selfadjointView<Eigen::Lower>()), order_);
    place_ = order_.inverse();
    std::vector<Eigen::Triplet<double>> entries;
    double number = 0;
    for (Index column = 0; column < lower.cols(); ++column) {
      for (SparseMatrix<double>::InnerIterator it(lower, column); it; ++it) {
        const int r = place_.indices()[it.row()], c = place_.indices()[column];
        entries.emplace_back(std::max(r, c), std::min(r, c), number++);
      }
    }
    ordered_.resize(lower.rows(), lower.cols());
    ordered_.setFromTriplets(entries.begin(), entries.end());
    for (Index i = 0; i < ordered_.nonZeros(); ++i)
      from_.push_back(static_cast<Index>(ordered_.valuePtr()[i]));
    cholesky_.analyse(ordered_);
  }
  // False where it is not positive definite.
  bool operator()(const SparseMatrix<double>& lower) {
    for (std::size_t i = 0; i < from_.size(); ++i) ordered_.valuePtr()[i] = lower.valuePtr()[from_[i]];
    return cholesky_.factorise(ordered_);
  }
  VectorXd solve(const VectorXd& right) const { return order_ * cholesky_.solve(place_ * right); }

 private:
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order_, place_;
  std::vector<Index> from_;  // of each number of `ordered_`: its place in the matrix
  SparseMatrix<double> ordered_;
  shell::Cholesky cholesky_;
};

// A series of Hessians: from the exact one to one that is positive definite in any state, and on to short
// gradient steps. The search uses the first that works; it goes one level back toward the exact one after a
// whole step, and one level on after a failed step.
struct Caution {
  double lifted;   // see Problem::hessian
  double damping;  // added to the diagonal, in its mean
};
constexpr std::array<Caution, 9> cautions{
    {{0, 1e-12}, {0.03, 1e-10}, {0.2, 1e-9}, {1, 1e-9}, {1, 1e-7}, {1, 1e-5}, {1, 1e-3}, {1, 1e-1}, {1, 10}}};

class Newton {
 public:
  static constexpr int rounds = 4;
  explicit Newton(const Problem& problem) : problem_(problem), matrix_(problem.pattern()), factor_(matrix_) {}

  // −H⁻¹ g on the unknowns that move; false where the Hessian is not positive definite. Amplitudes that this
  // moves beyond a bound are set to the bound and the step of the others is solved again, a few times: a step
  // that is cut off at many bounds is a descent direction only if it is very short, and amplitudes beside
  // waves alternate at 0.
  bool direction(const VectorXd& x, std::vector<bool> held, const Caution& caution, VectorXd& step) {
    VectorXd first;
    problem_.hessian(x, first, matrix_, caution.lifted);
    const double mean = matrix_.diagonal().cwiseAbs().mean();
    // A phase where there is no amplitude is free, and one of every component is: neither has a gradient.
    for (Index i = 0; i < matrix_.cols(); ++i) matrix_.coeffRef(i, i) += caution.damping * mean;
    const SparseMatrix<double> whole = matrix_;
    const VectorXd& upper = problem_.upper();
    VectorXd known = VectorXd::Zero(x.size());  // the step of held unknowns; those near a bound move to it
    for (Index i = 0; i < problem_.amplitude_count(); ++i)
      if (held[static_cast<std::size_t>(i)]) known[i] = x[i] < upper[i] / 2 ? -x[i] : upper[i] - x[i];
    for (int round = 0; round < rounds; ++round) {
      hold(matrix_, held, mean > 0 ? mean : 1);
      if (!factor_(matrix_)) return false;
      VectorXd right = -first;
      if (round > 0) right -= whole.selfadjointView<Eigen::Lower>() * known;
      for (Index i = 0; i < right.size(); ++i)
        if (held[static_cast<std::size_t>(i)]) right[i] = 0;
      step = factor_.solve(right);
      bool more = false;
      for (Index i = 0; i < problem_.amplitude_count(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        const bool low = x[i] + step[i]<0, high = x[i] + step[i]> upper[i];
        if (held[at] || !(low || high)) continue;
        known[i] = low ? -x[i] : upper[i] - x[i];
        held[at] = more = true;
      }
      if (!more) break;
    }
    for (Index i = 0; i < problem_.amplitude_count(); ++i)
      if (held[static_cast<std::size_t>(i)]) step[i] = known[i];
    return step.allFinite();
  }

 private:
  const Problem& problem_;
  SparseMatrix<double> matrix_;
  Factor factor_;
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
  // max() below would ignore a NaN.
  if (!std::isfinite(energy) || !first.allFinite() || !x.allFinite())
    return std::numeric_limits<double>::infinity();
  const Index amplitudes = problem.amplitude_count();
  const double largest = amplitudes > 0 ? x.head(amplitudes).maxCoeff() : 0;
  double residual = 0;
  for (Index i = 0; i < amplitudes; ++i) {
    const bool low = x[i] <= 0, high = x[i] >= problem.upper()[i];
    if ((low && first[i] > 0) || (high && first[i] < 0)) continue;
    residual = std::max(residual, std::abs(first[i]) * (largest > 0 ? largest : 1));
  }
  for (Index i = amplitudes; i < (fixed_periods ? problem.period_begin() : problem.size()); ++i)
    residual = std::max(residual, std::abs(first[i]));
  return energy > 0 ? residual / energy : residual;
}

Solution solve(const Problem& problem, const Waves& start, const SolveOptions& options) {
  const double begin = wall_seconds();
  const auto seconds = [&] { return wall_seconds() - begin; };
  const Index amplitudes = problem.amplitude_count();
  const auto bounded = [&](VectorXd x) {
    x.head(amplitudes) = x.head(amplitudes).cwiseMax(0).cwiseMin(problem.upper());
    return x;
  };
  Newton newton(problem);
  VectorXd x = bounded(problem.pack(start)), first, step;
  Solution solution;
  double energy = problem.gradient(x, first);
  solution.start_energy = energy + problem.relaxed_energy();
  solution.trace.push_back({0, seconds(), solution.start_energy});
  std::vector<bool> held(static_cast<std::size_t>(problem.size()), false);
  std::size_t level = 3;                                  // of cautions
  double gain = std::numeric_limits<double>::infinity();  // of the last step
  if (!std::isfinite(energy) || !first.allFinite())
    throw Error(ExitCode::bad_input,
                "the start's energy is not finite: amplitudes or frequencies are out of all proportion");
  int& iteration = solution.iterations;
  while (true) {
    solution.kkt = kkt_residual(problem, x, energy, first, options.fixed_periods);
    const bool stationary = solution.kkt <= options.kkt;
    if (solution.kkt == 0 || (stationary && gain <= options.energy * energy)) {
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
      held[static_cast<std::size_t>(i)] =
          i < amplitudes
              ? (x[i] <= close && first[i] > 0) || (x[i] >= problem.upper()[i] - close && first[i] < 0)
              : options.fixed_periods && i >= problem.period_begin();
    }
    double length = 0, next = 0;
    VectorXd trial;
    bool down = false;
    for (;; ++level) {
      if (level == cautions.size()) break;
      if (!newton.direction(x, held, cautions[level], step)) continue;
      // Prefers another Hessian to a much shorter step.
      const int halvings = level + 1 < cautions.size() ? 4 : 40;
      length = 1;
      for (int halving = 0; halving < halvings && !down; ++halving) {
        trial = bounded(x + length * step);
        next = problem.energy(trial);
        // Armijo along the bent line.
        down = next <= energy + 1e-4 * first.dot(trial - x) && next <= energy;
        if (!down) length /= 2;
      }
      if (down) break;
    }
    if (!down) {
      solution.converged = stationary;
      solution.reason = stationary ? "stationary" : "no step lowers the energy any more";
      break;
    }
    if (length == 1 && level > 0) --level;
    gain = energy - next;
    ++iteration;
    x = trial;
    energy = problem.gradient(x, first);
    solution.trace.push_back({iteration, seconds(), energy + problem.relaxed_energy()});
  }
  solution.waves = problem.unpack(x);
  solution.energy = energy + problem.relaxed_energy();
  return solution;
}

}  // namespace plisse::wrinkle
