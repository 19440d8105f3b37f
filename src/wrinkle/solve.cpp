// Descent with bounds on the amplitudes, in place of the paper's sequential quadratic programs. Two kinds of
// steps, both from the energy's second derivatives at the state, on the unknowns that move (D. Bertsekas,
// Projected Newton methods for optimization problems with simple constraints, 1982):
//
// - the first few are projected Newton steps: each face's own part of the Hessian is made positive
//   semidefinite, and the step is taken whole where that lowers the energy. They go far, and choose among the
//   many minima.
// - all others are of a trust region, (H + λM) s = −g (K. Levenberg 1944, D. Marquardt 1963; J. Moré and
//   D. Sorensen, Computing a trust region step, 1983), where M measures a change of waves by the waves
//   themselves. Along the soft directions of long waves, where heights make up for frequencies, steps are as
//   long as the model holds, and all other unknowns are as good as solved for.
#include "wrinkle/solve.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/clock.h"
#include "base/error.h"
#include "base/interrupt.h"
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

double tether_energy(const std::optional<Tether>& tether, const VectorXd& x) {
  return tether ? 0.5 * tether->stiffness.dot((x - tether->to).cwiseAbs2()) : 0;
}

// E(x + s) ≈ E + gᵀs + ½ sᵀHs, E with the tether.
class Model {
 public:
  Model(const Problem& problem, const std::optional<Tether>& tether)
      : problem_(problem), tether_(tether), second_(problem), matrix_(problem.pattern()), factor_(matrix_) {}

  double at(const VectorXd& x) {
    x_ = x;
    double energy = second_.at(x, first_);
    if (tether_) {
      energy += tether_energy(tether_, x);
      first_ += tether_->stiffness.cwiseProduct(x - tether_->to);
    }
    ++assemblies;
    mean_ = second_.exact().coeffs().cwiseAbs().mean();
    if (!(mean_ > 0)) mean_ = 1;
    return energy;
  }
  const VectorXd& first() const { return first_; }
  double second(Index i) const {
    return second_.exact().valuePtr()[second_.exact().outerIndexPtr()[i]] +
           (tether_ ? tether_->stiffness[i] : 0);
  }

