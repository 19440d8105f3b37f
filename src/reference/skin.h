// Reference of the skin pass (Loviscach 2006, section 4.1; docs/passes.md, "Skin"): posed positions and
// frames.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <vector>

#include "reference/topology.h"

namespace plisse::reference {

struct Influences {
  std::array<std::uint32_t, 8> entry{};  // index into the palette
  std::array<double, 8> weight{};        // α, sum 1; 0 = unused
};

// Data of the vertices that does not change over time.
struct SkinModel {
  Eigen::Matrix3Xd bind;                 // x_bind
  Eigen::Matrix3Xd bind_normal;          // unit; used only where the triangles define no normal
  std::vector<Influences> influences;    // one per vertex
  std::vector<Eigen::Matrix3Xd> deltas;  // δ_t, one 3 × V array per morph target
};

// Data that changes: affine maps (upper three rows of the 4 × 4) and one weight per morph target.
struct SkinPose {
  std::vector<Eigen::Matrix4d> palette;
  std::vector<double> morph_weights;
};

// Σ αₖ Mₖ of one vertex.
Eigen::Matrix4d blended_matrix(const SkinModel& model, const SkinPose& pose, Eigen::Index vertex);

// x' = Σ αₖ Mₖ (x_bind + Σ_t m_t δ_t).
Eigen::Matrix3Xd skin_positions(const SkinModel& model, const SkinPose& pose);

// cof(A): columns c₁×c₂, c₂×c₀, c₀×c₁ for the columns c of A; cof(A)(u×v) = Au × Av.
Eigen::Matrix3d cofactor(const Eigen::Matrix3d& A);

// n' from the triangles' areas; where these cancel to less than 1e-6 of Σ|e||e|, cof(linear[v])·bind_normal,
// and where that is zero as well, bind_normal. `linear` holds Σ αₖ Mₖ's linear part per vertex.
Eigen::Matrix3Xd skin_normals(const Topology& topology, const Eigen::Matrix3Xd& positions,
                              const std::vector<Eigen::Matrix3d>& linear,
                              const Eigen::Matrix3Xd& bind_normal);

// The neighbour to which t points: the one with the longest tangential part in the rest pose, on ties the
// smaller id; the vertex itself where it has no neighbour.
std::vector<std::uint32_t> tangent_neighbours(const Topology& topology, const Eigen::Matrix3Xd& rest_normals);

// Tangents toward those neighbours, made perpendicular to the normals (docs/passes.md says what holds without
// a neighbour).
Eigen::Matrix3Xd skin_tangents(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& normals,
                               const std::vector<std::uint32_t>& tangent_neighbour);

// Frames of the rest pose: area normals of topology.rest, or bind_normal where the areas cancel.
Frames rest_frames(const Topology& topology, const Eigen::Matrix3Xd& bind_normal);

struct SkinResult {
  Eigen::Matrix3Xd positions;  // x'
  Frames frames;               // n', t'
};

// The whole pass. `tangent_neighbour` comes from the rest pose.
SkinResult skin(const Topology& topology, const SkinModel& model, const SkinPose& pose,
                const std::vector<std::uint32_t>& tangent_neighbour);

}  // namespace plisse::reference
