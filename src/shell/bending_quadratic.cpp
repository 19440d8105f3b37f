#include "shell/bending_quadratic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace plisse::shell {

using Eigen::Vector2d;
using Triplet = Eigen::Triplet<double>;

namespace {

// Areas of Voronoi cells clipped to a triangle, where it is not obtuse; halves and quarters where it is.
Eigen::Vector3d mixed_areas(const RestFace& rest) {
  // ∇λ_j·∇λ_k = −cot θ_i / 2A.
  Eigen::Vector3d cot;
  for (int i = 0; i < 3; ++i)
    cot[i] = -2 * rest.area * rest.gradients.col((i + 1) % 3).dot(rest.gradients.col((i + 2) % 3));
  for (int i = 0; i < 3; ++i)
    if (cot[i] < 0) {
      Eigen::Vector3d areas = Eigen::Vector3d::Constant(rest.area / 4);
      areas[i] = rest.area / 2;
      return areas;
    }
  // A corner has an eighth of cot θ_k |e_k|² of each of its two edges e_k; |e_k| = 2A |∇λ_k|.
  Eigen::Vector3d shares;
  for (int k = 0; k < 3; ++k)
    shares[k] = cot[k] * rest.gradients.col(k).squaredNorm() * rest.area * rest.area / 2;
  const Eigen::Vector3d areas = Eigen::Vector3d::Constant(shares.sum()) - shares;
  return areas;
}

}  // namespace

CellLaplacian cell_laplacian(const Topology& topology, const std::vector<RestFace>& rest) {
  const auto count = static_cast<Eigen::Index>(topology.vertex_count);
  std::vector<Triplet> entries;  // of L: ∫ Δ over the cell of each vertex
  entries.reserve(12 * topology.faces.size());
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(count);
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const Face& face = topology.faces[f];
    const RestFace& triangle = rest[f];
    const Eigen::Vector3d mixed = mixed_areas(triangle);
    const Eigen::Matrix3d stiffness = triangle.area * triangle.gradients.transpose() * triangle.gradients;
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<int>(face[static_cast<std::size_t>(i)]);
      areas[row] += mixed[i];
      for (int k = 0; k < 3; ++k)
        entries.emplace_back(row, static_cast<int>(face[static_cast<std::size_t>(k)]), -stiffness(i, k));
    }
    for (int i = 0; i < 3; ++i) {
      if (topology.flaps[f][static_cast<std::size_t>(i)] != none) continue;
      // The edge opposite to corner i; its outward normal times its length is −2A ∇λ_i.
      const Eigen::RowVector3d flux =
          -triangle.area * triangle.gradients.col(i).transpose() * triangle.gradients;  // half the edge's
      for (int end = 1; end < 3; ++end)
        for (int k = 0; k < 3; ++k)
          entries.emplace_back(static_cast<int>(face[static_cast<std::size_t>((i + end) % 3)]),
                               static_cast<int>(face[static_cast<std::size_t>(k)]), flux[k]);
    }
  }
  Eigen::SparseMatrix<double> integral(count, count);
  integral.setFromTriplets(entries.begin(), entries.end());
  return {std::move(integral), std::move(areas)};
}

Eigen::SparseMatrix<double> bending_quadratic(const Material& material, const Topology& topology,
                                              const std::vector<RestFace>& rest) {
  const auto [laplacian, areas] = cell_laplacian(topology, rest);
  Eigen::VectorXd inverse_areas = Eigen::VectorXd::Zero(areas.size());
  for (Eigen::Index v = 0; v < areas.size(); ++v)
    if (areas[v] > 0) inverse_areas[v] = 1 / areas[v];
  const Eigen::SparseMatrix<double> weighted = inverse_areas.asDiagonal() * laplacian;
  Eigen::SparseMatrix<double> energy = laplacian.transpose() * weighted;
  energy *= material.bending_stiffness();
  energy.makeCompressed();
  return energy;
}

}  // namespace plisse::shell