  // Solves (H + `lifted` L + `lambda` M) s = −g, L and M of Problem::Curvature, on the unknowns that are not
  // held; held ones go to the bound that they are close to. Amplitudes that this moves beyond a bound are
  // held as well, and the others solved for again, in at most `rounds` rounds: a step that is cut off at many
  // bounds is a descent direction only if it is very short, and amplitudes beside waves alternate at 0. False
  // where the matrix is not positive definite.
  bool step(std::vector<bool> held, double lifted, double lambda, int rounds, VectorXd& step) {
    auto values = matrix_.coeffs();
    values = second_.exact().coeffs();
    if (lifted > 0) values += lifted * (lambda > 0 ? second_.lift() : second_.nearest()).coeffs();
    if (lambda > 0) values += lambda * second_.metric().coeffs();
    // A phase where there is no amplitude is free, and one of every component is: neither has a gradient.
    constexpr double least_shift = 1e-12, lifted_shift = 1e-9;
    const double shift = (lambda > 0 ? least_shift : std::max(least_shift, lifted_shift * lifted)) * mean_;
    for (Index i = 0; i < matrix_.cols(); ++i)
      matrix_.valuePtr()[matrix_.outerIndexPtr()[i]] += shift + (tether_ ? tether_->stiffness[i] : 0);
    const SparseMatrix<double> whole = matrix_;

    const VectorXd& upper = problem_.upper();
    VectorXd known = VectorXd::Zero(x_.size());
    for (Index i = 0; i < problem_.amplitude_count(); ++i)
      if (held[static_cast<std::size_t>(i)]) known[i] = x_[i] < upper[i] / 2 ? -x_[i] : upper[i] - x_[i];
    for (int round = 0; round < rounds; ++round) {
      hold(matrix_, held, mean_);
      ++factorisations;
      if (!factor_(matrix_)) return false;
      VectorXd right = -first_;
      if (!known.isZero(0)) right -= whole.selfadjointView<Eigen::Lower>() * known;
      for (Index i = 0; i < right.size(); ++i)
        if (held[static_cast<std::size_t>(i)]) right[i] = 0;
      step = factor_.solve(right) + known;
      bool more = false;
      for (Index i = 0; i < problem_.amplitude_count(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        const bool low = x_[i] + step[i]<0, high = x_[i] + step[i]> upper[i];
        if (held[at] || !(low || high)) continue;
        known[i] = step[i] = low ? -x_[i] : upper[i] - x_[i];
        held[at] = more = true;
      }
      if (!more) break;
    }
    at_bounds_ = std::count(held.begin(), held.begin() + problem_.amplitude_count(), true);
    return step.allFinite();
  }
  Index at_bounds() const { return at_bounds_; }  // amplitudes that the last step puts there

  // How much the model falls by a step, J.
  double fall(const VectorXd& step) const {
    return -first_.dot(step) - 0.5 * step.dot(second_.exact().selfadjointView<Eigen::Lower>() * step) -
           (tether_ ? 0.5 * tether_->stiffness.dot(step.cwiseAbs2()) : 0);
  }

  int assemblies = 0, factorisations = 0;

 private:
  const Problem& problem_;
  const std::optional<Tether>& tether_;
  Problem::Curvature second_;
  SparseMatrix<double> matrix_;
  VectorXd x_, first_;
  double mean_ = 1;
  Index at_bounds_ = 0;
  Factor factor_;
};

class Descent {
 public:
  Descent(const Problem& problem, const Waves& start, const SolveOptions& options,
          const std::optional<Tether>& tether)
      : problem_(problem),
        options_(options),
        tether_(tether),
        model_(problem, tether),
        lambda_(options.trust) {
    x_ = bounded(problem.pack(start));
    held_.resize(static_cast<std::size_t>(problem.size()));
    energy_ = model_.at(x_);
    solution_.start_energy = energy_ - tether_energy(tether, x_) + problem.relaxed_energy();
    if (!std::isfinite(energy_) || !model_.first().allFinite())
      throw Error(ExitCode::bad_input,
                  "the start's energy is not finite: amplitudes or frequencies are out of all proportion");
    note();
  }

  Solution run() {
    const int newton = options_.trust == SolveOptions().trust ? newton_steps : 0;
    bool far = newton > 0;
    while (solution_.reason.empty()) {
      solution_.kkt = kkt_residual(problem_, x_, energy_, model_.first(), options_.fixed_periods);
      if (solution_.kkt == 0) {
        end(true, "stationary");
      } else if (solution_.iterations == options_.max_iterations) {
        end(false, "too many iterations");
      } else if (interrupted()) {
        end(false, "interrupted");
      } else if (lacking() > hopeless * gain_) {
        end(false, "does not come below the target");
      } else {
        hold_at_bounds();
        // The exact Hessian's steps go on as long as they work: nothing is faster.
        far = far && (solution_.iterations < newton || level_ == 0) && newton_step();
        if (!far) trusted_step();
      }
    }
    solution_.assemblies = model_.assemblies;
    solution_.factorisations = model_.factorisations;
    solution_.waves = problem_.unpack(x_);
    solution_.energy = energy_ - tether_energy(tether_, x_) + problem_.relaxed_energy();
    return std::move(solution_);
  }

 private:
  // So many Newton steps, and none where the first would put some amplitudes to a bound and others not, more
  // than this share of both, as on long waves in a sheet that is held by its ends: amplitudes come to
  // alternate at 0, and what follows takes three times as many steps.
  static constexpr int newton_steps = 8;
  static constexpr double most_mixed = 0.15;
  bool mixed(Index at_bounds) const {
    const Index count = problem_.amplitude_count();
    return static_cast<double>(std::min(at_bounds, count - at_bounds)) >
           most_mixed * static_cast<double>(count);
  }
  // Shares of the lift for Newton steps, from the exact Hessian to one that is positive definite in any
  // state. The first that works is used; after a whole step the next is tried one further to the exact one.
  static constexpr std::array<double, 4> lifts{0, 0.03, 0.2, 1};

