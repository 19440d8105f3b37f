// Half-spaces that points of a shell may not leave, in the search for the least of an energy, as an augmented
// Lagrangian (M. Hestenes 1969, M. Powell 1969).
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <utility>
#include <vector>

#include "shell/cholesky.h"
#include "shell/limited_memory.h"
#include "shell/rest_shape.h"

namespace plisse::shell {

// Where a point of a surface, Σ weight · vertex, may be: n·x ≥ least, m; n of length 1, out of a body.
struct HalfSpace {
  std::vector<std::pair<std::uint32_t, double>> of;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();
  double least = 0;
};

// Of each the multiplier p, N, and the stiffness k, N/m, of what is added to the energy, (max(0, p − kd)² −
// p²)/2k at a distance d beyond its plane.
class Walls {
 public:
  // stiffness: of the energy's known matrix at each vertex, N/m. Walls whose vertices are all held do
  // nothing.
  Walls(const std::vector<HalfSpace>& walls, const Positions& pose, const Eigen::VectorXd& stiffness,
        const std::vector<bool>& free);

  void add(const Positions& moved, EnergyValue& value) const;
  // Takes the pushes at the end of a search as multipliers. How far points are let in, m.
  double take(const Positions& moved);

  const std::vector<double>& stiffness() const { return stiffness_; }

 private:
  double beyond(std::size_t k, const Positions& moved) const;
  const std::vector<HalfSpace>& walls_;
  std::vector<double> multiplier_, stiffness_, distance_;  // the last: where nothing has moved
};

// The metric with walls: the known matrix for each coordinate, and the walls' stiffness across them.
class WallMetric {
 public:
  // Throws Error(bad_input) where rounding leaves the matrix not positive definite.
  WallMetric(const Eigen::SparseMatrix<double>& metric, const std::vector<bool>& free,
             const std::vector<HalfSpace>& walls, const std::vector<double>& stiffness);
  Positions solve(const Positions& right) const;

 private:
  std::vector<Eigen::Index> row_;  // of each vertex' first coordinate, −1 where it is held
  Eigen::Index size_ = 0;
  Cholesky cholesky_;
};

}  // namespace plisse::shell
