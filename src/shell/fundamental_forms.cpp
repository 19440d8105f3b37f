#include "shell/fundamental_forms.h"

#include <Eigen/Geometry>
#include <cmath>

namespace plisse::shell {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Eigen::Matrix<double, 3, 2> deformation_gradient(const RestFace& rest, const Corners& corners) {
  return corners * rest.gradients.transpose();
}

Matrix2d first_form(const RestFace& rest, const Corners& corners) {
  const Eigen::Matrix<double, 3, 2> dr = deformation_gradient(rest, corners);
  return dr.transpose() * dr;
}

Principal principal(const Matrix2d& symmetric) {
  const double mean = 0.5 * (symmetric(0, 0) + symmetric(1, 1));
  const double difference = 0.5 * (symmetric(0, 0) - symmetric(1, 1));
  const double radius = std::hypot(difference, symmetric(0, 1));
  const double angle = radius > 0 ? 0.5 * std::atan2(symmetric(0, 1), difference) : 0;
  Principal result;
  result.value << mean + radius, mean - radius;
  result.direction << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return result;
}

Principal principal_strain(const RestFace& rest, const Corners& corners) {
  return principal(first_form(rest, corners) - Matrix2d::Identity());
}

Matrix2d second_form(const RestFace& rest, const Corners& corners, const Corners& across,
                     const std::array<bool, 3>& has) {
  const Vector3d area = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
  const double twice_area = area.norm();
  if (!(twice_area > 0)) return Matrix2d::Zero();
  const Vector3d normal = area / twice_area;
  Matrix2d form = Matrix2d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (!has[static_cast<std::size_t>(i)]) continue;
    const Vector3d from = corners.col((i + 1) % 3), edge = corners.col((i + 2) % 3) - from;
    const Vector3d beyond = (across.col(i) - from).cross(edge);
    const Vector3d middle = normal.normalized() + beyond.normalized();
    const double length = middle.norm();
    if (!(length > 0)) continue;  // folded flat onto itself: the mean normal is undefined
    // Edges from corner i to the edge all rise by (corner i+1 − corner i)·n_i over the mid-edge normal n_i.
    const double rise = (from - corners.col(i)).dot(middle) / length;
    form -= 2 * rise * rest.gradients.col(i) * rest.gradients.col(i).transpose();
  }
  return form;
}

Corners corners_of(const Face& face, const Positions& positions) {
  Corners corners;
  for (int k = 0; k < 3; ++k) corners.col(k) = positions.col(face[static_cast<std::size_t>(k)]);
  return corners;
}

std::vector<Matrix2d> first_forms(const Topology& topology, const std::vector<RestFace>& rest,
                                  const Positions& positions) {
  std::vector<Matrix2d> forms;
  forms.reserve(topology.faces.size());
  for (std::size_t f = 0; f < topology.faces.size(); ++f)
    forms.push_back(first_form(rest[f], corners_of(topology.faces[f], positions)));
  return forms;
}

std::vector<Matrix2d> second_forms(const Topology& topology, const std::vector<RestFace>& rest,
                                   const Positions& positions) {
  std::vector<Matrix2d> forms;
  forms.reserve(topology.faces.size());
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    Corners across = Corners::Zero();
    std::array<bool, 3> has{};
    for (std::size_t i = 0; i < 3; ++i) {
      has[i] = topology.flaps[f][i] != none;
      if (has[i]) across.col(static_cast<int>(i)) = positions.col(topology.flaps[f][i]);
    }
    forms.push_back(second_form(rest[f], corners_of(topology.faces[f], positions), across, has));
  }
  return forms;
}

}  // namespace plisse::shell