  // λ: what counts as none; the largest from which the model's fall says how far off the least energy is, in
  // a loose search too; from which on faces are lifted at all, and by all that they need; beyond which a step
  // is nothing but the way down.
  static constexpr double least_damping = 1e-7, telling_damping = 1e-3, telling_if_loose = 0.1,
                          first_lift = 1e-3, whole_lift = 0.1, most_damping = 1e12;
  static constexpr int most_creeping = 10;
  static constexpr double late = 1e-6;        // of the energy: a search whose steps gain less is about to end
  static constexpr double loose = 1e-6;       // SolveOptions::energy from which on a search is loose
  static constexpr double least_gain = 1e-3;  // of what the model falls
  static constexpr double hopeless = 20;  // steps like the last that it would take to SolveOptions::target

  VectorXd bounded(VectorXd x) const {
    const Index count = problem_.amplitude_count();
    x.head(count) = x.head(count).cwiseMax(0).cwiseMin(problem_.upper());
    return x;
  }

  double energy_at(const VectorXd& x) const { return problem_.energy(x) + tether_energy(tether_, x); }
  double rounding() {
    if (rounding_ < 0) rounding_ = problem_.rounding(x_);
    return rounding_;
  }
  double lacking() const {  // to SolveOptions::target, J
    return energy_ - tether_energy(tether_, x_) + problem_.relaxed_energy() - options_.target;
  }
  bool stationary() const { return solution_.kkt <= options_.kkt; }
  void end(bool converged, std::string_view reason) {
    solution_.converged = converged;
    solution_.reason = reason;
  }
  void note() {
    solution_.trace.push_back(
        {solution_.iterations, wall_seconds() - begin_, energy_ + problem_.relaxed_energy()});
  }

  // Bertsekas' ε-active set: close to the bound, and pushed beyond it.
  void hold_at_bounds() {
    const double close = std::min(1e-3, solution_.kkt);
    const VectorXd &first = model_.first(), &upper = problem_.upper();
    for (Index i = 0; i < problem_.size(); ++i) {
      bool held = options_.fixed_periods && i >= problem_.period_begin();
      if (i < problem_.amplitude_count()) {
        const double above = x_[i], below = upper[i] - x_[i];
        held = (above <= close && first[i] > 0 && above * model_.second(i) <= first[i]) ||
               (below <= close && first[i] < 0 && below * model_.second(i) <= -first[i]);
      }
      held_[static_cast<std::size_t>(i)] = held;
    }
  }

  void go(VectorXd to) {
    ++solution_.iterations;
    x_ = std::move(to);
    gain_ = energy_;
    energy_ = model_.at(x_);
    gain_ -= energy_;
    rounding_ = -1;
    note();
  }

  // False where none lowers the energy.
  bool newton_step() {
    if (stationary() && gain_ <= options_.energy * energy_) {
      end(true, "stationary");
      return true;
    }
    constexpr int rounds = 4, halvings = 4;  // prefers another Hessian to a much shorter step
    VectorXd step;
    for (; level_ < lifts.size(); ++level_) {
      if (!model_.step(held_, lifts[level_], 0, rounds, step)) continue;
      if (solution_.iterations == 0 && mixed(model_.at_bounds())) return false;
      double length = 1;
      for (int halving = 0; halving < halvings; ++halving, length /= 2) {
        VectorXd trial = bounded(x_ + length * step);
        const double next = energy_at(trial);
        // Armijo along the bent line.
        if (!(next <= energy_ + 1e-4 * model_.first().dot(trial - x_) && next <= energy_)) continue;
        if (length == 1 && level_ > 0) --level_;
        go(std::move(trial));
        return true;
      }
    }
    return false;
  }

