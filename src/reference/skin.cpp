#include "reference/skin.h"

#include <cmath>

namespace plisse::reference {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Matrix4d;
using Eigen::Vector3d;

Matrix4d blended_matrix(const SkinModel& model, const SkinPose& pose, Index vertex) {
  const Influences& influences = model.influences[static_cast<std::size_t>(vertex)];
  Matrix4d sum = Matrix4d::Zero();
  for (std::size_t k = 0; k < influences.weight.size(); ++k)
    if (influences.weight[k] != 0) sum += influences.weight[k] * pose.palette[influences.entry[k]];
  return sum;
}

Matrix3Xd skin_positions(const SkinModel& model, const SkinPose& pose) {
  Matrix3Xd morphed = model.bind;
  for (std::size_t t = 0; t < model.deltas.size(); ++t) morphed += pose.morph_weights[t] * model.deltas[t];
  Matrix3Xd positions(3, morphed.cols());
  for (Index v = 0; v < morphed.cols(); ++v)
    positions.col(v) = (blended_matrix(model, pose, v) * morphed.col(v).homogeneous()).head<3>();
  return positions;
}

Matrix3d cofactor(const Matrix3d& A) {
  Matrix3d cof;
  cof << A.col(1).cross(A.col(2)), A.col(2).cross(A.col(0)), A.col(0).cross(A.col(1));
  return cof;
}

Matrix3Xd skin_normals(const Topology& topology, const Matrix3Xd& positions,
                       const std::vector<Matrix3d>& linear, const Matrix3Xd& bind_normal) {
  Matrix3Xd normals(3, positions.cols());
  for (Index v = 0; v < positions.cols(); ++v) {
    Vector3d area = Vector3d::Zero();
    double scale = 0;
    for (const Corner& corner : row(topology.corners, v)) {
      const Vector3d second = positions.col(corner.second) - positions.col(v);
      const Vector3d third = positions.col(corner.third) - positions.col(v);
      area += second.cross(third);
      scale += second.norm() * third.norm();
    }
    if (area.norm() > 1e-6 * scale) {
      normals.col(v) = area.normalized();
      continue;
    }
    const Vector3d moved = cofactor(linear[static_cast<std::size_t>(v)]) * bind_normal.col(v);
    normals.col(v) = moved.norm() > 0 ? moved.normalized() : bind_normal.col(v);
  }
  return normals;
}

std::vector<std::uint32_t> tangent_neighbours(const Topology& topology, const Matrix3Xd& rest_normals) {
  std::vector<std::uint32_t> chosen(static_cast<std::size_t>(topology.size()));
  for (Index v = 0; v < topology.size(); ++v) {
    auto best = static_cast<std::uint32_t>(v);
    double longest = -1;
    for (const std::uint32_t i : row(topology.neighbours, v)) {
      const Vector3d edge = topology.rest.col(i) - topology.rest.col(v);
      const Vector3d n = rest_normals.col(v);
      const double length = (edge - edge.dot(n) * n).squaredNorm();
      if (length > longest) {
        longest = length;
        best = i;
      }
    }
    chosen[static_cast<std::size_t>(v)] = best;
  }
  return chosen;
}

namespace {

// The coordinate axis with the smallest |component| of n (the first on ties), made perpendicular to n.
Vector3d any_tangent(const Vector3d& n) {
  Index axis = 0;
  n.cwiseAbs().minCoeff(&axis);  // the first minimum
  const Vector3d e = Vector3d::Unit(axis);
  return (e - e.dot(n) * n).normalized();
}

}  // namespace

Matrix3Xd skin_tangents(const Matrix3Xd& positions, const Matrix3Xd& normals,
                        const std::vector<std::uint32_t>& tangent_neighbour) {
  Matrix3Xd tangents(3, positions.cols());
  for (Index v = 0; v < positions.cols(); ++v) {
    const Vector3d n = normals.col(v);
    const Vector3d edge = positions.col(tangent_neighbour[static_cast<std::size_t>(v)]) - positions.col(v);
    const Vector3d tangential = edge - edge.dot(n) * n;
    tangents.col(v) =
        tangential.squaredNorm() > 1e-12 * edge.squaredNorm() ? tangential.normalized() : any_tangent(n);
  }
  return tangents;
}

Frames rest_frames(const Topology& topology, const Matrix3Xd& bind_normal) {
  const std::vector<Matrix3d> unmoved(static_cast<std::size_t>(topology.size()), Matrix3d::Identity());
  Frames frames;
  frames.normal = skin_normals(topology, topology.rest, unmoved, bind_normal);
  frames.tangent = skin_tangents(topology.rest, frames.normal, tangent_neighbours(topology, frames.normal));
  return frames;
}

SkinResult skin(const Topology& topology, const SkinModel& model, const SkinPose& pose,
                const std::vector<std::uint32_t>& tangent_neighbour) {
  SkinResult result;
  result.positions = skin_positions(model, pose);
  std::vector<Matrix3d> linear;
  linear.reserve(static_cast<std::size_t>(topology.size()));
  for (Index v = 0; v < topology.size(); ++v)
    linear.push_back(blended_matrix(model, pose, v).topLeftCorner<3, 3>());
  result.frames.normal = skin_normals(topology, result.positions, linear, model.bind_normal);
  result.frames.tangent = skin_tangents(result.positions, result.frames.normal, tangent_neighbour);
  return result;
}

}  // namespace plisse::reference
