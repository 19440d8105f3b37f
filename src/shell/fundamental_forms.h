// First and second fundamental forms of a triangle, constant on it (Chen et al. 2021, appendix A), and its
// principal strains. All in the orthonormal coordinates of its rest shape, where I_u is the identity.
#pragma once

#include <Eigen/Core>
#include <array>

#include "shell/rest_shape.h"

namespace plisse::shell {

using Corners = Eigen::Matrix3d;  // of a triangle in space, one a column, m

// dr, 3×2: what rest coordinates become in space.
Eigen::Matrix<double, 3, 2> deformation_gradient(const RestFace& rest, const Corners& corners);

// I = drᵀ dr.
Eigen::Matrix2d first_form(const RestFace& rest, const Corners& corners);

// Eigenvalues and orthonormal eigenvectors of a symmetric 2×2 matrix, the larger first; where both are equal
// the vectors are the axes.
struct Principal {
  Eigen::Vector2d value;
  Eigen::Matrix2d direction;  // columns
};
Principal principal(const Eigen::Matrix2d& symmetric);

// λ₁ ≥ λ₂ of I − I_u: twice the Green strain, and their directions in rest coordinates.
Principal principal_strain(const RestFace& rest, const Corners& corners);

// II = −drᵀ dn from mid-edge normals, 1/m; positive where the surface bends toward its normal. `across[i]`:
// the vertex beyond the edge opposite to corner i; not used where `has[i]` is false: there the mid-edge
// normal is the face's own. Elsewhere it is the *unit* vector halfway between the two faces' normals. (The
// appendix averages without normalising; for a bending angle θ the authors' code has tan θ/2 where this has
// sin θ/2; all agree to O(θ³).)
Eigen::Matrix2d second_form(const RestFace& rest, const Corners& corners, const Corners& across,
                            const std::array<bool, 3>& has);

// The forms of all faces of a shell.
std::vector<Eigen::Matrix2d> first_forms(const Topology& topology, const std::vector<RestFace>& rest,
                                         const Positions& positions);
std::vector<Eigen::Matrix2d> second_forms(const Topology& topology, const std::vector<RestFace>& rest,
                                          const Positions& positions);

Corners corners_of(const Face& face, const Positions& positions);

}  // namespace plisse::shell
