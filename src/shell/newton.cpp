#include "shell/newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "shell/cholesky.h"

namespace plisse::shell {
namespace {

using Eigen::VectorXd;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Search {
 public:
  Search(const Shell& shell, const Conditions& conditions, const Loads& loads, const Positions& start,
         const NewtonSettings& settings, const NewtonProgress& progress)
      : settings_(settings),
        progress_(progress),
        potential_(shell, conditions, loads, start.rowwise().mean()) {
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
      throw Error(ExitCode::bad_input,
                  "the start has no finite energy: positions are too large or too close to an obstacle");
    note(0, value, gradient, 0, 0);
    while (!finished(value, gradient)) {
      const VectorXd direction = newton_direction(gradient);
      if (direction.size() == 0) {
        result_.reason = "the Hessian could not be factorised";
        break;
      }
      const auto began = Clock::now();
      const double step = line_search(value, gradient, direction);
      result_.line_search_s += since(began);
      if (step == 0) {
        if (stalled(value, gradient)) break;
        continue;
      }
      adapt(step);
      stalls_ = 0;
      ++result_.iterations;
      note(result_.iterations, value, gradient, step, shift_);
      if (progress_ && !progress_(result_.trace.back(), result_.positions)) {
        result_.reason = "it was interrupted";
        break;
      }
    }
    return std::move(result_);
  }

 private:
  // Positions are rounded, and a shell's stiffness makes forces of it, which nothing can balance; they must
  // not keep one that nothing pulls at from being at rest. On a regular mesh rows of the bending's Hessian
  // sum to some 10 B A |∇λ|⁴.
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

  // A whole step earns trust in the quadratic model: the exact Hessian next time, and less of a shift.
  void adapt(double step) {
    exact_ = step > 0.5;
    if (exact_) {
      shift_ = shift_ > 4 * least_shift_ ? 0.1 * shift_ : 0;
    } else if (step < 0.1) {
      shift_ = std::max(4 * shift_, least_shift_);
    }
  }

  void note(int iteration, const Potential::Value& value, const VectorXd& gradient, double step,
            double shift) {
    result_.energy = value.energy + potential_.offset();
    result_.force_scale = value.force_scale;
    result_.gradient_inf = gradient.size() > 0 ? gradient.cwiseAbs().maxCoeff() : 0;
    result_.trace.push_back({iteration, since(began_), result_.energy, result_.gradient_inf, step, shift});
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
    if (settings_.max_seconds > 0 && since(began_) > settings_.max_seconds) {
      result_.reason = fmt::format("the limit of {} seconds was reached", settings_.max_seconds);
      return true;
    }
    return false;
  }

  // −(H + shift)⁻¹ g, with the shift raised and the concave parts left out until that leads downhill.
  VectorXd newton_direction(const VectorXd& gradient) {
    for (int attempt = 0; attempt < 40; ++attempt) {
      auto began = Clock::now();
      system_ = potential_.hessian(result_.positions, exact_ ? Curvature::exact : Curvature::positive);
      const VectorXd diagonal = system_.diagonal();
      const double size = (diagonal.array() / potential_.areas().array().max(1e-300)).maxCoeff();
      least_shift_ = 1e-12 * size;
      if (shift_ > 0) system_.diagonal() += shift_ * potential_.areas();
      result_.assembly_s += since(began);
      began = Clock::now();
      if (!analysed_) {
        factor_.analyse(system_);
        analysed_ = true;
        result_.analysis_s = since(began);
        began = Clock::now();
      }
      const bool positive = factor_.factorise(system_);
      result_.factor_s += since(began);
      if (positive) {
        result_.factor_nonzeros = factor_.nonzeros();
        VectorXd direction = -factor_.solve(gradient);
        if (direction.allFinite() && gradient.dot(direction) < 0) return direction;
      }
      if (exact_) {
        exact_ = false;
      } else {
        shift_ = std::max(10 * shift_, least_shift_);
      }
    }
    return {};
  }

  // Halves the step until the energy falls enough; takes the new state. 0: no step does.
  double line_search(Potential::Value& value, VectorXd& gradient, const VectorXd& direction) {
    const double slope = gradient.dot(direction);
    double step = potential_.safe_step(result_.positions, direction);
    // No vertex goes farther than half of the whole at once: what is slack has no idea of scale.
    const double longest = direction.cwiseAbs().maxCoeff();
    const double extent =
        std::max(rest_extent_,
                 (result_.positions.rowwise().maxCoeff() - result_.positions.rowwise().minCoeff()).norm());
    if (step * longest > 0.5 * extent) step = 0.5 * extent / longest;
    // Energies are sums of a term a face, whose rounding adds up like a random walk.
    const double rounding = 1e-16 * (10 + std::sqrt(static_cast<double>(gradient.size()))) * value.terms;
    Positions x;
    VectorXd new_gradient;
    for (int halving = 0; halving < 60; ++halving, step *= 0.5) {
      x = result_.positions;
      potential_.advance(x, direction, step);
      const Potential::Value there = potential_.value(x, &new_gradient);
      if (!std::isfinite(there.energy) || !new_gradient.allFinite()) continue;
      const bool falls = there.energy <= value.energy + 1e-4 * step * slope;
      // Where the expected fall is lost in rounding the forces decide.
      const bool balances = -step * slope <= 10 * rounding && there.energy <= value.energy + rounding &&
                            new_gradient.norm() < 0.9 * gradient.norm();
      if (!falls && !balances) {
        if (-step * slope < 1e-3 * rounding) break;
        continue;
      }
      if (there.energy > value.energy - rounding && new_gradient.norm() >= gradient.norm())
        break;  // going nowhere
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
    // What rounding leaves of forces that cancel; a hundredth of that is all that energies can tell.
    const bool balanced = largest <= 100 * allowed(value);
    if (exact_ && !balanced) {
      exact_ = false;
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

  NewtonSettings settings_;
  const NewtonProgress& progress_;
  Potential potential_;
  Equilibrium result_;
  Cholesky factor_;
  Eigen::SparseMatrix<double> system_;
  Clock::time_point began_ = Clock::now();
  double rounding_force_ = 0, rest_extent_ = 0, shift_ = 0, least_shift_ = 0;
  bool exact_ = false, analysed_ = false;
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
