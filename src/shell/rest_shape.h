// The strain-free shape of a shell: the shape of each triangle without forces.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "shell/topology.h"

namespace plisse::shell {

// Positions of vertices, one a column, metres; its data in order are the unknowns x₀ y₀ z₀ x₁ …
using Positions = Eigen::Matrix3Xd;

// A rest triangle in orthonormal coordinates (u, v) of its own plane, so that there I_u is the identity.
struct RestFace {
  Eigen::Matrix2d edges;                  // columns: corner 1 − corner 0, corner 2 − corner 0, m
  Eigen::Matrix<double, 2, 3> gradients;  // column k: ∇ of the hat function of corner k, 1/m
  double area = 0;                        // m², > 0
};

// Corners of one rest triangle in space, one a column; u runs along the first edge. Throws Error(bad_input)
// naming `face` where it has no area (less than 1e-12 of its longest edge squared) or is not finite.
RestFace rest_face(const Eigen::Matrix3d& corners, std::size_t face);

// The same, but with u and v the coordinates that are given: flat panels keep their grain. A triangle that
// runs clockwise is mirrored (v turned over).
RestFace rest_face(const Eigen::Matrix<double, 2, 3>& corners, std::size_t face);

// Rest triangles may be cut apart where base faces share vertices: sewn panels. Face i, corner j of both
// belong together (the one link between the two).
std::vector<RestFace> rest_faces(const Positions& rest, const std::vector<Face>& rest_of_faces);

// Rest area that hangs on each vertex of the base, a third of every face's, m².
Eigen::VectorXd vertex_areas(const Topology& topology, const std::vector<RestFace>& rest);

}  // namespace plisse::shell
