#include "shell/carry.h"

#include <tbb/parallel_for.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <type_traits>

namespace plisse::shell {

Positions carried(const Shell& shell, const Conditions& conditions, const Positions& positions) {
  Positions result = positions;
  const Topology& topology = shell.topology;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(positions.cols());
    std::vector<bool> holds(topology.component_count, false);
    for (std::uint32_t v = 0; v < topology.vertex_count; ++v) {
      if (!conditions.held(axis, v)) continue;
      moved[v] = conditions.at(axis, v) - positions(axis, v);
      result(axis, v) = conditions.at(axis, v);
      if (topology.component[v] != none) holds[topology.component[v]] = true;
    }
    if (moved.cwiseAbs().maxCoeff() == 0) continue;
    std::vector<int> unknown(topology.vertex_count, -1);
    int count = 0;
    for (std::uint32_t v = 0; v < topology.vertex_count; ++v)
      if (!conditions.held(axis, v) && topology.component[v] != none && holds[topology.component[v]])
        unknown[v] = count++;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (std::size_t f = 0; f < topology.faces.size(); ++f) {
      const RestFace& rest = shell.rest[f];
      const Eigen::Matrix3d stiffness = rest.area * rest.gradients.transpose() * rest.gradients;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t row = topology.faces[f][static_cast<std::size_t>(k)];
        if (unknown[row] < 0) continue;
        for (int l = 0; l < 3; ++l) {
          const std::uint32_t column = topology.faces[f][static_cast<std::size_t>(l)];
          if (unknown[column] >= 0) {
            entries.emplace_back(unknown[row], unknown[column], stiffness(k, l));
          } else {
            right[unknown[row]] -= stiffness(k, l) * moved[column];
          }
        }
      }
    }
    Eigen::SparseMatrix<double> laplacian(count, count);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(laplacian);
    if (factor.info() != Eigen::Success) continue;
    const Eigen::VectorXd extension = factor.solve(right);
    if (!extension.allFinite()) continue;
    for (std::uint32_t v = 0; v < topology.vertex_count; ++v)
      if (unknown[v] >= 0) result(axis, v) += extension[unknown[v]];
  }
  return result;
}

std::optional<Positions> followed(const std::vector<Obstacle>& before, const std::vector<Obstacle>& after,
                                  const Conditions& conditions, const Positions& positions) {
  Positions result = positions;
  std::atomic<bool> fine = true;
  tbb::parallel_for(Eigen::Index{0}, positions.cols(), [&](Eigen::Index v) {
    if (conditions.held.col(v).all() || !fine) return;
    const Eigen::Vector3d from = positions.col(v);
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    std::vector<double> least(before.size());
    for (std::size_t o = 0; o < before.size(); ++o) {
      const Distance was = distance(before[o], from);
      least[o] = std::min(0.2 * was.value, 1e-3);
      const Distance moved =
          distance(after[o], from - was.value * was.first);  // the surface that was beside it
      if (moved.value == 0) continue;
      // The direction out of the body has reversed: the point is nearer to its other side.
      if (moved.first.dot(was.first) < -0.1) fine = false;
      const double motion = std::abs(moved.value), beside = std::max(was.value, 0.0);
      shift -= moved.value / (1 + beside / (2 * motion)) * moved.first;
    }
    for (int axis = 0; axis < 3; ++axis)
      if (!conditions.held(axis, v)) result(axis, v) += shift[axis];
    for (std::size_t o = 0; o < after.size(); ++o)
      if (distance(after[o], result.col(v)).value < least[o]) fine = false;
  });
  if (!fine) return std::nullopt;
  return result;
}

Eigen::Vector3d carried_along(const Obstacle& before, const Obstacle& after, const Eigen::Vector3d& point) {
  return std::visit(
      [&](const auto& one) -> Eigen::Vector3d {
        using Solid = std::decay_t<decltype(one)>;
        const auto& other = std::get<Solid>(after);
        if constexpr (std::is_same_v<Solid, Body>) {
          const auto nearest = one->tree().nearest(point);
          return point + other->tree().corners(nearest.triangle) * nearest.weights - nearest.point;
        } else {
          return one.carried_along(other, point);
        }
      },
      before);
}

}  // namespace plisse::shell
