#include "shell/barrier.h"

#include <cmath>
#include <limits>

namespace plisse::shell {

Barrier barrier(double distance, double gap) {
  if (distance <= 0) return {std::numeric_limits<double>::infinity(), 0, 0};
  if (distance >= gap) return {};
  const double inside = distance - gap, log = std::log(distance / gap);
  return {-inside * inside * log, -2 * inside * log - inside * inside / distance,
          -2 * log - 4 * inside / distance + inside * inside / (distance * distance)};
}

void add_barrier(Contact& contact, const Distance& distance, double gap, double weight, bool curvature) {
  if (distance.value >= gap) return;
  const Barrier b = barrier(distance.value, gap);
  contact.value += weight * b.value;
  contact.first += weight * b.first * distance.first;
  if (curvature)
    contact.second +=
        weight * (b.second * distance.first * distance.first.transpose() + b.first * distance.second);
}

}  // namespace plisse::shell
