// Second fundamental forms by quadratic fitting (Chen et al. 2021, section E.3, after D. Panozzo, E. Puppo,
// L. Rocca, Efficient multi-scale curvature and crease estimation, 2010).
#include "wrinkle/surface.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector3d;

// Faces round every vertex.
std::vector<std::vector<std::uint32_t>> faces_round(const shell::Topology& topology) {
  std::vector<std::vector<std::uint32_t>> faces(topology.vertex_count);
  for (std::uint32_t f = 0; f < topology.faces.size(); ++f) {
    for (const std::uint32_t v : topology.faces[f]) faces[v].push_back(f);
  }
  return faces;
}

// Vertices that can be reached over so many edges, the vertex itself first.
std::vector<std::uint32_t> vertices_near(const shell::Topology& topology, std::uint32_t from,
                                         const std::vector<std::vector<std::uint32_t>>& faces, int edges,
                                         std::vector<std::uint32_t>& seen_from) {
  std::vector<std::uint32_t> found{from};
  seen_from[from] = from;
  std::size_t begin = 0;
  for (int r = 0; r < edges; ++r) {
    const std::size_t end = found.size();
    for (; begin < end; ++begin) {
      for (const std::uint32_t f : faces[found[begin]]) {
        for (const std::uint32_t v : topology.faces[f]) {
          if (seen_from[v] == from) continue;
          seen_from[v] = from;
          found.push_back(v);
        }
      }
    }
  }
  return found;
}

// Area normals, unit; 0 where the faces round a vertex cancel.
Eigen::Matrix3Xd vertex_normals(const BaseSurface& surface) {
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, surface.positions.cols());
  for (const shell::Face& face : surface.topology.faces) {
    const shell::Corners c = shell::corners_of(face, surface.positions);
    const Vector3d normal = Vector3d(c.col(1) - c.col(0)).cross(Vector3d(c.col(2) - c.col(0)));
    for (const std::uint32_t v : face) normals.col(v) += normal;
  }
  normals.colwise().normalize();
  return normals;
}

// −dn as a symmetric form on space vectors, 1/m, from the quadratic through a vertex and those near it. 0
// where the vertex has no normal.
Eigen::Matrix3d fitted_curvature(const BaseSurface& surface, const Eigen::Matrix3Xd& normals,
                                 const std::vector<std::uint32_t>& near) {
  const Vector3d centre = surface.positions.col(near.front()), normal = normals.col(near.front());
  if (!(normal.squaredNorm() > 0.5)) return Eigen::Matrix3d::Zero();
  const Vector3d u = normal.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> tangent;
  tangent << u, normal.cross(u);
  double size = 0;
  for (const std::uint32_t v : near) size = std::max(size, (surface.positions.col(v) - centre).norm());
  if (!(size > 0)) return Eigen::Matrix3d::Zero();
  // z = c₀x + c₁y + ½c₂x² + c₃xy + ½c₄y², in units of `size`. With too few vertices (a small mesh) the
  // least-norm solution is flat in the undetermined directions.
  Eigen::Matrix<double, 5, 5> normal_matrix = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
  for (const std::uint32_t v : near) {
    if (!(normals.col(v).dot(normal) > 0)) continue;  // the other side of a fold
    const Vector3d d = (surface.positions.col(v) - centre) / size;
    const double x = d.dot(tangent.col(0)), y = d.dot(tangent.col(1));
    // Surfaces are not exactly quadratic: distant vertices have a small weight, since they would make most
    // curvatures too large.
    const double weight = std::exp(-4 * (x * x + y * y));
    const Eigen::Matrix<double, 5, 1> terms{x, y, x * x / 2, x * y, y * y / 2};
    normal_matrix += weight * terms * terms.transpose();
    right += weight * d.dot(normal) * terms;
  }
  const Eigen::Matrix<double, 5, 1> fit = normal_matrix.completeOrthogonalDecomposition().solve(right);
  Matrix2d second;
  second << fit[2], fit[3], fit[3], fit[4];
  second /= size * std::sqrt(1 + fit[0] * fit[0] + fit[1] * fit[1]);
  return tangent * second * tangent.transpose();
}

std::vector<Matrix2d> fitted_second_forms(const BaseSurface& surface, int edges) {
  const auto faces = faces_round(surface.topology);
  const Eigen::Matrix3Xd normals = vertex_normals(surface);
  std::vector<Eigen::Matrix3d> curvature;
  std::vector<std::uint32_t> seen_from(surface.topology.vertex_count, shell::none);
  for (std::uint32_t v = 0; v < surface.topology.vertex_count; ++v)
    curvature.push_back(
        fitted_curvature(surface, normals, vertices_near(surface.topology, v, faces, edges, seen_from)));
  std::vector<Matrix2d> result;
  for (std::size_t f = 0; f < surface.rest.size(); ++f) {
    const shell::Face& face = surface.topology.faces[f];
    const auto map = shell::deformation_gradient(surface.rest[f], shell::corners_of(face, surface.positions));
    const Eigen::Matrix3d mean = (curvature[face[0]] + curvature[face[1]] + curvature[face[2]]) / 3;
    result.push_back(map.transpose() * mean * map);
  }
  return result;
}

void check(const BaseSurface& surface) {
  const auto& topology = surface.topology;
  if (surface.rest.size() != topology.faces.size() || surface.positions.cols() != topology.vertex_count) {
    throw Error(
        ExitCode::bad_input,
        fmt::format("the base surface has {} faces and {} vertices, but {} rest faces and {} positions",
                    topology.faces.size(), topology.vertex_count, surface.rest.size(),
                    surface.positions.cols()));
  }
  for (Eigen::Index v = 0; v < surface.positions.cols(); ++v) {
    if (!surface.positions.col(v).allFinite())
      throw Error(ExitCode::bad_input, fmt::format("vertex {} of the base surface is not finite", v));
  }
}

}  // namespace

PrincipalStrain principal_strain(const FaceForms& forms) {
  const shell::Principal p = shell::principal(forms.strain);
  return {p.value[0], p.value[1], p.direction.col(1), p.direction.col(0)};
}

std::vector<FaceForms> face_forms(const BaseSurface& surface, CurvatureFit fit) {
  check(surface);
  const std::vector<Matrix2d> second =
      fit.kind == CurvatureFit::quadratic
          ? fitted_second_forms(surface, fit.edges)
          : shell::second_forms(surface.topology, surface.rest, surface.positions);
  const auto first = shell::first_forms(surface.topology, surface.rest, surface.positions);
  std::vector<FaceForms> result;
  for (std::size_t f = 0; f < first.size(); ++f)
    result.push_back({surface.rest[f], first[f] - Matrix2d::Identity(), second[f]});
  return result;
}

}  // namespace plisse::wrinkle
