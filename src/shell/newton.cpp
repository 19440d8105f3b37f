#include "shell/newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/clock.h"
#include "base/error.h"
#include "shell/cholesky.h"

namespace plisse::shell {
namespace {

using Eigen::VectorXd;

class Search {
 public:
  Search(const Shell& shell, const Conditions& conditions, const Loads& loads, const Positions& start,
         const NewtonSettings& settings, const NewtonProgress& progress)
      : shell_(shell),
        conditions_(conditions),
        loads_(loads),
        start_(start),
        settings_(settings),
        progress_(progress),
        potential_(shell, conditions, loads, start.rowwise().mean()),
        lags_(potential_.lags()) {
    result_.positions = start;
    for (Eigen::Index v = 0; v < start.cols(); ++v)
      for (int axis = 0; axis < 3; ++axis)
        if (conditions.held(axis, v)) result_.positions(axis, v) = conditions.at(axis, v);
    measure(shell);
    for (Eigen::Index v = 0; v < start.cols(); ++v)
      for (std::size_t o = 0; o < loads.obstacles.size(); ++o)
        if (!conditions.held.col(v).all() &&
            distance(loads.obstacles[o], result_.positions.col(v)).value <= 0)
          throw Error(ExitCode::bad_input,
                      fmt::format("vertex {} starts inside obstacle {}: begin farther off", v, o));
  }

  Equilibrium run() {
    VectorXd gradient;
    Potential::Value value = potential_.value(result_.positions, &gradient);
    if (!std::isfinite(value.energy) || !gradient.allFinite())
      throw Error(ExitCode::bad_input, no_finite_energy());
    if (lags_) grip(value, gradient, true);
    note(0, value, gradient, 0, 0);
    int steps_gripped = 0;
    while (true) {
      // Friction is lagged: its forces are updated every few steps, and must be up to date at the end.
      if (lags_ && steps_gripped >= 4) {
        grip(value, gradient, false);
        steps_gripped = 0;
      }
      if (finished(value, gradient)) {
        if (!lags_ || steps_gripped == 0 || !result_.converged) break;
        result_.converged = false;
        grip(value, gradient, false);
        steps_gripped = 0;
        continue;
      }
      if (runs_away()) break;
      const VectorXd direction = newton_direction(gradient);
      if (direction.size() == 0) {
        result_.reason = "the Hessian could not be factorised";
        break;
      }
      const double began = wall_seconds();
      const double energy = value.energy, largest = gradient.cwiseAbs().maxCoeff();
      const VectorXd before = gradient;
      const double step = line_search(value, gradient, direction);
      result_.line_search_s += wall_seconds() - began;
      if (step == 0) {
        if (lags_ && steps_gripped > 0) {
          grip(value, gradient, false);
          steps_gripped = 0;
          continue;
        }
        if (stalled(value, gradient)) break;
        continue;
      }
      ++steps_gripped;
      adapt(step, (energy - value.energy) / promised(before, direction, step),
            gradient.cwiseAbs().maxCoeff() / largest, (energy - value.energy) / value.summands);
      stalls_ = 0;
      ++result_.iterations;
      note(result_.iterations, value, gradient, step, used_shift_);
      if (progress_ && !progress_(result_.trace.back(), result_.positions)) {
        result_.reason = "it was interrupted";
        break;
      }
    }
    if (lags_) {
      // Reported values use the forces of the last state, not the lagged ones.
      if (steps_gripped > 0) grip(value, gradient, false);
      tell(value, gradient);
      result_.anchors = potential_.anchors(result_.positions);
    }
    return std::move(result_);
  }

 private:
  void grip(Potential::Value& value, VectorXd& gradient, bool first) {
    potential_.look_up(result_.positions, first);
    value = potential_.value(result_.positions, &gradient);
  }

  std::string no_finite_energy() const {
    std::string infinite;
    for (const Potential::Part& part : potential_.parts(result_.positions))
      if (!std::isfinite(part.energy)) infinite += (infinite.empty() ? " of " : ", ") + part.name;
    return fmt::format(
        "the start has no finite energy{}: positions are too large or too close to an obstacle", infinite);
  }

  // Parts that are not held may slide off an obstacle.
  bool runs_away() {
    if (loads_.obstacles.empty() || result_.iterations % 8 != 0 || result_.iterations == 0) return false;
    result_.reason = unsupported(shell_, conditions_, loads_, result_.positions);
    if (result_.reason.empty() &&
        longest_slide(shell_, conditions_, loads_, start_, result_.positions) > 10 * rest_extent_)
      result_.reason = "a part slides along an obstacle without end: nothing holds it there";
    return !result_.reason.empty();
  }

