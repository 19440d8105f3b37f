// Bending energy that is quadratic in the positions, for shells that are flat at rest (Bergou et al. 2006;
// Chen et al. 2021, eq. 28).
#pragma once

#include <Eigen/SparseCore>

#include "shell/material.h"
#include "shell/rest_shape.h"

namespace plisse::shell {

// ∫ Δ_u over the cell of each vertex: `integral` L, V×V, with the flux through free boundaries, and the
// cells' areas, m²; (Δ_u r)_i = (L r)_i / area_i.
struct CellLaplacian {
  Eigen::SparseMatrix<double> integral;
  Eigen::VectorXd areas;
};
CellLaplacian cell_laplacian(const Topology& topology, const std::vector<RestFace>& rest);

// Q, V×V, so that the energy is ½ Σ over x, y, z of xᵀ Q x, J: B/2 ∫ |Δ_u r|² dA, where eq. 28 has α for
// B = Y h³/12(1−ν²) = (h³/12)(α + 2β); α would be 0 for ν = 0. Δ_u is the cotangent Laplacian over the rest
// triangles with lumped masses of mixed Voronoi areas (Meyer et al. 2003), with which it is exact for
// quadratic functions on regular meshes, the right-angled ones with either diagonal included.
//
// At free boundaries the flux through the boundary is that of the triangle there, so that linear functions
// have no energy: a flat or rigidly moved shell has none, and the curvature across a free edge is taken as 0,
// as on a plate with a free edge (Wang et al. 2015 has a correction for the same purpose). Seams of sewn
// panels are not boundaries.
Eigen::SparseMatrix<double> bending_quadratic(const Material& material, const Topology& topology,
                                              const std::vector<RestFace>& rest);

}  // namespace plisse::shell
