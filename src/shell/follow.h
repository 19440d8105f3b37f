// A wrinkle-free base surface for a shape that something else made: a frame of a cloth simulation or of a
// rig. It keeps what the mesh can carry, and hands the length that is lost in its zigzags to the waves of a
// field.
//
// For each frame, X its positions, the base has the least
//   E(x) = E_TF(x) + ½ b Σ m_i |(∇²x)_i − R_i (∇²x̄)_i|² + ½ c Σ m_i |x_i − X_i|²:
// tension field theory (Chen et al. 2021, appendix B), against which shortening costs nothing; bending from
// the rest shape's own curvature vectors ∇²x̄ (all second derivatives, over the rest shape; of inner
// vertices), turned by the given pose's rotations R_i; a tether to the pose. With b = c(Λ/2π)⁴ a ripple of
// wavelength λ in X keeps 1/(1 + (Λ/λ)⁴) of its height; with c = Yh/ℓ² tension wins over the tether on what
// is shorter than ℓ. Free boundaries have the same for themselves as curves, or hems would keep the
// simulation's sawtooth. E is convex, so that a base depends on its own frame alone; Y and h have no part in
// it, since they multiply all of E.
//
// A constant matrix serves for all frames: with t = Λk/2π a change of wave number k has the stiffness 1 + t⁴
// in bending and tether, and of the membrane at most (ℓk)²/(1 − ν²) = 5.6 t², which tension field theory has
// in part of the directions only. Of tether, bending and the whole membrane the rest is at least 2/7.6,
// whatever the mesh and Λ: limited-memory BFGS in that metric (Liu, Bouaziz and Kavan 2017) takes some twenty
// steps, each of one evaluation and one back-substitution.
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "shell/limited_memory.h"
#include "shell/material.h"
#include "shell/rest_shape.h"
#include "shell/vertex_solver.h"
#include "shell/walls.h"

namespace plisse::shell {

struct FollowSettings {
  double wavelength = 0;  // Λ, m; 0: the base is the pose
  double reach = 0.36;    // ℓ over Λ
  double poisson = 0.3;
  double tension_limit = 0.05;  // of StretchingLaw; 0: none
  // Of the second pass the target is the curvature of a first one, the pose smoothed by bending and tether
  // alone: a tube of n edges, sewn from flat panels, keeps g = 1/(1 + (8/n)⁴) of its radius in one at Λ = 8
  // edges, 1 − (1 − g)² of it in two.
  int passes = 2;
  int max_iterations = 400;
  double tolerance = 1e-9;  // converged where no vertex moves by more than this share of Λ
};

struct Followed {
  Positions base;                        // m, 3×V
  double moved_rms = 0, moved_most = 0;  // m, from the pose, over vertices with faces
  int iterations = 0;
  bool converged = false;
};

class Follower {
 public:
  // rest_positions: where the rest shape is in space, 3×V, whose curvature the base keeps; empty: flat
  // panels. Throws Error(bad_input) where counts do not agree.
  // held: one flag a vertex that stays where the pose has it; may be empty.
  Follower(Topology topology, std::vector<RestFace> rest, const Positions& rest_positions,
           const FollowSettings& settings, const std::vector<bool>& held = {});

  double wavelength() const { return settings_.wavelength; }  // Λ, m
  bool moves(std::uint32_t vertex) const { return free_[vertex]; }
  // Throws Error(bad_input) where the pose has another number of vertices or is not finite. May be called
  // from several threads. `start`: where the search begins, 3×V, on which its end does not depend; nothing:
  // the smoothed pose. outside: E with these, by an augmented Lagrangian; still one minimum, but found within
  // 1e-6 Λ, and points are let in by at most 1e-4 Λ where it converged.
  Followed follow(const Positions& pose, const Positions* start = nullptr,
                  const std::vector<HalfSpace>& outside = {}) const;

 private:
  // What the rest shape's own curvature, turned with the pose, is for the bending: N a vertex, 3×V.
  Positions turned_curvature(const Positions& pose) const;
  // E less what does not depend on x = X + u, J, and its gradient by u; `pull`: the gradient of bending at u
  // = 0, N.
  EnergyValue value(const Positions& pose, const Positions& moved, const Positions& pull) const;

  Topology topology_;
  std::vector<RestFace> rest_;
  FollowSettings settings_;
  std::vector<bool> free_;  // of each vertex: it has faces and is not held
  Material material_;       // of unit thickness and stiffness, with Poisson's ratio
  double tether_ = 0;       // c, N/m³
  Eigen::VectorXd areas_;   // m_i, m²
  // Curvature operators, a row each: three of the cell of an inner vertex, and one of the boundary curve at a
  // vertex; the weights of their squares, N/m; the vertices that they are of; their values for the rest
  // shape.
  Eigen::SparseMatrix<double> curvature_;
  Eigen::VectorXd weights_;
  std::vector<std::uint32_t> row_vertex_;
  Positions rest_curvature_;  // 3×rows; empty: flat
  std::vector<Eigen::Matrix3d>
      frames_;                        // of each rest face in space: its axes u, v and its normal; empty: flat
  Eigen::SparseMatrix<double> form_;  // their sum of squares, V×V, N/m
  std::optional<VertexSolver> smoothing_, metric_;  // bending and tether; and the membrane
  Eigen::SparseMatrix<double> matrix_;              // of the latter, V×V, N/m
};

}  // namespace plisse::shell
