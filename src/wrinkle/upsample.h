// A wrinkle field as geometry (Z. Chen et al., Fine Wrinkling on Coarsely Meshed Thin Shells, ACM TOG 2021,
// section E.5): base surface, amplitude and phase by Loop subdivision to the limit surface, then displaced by
// (19).
//
// Faces with amplitude 0 at all corners have no waves and stay flat: amplitudes are 0 on all their small
// triangles, including the edges, as if the faces were cut out. Phases are subdivided in the branch of one
// face (mesh/corner_field.h), so jumps stay whole turns.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "wrinkle/energy.h"
#include "wrinkle/surface.h"

namespace plisse::wrinkle {

// A field on a base surface, as solve_field gives it.
struct CoarseField {
  Eigen::VectorXd amplitude;                 // a, metres, one a vertex
  std::vector<std::array<double, 3>> phase;  // φ, radians, one a corner
};

struct FineField {
  std::vector<shell::Face> faces;
  std::vector<std::uint32_t> base_face;  // of the base surface, for each face
  shell::Positions positions;            // on the limit surface, metres
  Eigen::Matrix3Xd normals;              // unit
  Eigen::VectorXd amplitude;             // metres
  Eigen::VectorXd phase;                 // radians, of any branch; 0 where there are no waves
  Eigen::Matrix3Xd gradient;             // of the phase along the surface, radians per metre
  Eigen::Matrix3Xd lean;  // dr_b I_b⁻¹v of (17): v₁/a; no columns where it was not requested
  std::vector<std::array<Eigen::Vector2d, 3>> uv;  // of corners; empty where none were given
};

// Further data to subdivide with the base surface. Empty: without.
struct Extras {
  Eigen::Matrix3Xd lean;                           // one column a vertex of the base surface, see leaning()
  std::vector<std::array<Eigen::Vector2d, 3>> uv;  // one a corner; continuous where both ends of a side agree
};

// Every edge halved `levels` times. Corners of the boundary that turn by more than 60 degrees at rest stay
// sharp. Throws Error(bad_input) where the surface is not manifold, or the field is another surface's or not
// finite.
FineField upsample(const BaseSurface& surface, const CoarseField& field, int levels,
                   const Extras& extras = {});

// Points of the limit surface, those of every edge halved `levels` times, as combinations of the vertices: a
// row each. Throws as upsample does.
Eigen::SparseMatrix<double, Eigen::RowMajor> limit_points(const shell::Topology& topology,
                                                          const std::vector<shell::RestFace>& rest,
                                                          int levels);

// (17) at each vertex, the faces' mean by area and a².
Eigen::Matrix3Xd leaning(const BaseSurface& surface, const std::vector<FaceForms>& forms, double poisson,
                         const CoarseField& field);

// The factor of a²∇φ sin 2φ in the tangential displacement for waves of slope a|∇φ|: ⅛ (19), but beyond a
// slope of 2 reduced so that cloth does not fold over itself.
double tangential_shift(double slope);

// r_b + a sin φ v + tangential_shift a² sin 2φ ∇φ + a cos φ n (19): positions, metres; with_v2: whether with
// the third term. The second is there where the field has `lean`.
shell::Positions displaced(const FineField& field, bool with_v2 = true);

// Unit normals of a mesh, the mean of the faces' round a vertex by area.
Eigen::Matrix3Xd vertex_normals(const std::vector<shell::Face>& faces, const shell::Positions& positions);

// Radians: the largest difference of phase along a side whose ends have more than a hundredth of the largest
// amplitude.
double largest_step(const BaseSurface& surface, const CoarseField& field);

}  // namespace plisse::wrinkle
