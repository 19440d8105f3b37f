// Conversion of points between two libraries: GLM is used where surfaces are drawn and files are read, Eigen
// where equations are solved. A list of points in GLM is a 3 × n matrix in Eigen, one column a point.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace plisse {

inline glm::dvec3 to_glm(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

inline Eigen::Vector3d to_eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

inline Eigen::Matrix4d to_eigen(const glm::dmat4& m) {
  Eigen::Matrix4d result;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) result(row, column) = m[column][row];
  return result;
}

inline std::vector<glm::dvec3> points_to_glm(const Eigen::Matrix3Xd& columns) {
  std::vector<glm::dvec3> points;
  points.reserve(static_cast<std::size_t>(columns.cols()));
  for (Eigen::Index v = 0; v < columns.cols(); ++v) points.push_back(to_glm(columns.col(v)));
  return points;
}

inline Eigen::Matrix3Xd points_to_eigen(const std::vector<glm::dvec3>& points) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t v = 0; v < points.size(); ++v)
    columns.col(static_cast<Eigen::Index>(v)) = to_eigen(points[v]);
  return columns;
}

}  // namespace plisse