  // The rounding of positions times the shell's stiffness gives forces that cannot be balanced; they must not
  // prevent the convergence of a shell without loads. On a regular mesh rows of the bending's Hessian sum to
  // some 10 B A |∇λ|⁴.
  void measure(const Shell& shell) {
    const Material& m = shell.material;
    const double bending = shell.bending == Bending::off ? 0 : 10 * m.bending_stiffness();
    Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(result_.positions.cols());  // N/m
    double area = 0;
    for (std::size_t f = 0; f < shell.rest.size(); ++f) {
      area += shell.rest[f].area;
      for (int k = 0; k < 3; ++k) {
        const double steep = shell.rest[f].gradients.col(k).squaredNorm();
        stiffness[shell.topology.faces[f][static_cast<std::size_t>(k)]] +=
            shell.rest[f].area * steep *
            (m.young * m.thickness / (1 - m.poisson * m.poisson) + bending * steep);
      }
    }
    rest_extent_ = std::sqrt(area);
    const double reach = std::max(rest_extent_, result_.positions.cwiseAbs().maxCoeff());
    rounding_force_ = 4 * std::numeric_limits<double>::epsilon() * reach * stiffness.maxCoeff();
  }

  double allowed(const Potential::Value& value) const {
    return std::max(settings_.tolerance * value.force_scale, rounding_force_);
  }

  // After a whole step the quadratic model is trusted more: the exact Hessian next time, and a smaller shift.
  // `fall`: decrease of the energy over the predicted one; `rest`: largest force over its previous value.
  void adapt(double step, double fall, double rest, double gain) {
    if (regular_) {
      // The shift works as a trust region: it grows with the model's error.
      if (step < 0.5 || fall < 0.25) {
        exact_shift_ = std::max(4 * exact_shift_, least_shift_);
      } else if (fall > 0.75) {
        exact_shift_ = exact_shift_ > 4 * least_shift_ ? 0.5 * exact_shift_ : 0;
      }
      return;
    }
    // Whole steps without concave parts gain almost nothing: near an unstable equilibrium, where only the
    // concave parts lead away.
    regular_ = exact_failed_ && used_shift_ == 0 && step > 0.5 && rest > 0.3 && gain < 1e-4;
    if (regular_) exact_shift_ = 1e-7 * size_;
    exact_ = step > 0.5;
    if (exact_) {
      shift_ = shift_ > 4 * least_shift_ ? 0.1 * shift_ : 0;
    } else if (step < 0.1) {
      shift_ = std::max(4 * shift_, least_shift_);
    }
  }

  void tell(const Potential::Value& value, const VectorXd& gradient) {
    result_.energy = value.energy + potential_.offset();
    result_.friction = value.friction;
    result_.force_scale = value.force_scale;
    result_.gradient_inf = gradient.size() > 0 ? gradient.cwiseAbs().maxCoeff() : 0;
  }

  void note(int iteration, const Potential::Value& value, const VectorXd& gradient, double step,
            double shift) {
    tell(value, gradient);
    result_.trace.push_back(
        {iteration, wall_seconds() - began_, result_.energy, result_.gradient_inf, step, shift});
  }

  bool finished(const Potential::Value& value, const VectorXd& gradient) {
    const double largest = gradient.size() > 0 ? gradient.cwiseAbs().maxCoeff() : 0;
    if (largest <= allowed(value)) {
      result_.converged = true;
      result_.reason = fmt::format("forces balance to {:.1e} of those that meet",
                                   value.force_scale > 0 ? largest / value.force_scale : 0.0);
      return true;
    }
    if (result_.iterations >= settings_.max_iterations) {
      result_.reason = fmt::format("the limit of {} iterations was reached", settings_.max_iterations);
      return true;
    }
    if (settings_.max_seconds > 0 && wall_seconds() - began_ > settings_.max_seconds) {
      result_.reason = fmt::format("the limit of {} seconds was reached", settings_.max_seconds);
      return true;
    }
    return false;
  }

  void assemble(Curvature curvature) {
    const double began = wall_seconds();
    hessian_ = potential_.hessian(result_.positions, curvature);
    size_ = (hessian_.diagonal().array() / potential_.areas().array().max(1e-300)).maxCoeff();
    least_shift_ = 1e-12 * size_;
    result_.assembly_s += wall_seconds() - began;
  }

  // −(H + shift)⁻¹ g where this is a descent direction, else nothing.
  VectorXd solved(const VectorXd& gradient, double shift) {
    double began = wall_seconds();
    system_ = hessian_;
    if (shift > 0) system_.diagonal() += shift * potential_.areas();
    if (!analysed_) {
      factor_.analyse(system_);
      analysed_ = true;
      result_.analysis_s = wall_seconds() - began;
      began = wall_seconds();
    }
    VectorXd direction;
    if (factor_.factorise(system_)) {
      result_.factor_nonzeros = factor_.nonzeros();
      direction = -factor_.solve(gradient);
      if (!direction.allFinite() || gradient.dot(direction) >= 0) direction.resize(0);
    }
    result_.factor_s += wall_seconds() - began;
    return direction;
  }