  void trusted_step() {
    VectorXd step;
    bool indefinite = false, brought_back = false;
    indefinite_at_ *= 0.9;
    const auto more = [&] {
      if (!late_ || !(lambda_ > 0 && lambda_ < good_)) return std::max(4 * lambda_, least_damping);
      // Between what fails and what worked in the last step, while that is far off.
      return indefinite_at_ == lambda_ && 1.3 * lambda_ < good_ ? std::sqrt(lambda_ * good_) : good_;
    };
    for (; lambda_ <= most_damping; lambda_ = more()) {
      const double lifted = lambda_ < first_lift ? 0 : std::min(lambda_ / whole_lift, 1.0);
      if (!model_.step(held_, lifted, lambda_, tether_ ? 4 : 1, step)) {
        indefinite = true;
        indefinite_at_ = lambda_;
        continue;
      }
      VectorXd trial = bounded(x_ + step);
      step = trial - x_;
      const double fall = model_.fall(step);
      const bool telling = lambda_ <= (options_.energy < loose ? telling_damping : telling_if_loose);
      const bool little =
          stationary() && std::abs(fall) <= options_.energy * energy_ + (tether_ ? tether_->nothing : 0);
      // Or where the search creeps along a saddle so flat that many steps together gain nothing.
      if (little && (telling || ++creeping_ > most_creeping)) return end(true, "stationary");
      if (!little) creeping_ = 0;
      if (std::abs(fall) <= rounding()) {
        // Not even worth a look at the energy, unless it is for λ that there is so little.
        if (telling || indefinite) {
          if (stationary()) return end(true, "stationary");
          if (!telling) break;
          // One step more, since the model is finer than the energy: what is on its way to 0 comes there.
          if (!below_rounding_ && energy_at(trial) <= energy_ + rounding()) {
            below_rounding_ = true;
            return go(std::move(trial));
          }
          return end(true, "what is left is below the rounding of the energy");
        }
        if (brought_back) break;  // small steps are below rounding, and larger ones do not go down
        brought_back = true;
        lambda_ = telling_damping / 4;  // and the loop makes it four times that
        good_ = 0;
        continue;
      }
      const double next = energy_at(trial), ratio = (energy_ - next) / fall;
      if (!(fall > 0 && ratio >= least_gain)) continue;
      good_ = lambda_;
      late_ = fall <= late * energy_;
      if (ratio > 0.75) {
        if (late_ && lambda_ / 4 <= indefinite_at_) {
          // Near that λ steps are long along the ways down from a saddle, which take hundreds otherwise.
          if (lambda_ > 1.1 * indefinite_at_) lambda_ = std::sqrt(indefinite_at_ * lambda_);
        } else if (!indefinite) {  // what has just turned out too little is not tried again at once
          lambda_ = lambda_ / 4 < least_damping ? 0 : lambda_ / 4;
        }
      }
      if (ratio < 0.25) lambda_ = std::max(4 * lambda_, least_damping);
      return go(std::move(trial));
    }
    end(stationary(), stationary() ? "stationary" : "no step lowers the energy any more");
  }

  const Problem& problem_;
  const SolveOptions& options_;
  const std::optional<Tether>& tether_;
  const double begin_ = wall_seconds();
  Model model_;
  Solution solution_;
  VectorXd x_;
  double energy_ = 0;
  std::vector<bool> held_;
  bool below_rounding_ = false;
  double gain_ = std::numeric_limits<double>::infinity();  // of the last step
  double rounding_ = -1;                                   // of the energy, once it is asked for
  std::size_t level_ = lifts.size() - 1;
  double lambda_;
  double indefinite_at_ = 0;  // the λ at which the matrix was not positive definite, less as steps go by
  double good_ = 0;           // λ of the last step
  bool late_ = false;
  int creeping_ = 0;  // steps in a row that gained next to nothing
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

Solution solve(const Problem& problem, const Waves& start, const SolveOptions& options,
               const std::optional<Tether>& tether) {
  if (problem.size() > 0) return Descent(problem, start, options, tether).run();
  Solution nothing;
  nothing.waves = problem.unpack(VectorXd());
  nothing.start_energy = nothing.energy = problem.relaxed_energy();
  nothing.converged = true;
  nothing.reason = "stationary";
  nothing.trace.push_back({0, 0, nothing.energy});
  return nothing;
}

}  // namespace plisse::wrinkle
