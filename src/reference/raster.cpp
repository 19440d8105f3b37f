#include "reference/raster.h"

#include <algorithm>
#include <cmath>

namespace plisse::reference {

using Eigen::Matrix3d;
using Eigen::Vector3d;

RasterTriangle set_up(const Matrix3d& corners, const Eigen::Matrix4d& view_projection, int width,
                      int height) {
  RasterTriangle raster;
  const Eigen::Matrix<double, 4, 3> clip = view_projection * corners.colwise().homogeneous();
  Matrix3d C;
  C << clip.row(0), clip.row(1), clip.row(3);
  const double scale = C.col(0).norm() * C.col(1).norm() * C.col(2).norm();
  if (!(std::abs(C.determinant()) > 1e-14 * scale)) return raster;  // seen edge on, or without area

  Matrix3d to_ndc;  // (column, line, 1) → (X, Y, 1) at the pixel's centre
  to_ndc << 2.0 / width, 0, 1.0 / width - 1, 0, -2.0 / height, 1 - 1.0 / height, 0, 0, 1;
  raster.edges = C.inverse() * to_ndc;
  raster.edge_length = raster.edges.leftCols<2>().rowwise().norm();
  raster.depth = (clip.row(2) * raster.edges).transpose();
  raster.depth_slope = raster.depth.head<2>().norm();

  raster.drawn = true;
  raster.left = raster.top = 0;
  raster.right = width - 1;
  raster.bottom = height - 1;
  if (clip.row(3).minCoeff() > 0) {
    const Eigen::RowVector3d depth = clip.row(2).cwiseQuotient(clip.row(3));
    raster.nearest = depth.minCoeff();
    raster.farthest = depth.maxCoeff();
    const Eigen::RowVector3d x = (clip.row(0).cwiseQuotient(clip.row(3)).array() + 1) * 0.5 * width;
    const Eigen::RowVector3d y = (1 - clip.row(1).cwiseQuotient(clip.row(3)).array()) * 0.5 * height;
    const auto pixel = [](double value, int size) {
      return static_cast<int>(std::floor(std::clamp(value, -2.0, size + 2.0)));
    };
    raster.left = std::max(0, pixel(x.minCoeff(), width) - 1);
    raster.right = std::min(width - 1, pixel(x.maxCoeff(), width) + 1);
    raster.top = std::max(0, pixel(y.minCoeff(), height) - 1);
    raster.bottom = std::min(height - 1, pixel(y.maxCoeff(), height) + 1);
  }
  return raster;
}

void collect(const RasterTriangle& raster, int triangle, int line, double beyond,
             std::vector<Candidate>& candidates) {
  for (int column = raster.left; column <= raster.right; ++column) {
    const Vector3d pixel(column, line, 1);
    const Vector3d e = raster.edges * pixel;
    if (!(e.sum() > 0)) continue;  // behind the eye
    const double distance = e.cwiseQuotient(raster.edge_length).minCoeff();
    const double depth = raster.depth.dot(pixel);
    if (!(distance >= -reach) || std::abs(depth) > 1 + beyond) continue;
    candidates.push_back({column, triangle, depth, distance});
  }
}

Raster::Raster(const std::vector<Triangle>& scene, const Eigen::Matrix4d& view_projection, int width,
               int height)
    : lines(static_cast<std::size_t>(height)) {
  for (std::size_t i = 0; i < scene.size(); ++i) {
    triangles.push_back(set_up(scene[i].waves.corners, view_projection, width, height));
    if (!triangles.back().drawn) continue;
    for (int line = triangles.back().top; line <= triangles.back().bottom; ++line)
      lines[static_cast<std::size_t>(line)].push_back(static_cast<int>(i));
  }
}

std::vector<Candidate> Raster::candidates(int line, double beyond) const {
  std::vector<Candidate> found;
  for (const int triangle : lines[static_cast<std::size_t>(line)])
    collect(triangles[static_cast<std::size_t>(triangle)], triangle, line, beyond, found);
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    if (a.column != b.column) return a.column < b.column;
    return a.depth != b.depth ? a.depth < b.depth : a.triangle < b.triangle;
  });
  return found;
}

}  // namespace plisse::reference
