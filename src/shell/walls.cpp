#include "shell/walls.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace plisse::shell {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Triplet = Eigen::Triplet<double>;

Walls::Walls(const std::vector<HalfSpace>& walls, const Positions& pose, const VectorXd& stiffness,
             const std::vector<bool>& free)
    : walls_(walls), multiplier_(walls.size(), 0), stiffness_(walls.size(), 0), distance_(walls.size(), 0) {
  // Of the energy's own stiffness at a vertex, so much at most: more makes searches longer, less makes more
  // of them.
  constexpr double times = 4;
  VectorXd load = VectorXd::Zero(stiffness.size());
  for (std::size_t k = 0; k < walls.size(); ++k) {
    double give = 0;
    for (const auto& [v, weight] : walls[k].of)
      if (free[v]) give += weight * weight / stiffness[v];
    stiffness_[k] = give > 0 ? 1 / give : 0;
    for (const auto& [v, weight] : walls[k].of) load[v] += stiffness_[k] * weight * weight;
  }
  for (std::size_t k = 0; k < walls.size(); ++k) {
    double least = 1;
    for (const auto& [v, weight] : walls[k].of)
      if (weight != 0 && load[v] > 0) least = std::min(least, stiffness[v] / load[v]);
    stiffness_[k] *= times * least;
    Vector3d at = Vector3d::Zero();
    for (const auto& [v, weight] : walls[k].of) at += weight * pose.col(v);
    distance_[k] = walls[k].normal.dot(at) - walls[k].least;
  }
}

double Walls::beyond(std::size_t k, const Positions& moved) const {
  double distance = distance_[k];
  for (const auto& [v, weight] : walls_[k].of) distance += weight * walls_[k].normal.dot(moved.col(v));
  return distance;
}

void Walls::add(const Positions& moved, EnergyValue& value) const {
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    if (!(stiffness_[k] > 0)) continue;
    const double push = std::max(multiplier_[k] - stiffness_[k] * beyond(k, moved), 0.0),
                 energy = (push * push - multiplier_[k] * multiplier_[k]) / (2 * stiffness_[k]);
    value.energy += energy;
    value.summands += std::abs(energy);
    for (const auto& [v, weight] : walls_[k].of) value.gradient.col(v) -= push * weight * walls_[k].normal;
  }
}

double Walls::take(const Positions& moved) {
  double deepest = 0;
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    if (!(stiffness_[k] > 0)) continue;
    const double distance = beyond(k, moved);
    multiplier_[k] = std::max(multiplier_[k] - stiffness_[k] * distance, 0.0);
    deepest = std::max(deepest, -distance);
  }
  return deepest;
}

WallMetric::WallMetric(const Eigen::SparseMatrix<double>& metric, const std::vector<bool>& free,
                       const std::vector<HalfSpace>& walls, const std::vector<double>& stiffness) {
  std::vector<Triplet> pattern;
  const auto count = metric.cols();
  for (Index column = 0; column < count; ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(metric, column); it; ++it)
      pattern.emplace_back(static_cast<int>(it.row()), static_cast<int>(column), 1.0);
  for (const HalfSpace& wall : walls)
    for (const auto& [u, a] : wall.of)
      for (const auto& [v, b] : wall.of) pattern.emplace_back(static_cast<int>(u), static_cast<int>(v), 1.0);
  Eigen::SparseMatrix<double> joined(count, count);
  joined.setFromTriplets(pattern.begin(), pattern.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(joined, order);
  row_.assign(static_cast<std::size_t>(count), -1);
  Index next = 0;
  for (Index k = 0; k < count; ++k)
    if (const int v = order.indices()[k]; free[static_cast<std::size_t>(v)]) {
      row_[static_cast<std::size_t>(v)] = next;
      next += 3;
    }
  size_ = next;
  std::vector<Triplet> entries;
  const auto add = [&](Index u, Index v, int i, int j, double value) {
    const Index r = row_[static_cast<std::size_t>(u)] + i, c = row_[static_cast<std::size_t>(v)] + j;
    if (row_[static_cast<std::size_t>(u)] >= 0 && row_[static_cast<std::size_t>(v)] >= 0 && r >= c)
      entries.emplace_back(static_cast<int>(r), static_cast<int>(c), value);
  };
  for (Index column = 0; column < count; ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(metric, column); it; ++it)
      for (int i = 0; i < 3; ++i) add(it.row(), column, i, i, it.value());
  for (std::size_t k = 0; k < walls.size(); ++k)
    for (const auto& [u, a] : walls[k].of)
      for (const auto& [v, b] : walls[k].of)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            add(u, v, i, j, stiffness[k] * a * b * walls[k].normal[i] * walls[k].normal[j]);
  for (Index r = 0; r < size_; ++r) entries.emplace_back(static_cast<int>(r), static_cast<int>(r), 0.0);
  Eigen::SparseMatrix<double> lower(size_, size_);
  lower.setFromTriplets(entries.begin(), entries.end());
  cholesky_.analyse(lower);
  // As definite as the metric itself: walls add squares.
  if (!cholesky_.factorise(lower))
    throw Error(ExitCode::bad_input,
                "triangles of the rest shape are so thin or so unlike in size that double precision does not "
                "solve for a surface outside the bodies; a cleaner mesh is wanted");
}

Positions WallMetric::solve(const Positions& right) const {
  VectorXd own(size_);
  for (std::size_t v = 0; v < row_.size(); ++v)
    if (row_[v] >= 0) own.segment<3>(row_[v]) = right.col(static_cast<Index>(v));
  own = cholesky_.solve(own);
  Positions result = Positions::Zero(3, right.cols());
  for (std::size_t v = 0; v < row_.size(); ++v)
    if (row_[v] >= 0) result.col(static_cast<Index>(v)) = own.segment<3>(row_[v]);
  return result;
}

}  // namespace plisse::shell