  // Newton's direction with the exact Hessian; without its concave parts where it is not positive definite;
  // with a shift where that fails too. Empty: there is none.
  VectorXd newton_direction(const VectorXd& gradient) {
    VectorXd direction;
    exact_failed_ = false;
    if (exact_ || regular_) {
      assemble(Curvature::exact);
      direction = solved(gradient, regular_ ? exact_shift_ : 0);
      while (regular_ && direction.size() == 0 && exact_shift_ < 1e-2 * size_) {
        exact_shift_ = std::max(4 * exact_shift_, 1e-8 * size_);
        direction = solved(gradient, exact_shift_);
      }
      used_shift_ = regular_ ? exact_shift_ : 0;
      if (direction.size() > 0) return direction;
      exact_ = regular_ = false;
      exact_failed_ = true;
    }
    assemble(Curvature::positive);
    for (int attempt = 0; attempt < 40; ++attempt) {
      direction = solved(gradient, shift_);
      used_shift_ = shift_;
      if (direction.size() > 0) break;
      shift_ = std::max(10 * shift_, least_shift_);
    }
    return direction;
  }

  // The decrease of energy that the model predicts for a part of a step.
  double promised(const VectorXd& gradient, const VectorXd& direction, double step) const {
    const double slope = gradient.dot(direction);
    const double shifted = used_shift_ * direction.cwiseAbs2().dot(potential_.areas());
    return -step * slope + 0.5 * step * step * (slope + shifted);
  }

  // Halves the step until the energy falls enough; takes the new state. 0: no step does.
  double line_search(Potential::Value& value, VectorXd& gradient, const VectorXd& direction) {
    const double slope = gradient.dot(direction);
    double step = potential_.safe_step(result_.positions, direction);
    // No vertex moves farther than half of the shell's size in a step: for slack parts the Newton step has no
    // natural length.
    const double longest = direction.cwiseAbs().maxCoeff();
    const double extent =
        std::max(rest_extent_,
                 (result_.positions.rowwise().maxCoeff() - result_.positions.rowwise().minCoeff()).norm());
    if (step * longest > 0.5 * extent) step = 0.5 * extent / longest;
    // Energies are sums of one term per face, whose rounding errors add up like a random walk.
    const double rounding = 1e-16 * (10 + std::sqrt(static_cast<double>(gradient.size()))) * value.summands;
    Positions x;
    VectorXd new_gradient;
    for (int halving = 0; halving < 60; ++halving, step *= 0.5) {
      x = result_.positions;
      potential_.advance(x, direction, step);
      const Potential::Value there = potential_.value(x, &new_gradient);
      if (!std::isfinite(there.energy) || !new_gradient.allFinite()) continue;
      const bool falls = there.energy <= value.energy + 1e-4 * step * slope;
      // Where the expected decrease is below rounding, the forces decide.
      const bool balances = -step * slope <= 10 * rounding && there.energy <= value.energy + rounding &&
                            new_gradient.norm() < 0.9 * gradient.norm();
      if (!falls && !balances) {
        if (-step * slope < 1e-3 * rounding) break;
        continue;
      }
      if (there.energy > value.energy - rounding && new_gradient.norm() >= gradient.norm())
        break;  // no progress
      result_.positions = std::move(x);
      value = there;
      gradient = std::move(new_gradient);
      return step;
    }
    return 0;
  }

  // No step down the Newton direction: once more with concave parts left out, then with shifts; then give up.
  bool stalled(const Potential::Value& value, const VectorXd& gradient) {
    const double largest = gradient.cwiseAbs().maxCoeff();
    const double share = value.force_scale > 0 ? largest / value.force_scale : 0;
    // The rounding error of forces that cancel; energies cannot resolve more than a hundred times that.
    const bool balanced = largest <= 100 * allowed(value);
    if ((exact_ || regular_) && !balanced) {
      exact_ = regular_ = false;
      return false;
    }
    if (!balanced && ++stalls_ < 4) {
      shift_ = std::max(100 * shift_, 1e3 * least_shift_);
      return false;
    }
    result_.converged = balanced;
    result_.reason = fmt::format(
        "double precision leaves nothing to gain; forces balance to {:.1e} of those that meet", share);
    return true;
  }

  const Shell& shell_;
  const Conditions& conditions_;
  const Loads& loads_;
  const Positions& start_;
  NewtonSettings settings_;
  const NewtonProgress& progress_;
  Potential potential_;
  const bool lags_;
  Equilibrium result_;
  Cholesky factor_;
  Eigen::SparseMatrix<double> hessian_, system_;
  double began_ = wall_seconds();
  double rounding_force_ = 0, rest_extent_ = 0;
  double size_ = 0;  // N/m³: the largest of the Hessian's diagonal a rest area
  // N/m³ a rest area: what is added to it without its concave parts, or as it is; the last that was.
  double shift_ = 0, exact_shift_ = 0, least_shift_ = 0, used_shift_ = 0;
  bool exact_ = false, regular_ = false, exact_failed_ = false, analysed_ = false;
  int stalls_ = 0;
};

}  // namespace

Equilibrium find_equilibrium(const Shell& shell, const Conditions& conditions, const Loads& loads,
                             const Positions& start, const NewtonSettings& settings,
                             const NewtonProgress& progress) {
  check(shell, conditions, loads, start);
  return Search(shell, conditions, loads, start, settings, progress).run();
}

}  // namespace plisse::shell
