#include "shell/rest_shape.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "base/error.h"

namespace plisse::shell {

RestFace rest_face(const Eigen::Matrix<double, 2, 3>& corners, std::size_t face) {
  RestFace rest;
  rest.edges << corners.col(1) - corners.col(0), corners.col(2) - corners.col(0);
  if (rest.edges.determinant() < 0) rest.edges.row(1) *= -1;
  rest.area = 0.5 * rest.edges.determinant();
  const double longest = std::max({rest.edges.col(0).squaredNorm(), rest.edges.col(1).squaredNorm(),
                                   (corners.col(2) - corners.col(1)).squaredNorm()});
  if (!(rest.area > 1e-12 * longest) || !rest.edges.allFinite())
    throw Error(ExitCode::bad_input, fmt::format("rest triangle {} has no area (corners within {:.3g} m)",
                                                 face, std::sqrt(longest)));
  const Eigen::Matrix2d inverse = rest.edges.inverse();
  rest.gradients.col(1) = inverse.row(0);
  rest.gradients.col(2) = inverse.row(1);
  rest.gradients.col(0) = -rest.gradients.col(1) - rest.gradients.col(2);
  return rest;
}

RestFace rest_face(const Eigen::Matrix3d& corners, std::size_t face) {
  const Eigen::Vector3d first = corners.col(1) - corners.col(0), second = corners.col(2) - corners.col(0);
  const double length = first.norm();
  Eigen::Matrix<double, 2, 3> flat = Eigen::Matrix<double, 2, 3>::Zero();
  flat(0, 1) = length;
  if (length > 0) {
    flat(0, 2) = first.dot(second) / length;
    flat(1, 2) = first.cross(second).norm() / length;
  }
  return rest_face(flat, face);
}

std::vector<RestFace> rest_faces(const Positions& rest, const std::vector<Face>& rest_of_faces) {
  std::vector<RestFace> faces;
  faces.reserve(rest_of_faces.size());
  for (std::size_t f = 0; f < rest_of_faces.size(); ++f) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = rest.col(rest_of_faces[f][static_cast<std::size_t>(k)]);
    faces.push_back(rest_face(corners, f));
  }
  return faces;
}

Eigen::VectorXd vertex_areas(const Topology& topology, const std::vector<RestFace>& rest) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(topology.vertex_count);
  for (std::size_t f = 0; f < topology.faces.size(); ++f)
    for (const std::uint32_t v : topology.faces[f]) areas[v] += rest[f].area / 3;
  return areas;
}

}  // namespace plisse::shell
