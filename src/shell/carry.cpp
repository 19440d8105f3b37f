#include "shell/carry.h"

#include <Eigen/SparseCholesky>
#include <vector>

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

}  // namespace plisse::shell
