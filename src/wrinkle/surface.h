// The base surface of the wrinkles, and the data of each face for the wrinkle energy.
//
// 2×2 matrices and 2-vectors of a face are components in the orthonormal frame of its rest shape
// (shell::RestFace), so that I_u is the identity and M is the paper's I_u⁻¹M.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "shell/fundamental_forms.h"
#include "shell/rest_shape.h"
#include "shell/topology.h"

namespace plisse::wrinkle {

struct BaseSurface {
  shell::Topology topology;
  std::vector<shell::RestFace> rest;  // one a face
  shell::Positions positions;         // r_b, metres, one column a vertex
};

struct FaceForms {
  shell::RestFace rest;
  Eigen::Matrix2d strain = Eigen::Matrix2d::Zero();       // I_u⁻¹I_b − id: twice the Green strain
  Eigen::Matrix2d second_form = Eigen::Matrix2d::Zero();  // II_b, 1/m
  double noise = 0;                                       // compression up to this is none (facets.h)
  // m: the largest amplitude at each corner; finite where a body is near, which waves are not to enter.
  std::array<double, 3> room{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::infinity()};
};

// The direction in which waves travel: the unit eigenvector ŵ of the strain's smaller eigenvalue λ₂ (eq. 29),
// of either sign.
struct PrincipalStrain {
  double tension = 0, compression = 0;  // λ₁ ≥ λ₂
  Eigen::Vector2d wave, crest;          // ŵ, ŵ⊥
};
PrincipalStrain principal_strain(const FaceForms& forms);

// How II_b is estimated.
struct CurvatureFit {
  enum Kind {
    quadratic,  // a mean of the corners' curvatures, each from a quadratic through the vertices round it
                // (E.3)
    mid_edge    // from the mid-edge normals of the face's three edges (appendix A)
  };
  Kind kind = quadratic;
  int edges = 2;  // quadratic: how far vertices may be from the corner
};

// Throws Error(bad_input) where positions are not finite or do not match the topology.
std::vector<FaceForms> face_forms(const BaseSurface& surface, CurvatureFit fit = {});

// Side i of a face leads from its corner i to corner i + 1 (mod 3).
inline std::uint32_t side_edge(const shell::Topology& topology, std::size_t face, std::size_t side) {
  return topology.face_edges[face][(side + 2) % 3];
}
// +1 where the side runs as its edge does, from the smaller vertex to the larger; else −1.
inline double side_sign(const shell::Topology& topology, std::size_t face, std::size_t side) {
  const shell::Face& f = topology.faces[face];
  return f[side] < f[(side + 1) % 3] ? 1 : -1;
}
// The face across a side; shell::none where there is none.
inline std::uint32_t across(const shell::Topology& topology, std::size_t face, std::size_t side) {
  const auto& both = topology.edges[side_edge(topology, face, side)].face;
  return both[0] == face ? both[1] : both[0];
}

}  // namespace plisse::wrinkle
