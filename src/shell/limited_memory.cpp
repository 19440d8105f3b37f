#include "shell/limited_memory.h"

#include <deque>
#include <utility>

#include "base/interrupt.h"

namespace plisse::shell {
namespace {

double dot(const Positions& a, const Positions& b) {
  return a.cwiseProduct(b).sum();
}

// A step s and the change of the gradient y on it.
struct Change {
  Positions step, gradient;
  double product = 0;  // s·y > 0
};

// −H g, H the inverse Hessian that the changes and the metric make.
Positions direction(const std::deque<Change>& changes, Positions q,
                    const std::function<Positions(const Positions&)>& metric) {
  std::vector<double> shares(changes.size());
  for (std::size_t k = changes.size(); k-- > 0;) {
    shares[k] = dot(changes[k].step, q) / changes[k].product;
    q -= shares[k] * changes[k].gradient;
  }
  Positions r = metric(q);
  for (std::size_t k = 0; k < changes.size(); ++k)
    r += (shares[k] - dot(changes[k].gradient, r) / changes[k].product) * changes[k].step;
  return -r;
}

}  // namespace

Minimum find_minimum(const Positions& start, const std::function<EnergyValue(const Positions&)>& value,
                     const std::function<Positions(const Positions&)>& metric,
                     const MinimumSettings& settings) {
  Minimum result{start};
  EnergyValue here = value(start);
  std::deque<Change> changes;
  while (result.iterations < settings.max_iterations && !interrupted()) {
    const Positions step = direction(changes, here.gradient, metric);
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest <= settings.tolerance) {
      result.converged = true;
      break;
    }
    const double slope = dot(here.gradient, step);
    EnergyValue there;
    Positions x;
    double length = 1;
    bool down = false;
    for (int halving = 0; halving < 30 && !down; ++halving, length /= 2) {
      x = result.x + length * step;
      there = value(x);
      // Where rounding hides the fall the slope tells: it may not have become as steep the other way.
      const double rounding = 1e-14 * there.summands;
      down = there.energy <= here.energy + 1e-4 * length * slope ||
             (there.energy <= here.energy + rounding && std::abs(dot(there.gradient, step)) < -slope);
    }
    if (!down && !changes.empty()) {
      changes.clear();
      continue;
    }
    if (!down) {
      result.converged = longest <= settings.good_enough;
      break;
    }
    Change change{x - result.x, there.gradient - here.gradient};
    change.product = dot(change.step, change.gradient);
    // Of a straight piece of the energy there is nothing to learn.
    if (change.product > 1e-12 * change.step.norm() * change.gradient.norm()) {
      changes.push_back(std::move(change));
      if (changes.size() > static_cast<std::size_t>(settings.memory)) changes.pop_front();
    }
    result.x = std::move(x);
    here = std::move(there);
    ++result.iterations;
  }
  return result;
}

}  // namespace plisse::shell
