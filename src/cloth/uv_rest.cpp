#include "cloth/uv_rest.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "base/weighted_median.h"

namespace plisse::cloth {
namespace {

using Corners2 = Eigen::Matrix<double, 2, 3>;

// Of the same triangle at rest, in its own plane.
shell::RestFace at_rest(const Surface& surface, std::uint32_t triangle, std::size_t face) {
  Eigen::Matrix3d corners;
  for (std::size_t c = 0; c < 3; ++c) {
    const glm::dvec3& x = surface.rest[surface.render_vertices[surface.triangles[3 * triangle + c]].welded];
    corners.col(static_cast<Eigen::Index>(c)) = Eigen::Vector3d(x.x, x.y, x.z);
  }
  return shell::rest_face(corners, face);
}

Corners2 uv_of(const Surface& surface, std::uint32_t triangle) {
  Corners2 corners;
  for (std::size_t c = 0; c < 3; ++c) {
    const glm::vec2 uv = surface.render_vertices[surface.triangles[3 * triangle + c]].uv;
    corners.col(static_cast<Eigen::Index>(c)) = Eigen::Vector2d(uv.x, uv.y);
  }
  return corners;
}

// 0 where a triangle is as thin as rounding (see shell::rest_face).
double area_of(const Corners2& corners) {
  const Eigen::Vector2d a = corners.col(1) - corners.col(0), b = corners.col(2) - corners.col(0);
  const double area = std::abs(a.x() * b.y() - a.y() * b.x()) / 2,
               longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  return area > 1e-12 * longest ? area : 0;
}

}  // namespace

UvRest rest_from_uv(const Surface& surface, const Cloth& cloth, std::optional<double> metres,
                    const std::string& name) {
  for (const Part& part : surface.parts)
    if (part.wrinkles && !part.has_uv)
      throw Error(ExitCode::bad_input,
                  fmt::format("{}: --rest uv: mesh '{}' has no texture coordinates; leave it out with "
                              "--exclude, or take another rest shape",
                              name, part.mesh));
  double area = 0, flat_area = 0;
  std::size_t empty = 0;
  std::vector<shell::RestFace> space;
  for (std::size_t f = 0; f < cloth.faces.size(); ++f) {
    const double flat = area_of(uv_of(surface, cloth.triangle[f]));
    space.push_back(at_rest(surface, cloth.triangle[f], f));
    area += space.back().area;
    flat_area += flat;
    if (!(flat > 0)) ++empty;
  }
  if (!(flat_area > 0) || empty > 0)
    throw Error(ExitCode::bad_input,
                fmt::format("{}: --rest uv: {} of {} triangles have no area in the texture coordinates, so "
                            "they have no shape at rest",
                            name, empty, cloth.faces.size()));
  const double fitting = std::sqrt(area / flat_area);
  UvRest rest;
  rest.metres = metres.value_or(fitting);
  std::vector<std::pair<double, double>> stretch, away;  // of lengths: how much; of |ln|, weights: areas
  double far = 0;
  for (std::size_t f = 0; f < cloth.faces.size(); ++f) {
    Corners2 corners = rest.metres * uv_of(surface, cloth.triangle[f]);
    rest.faces.push_back(shell::rest_face(corners, f));
    const Eigen::Matrix2d panel = rest.faces.back().edges;
    const Eigen::Vector2d sigma =
        Eigen::JacobiSVD<Eigen::Matrix2d>(space[f].edges * panel.inverse()).singularValues();
    const double worst = std::max(std::abs(std::log(sigma[0])), std::abs(std::log(sigma[1])));
    stretch.emplace_back(std::sqrt(sigma[0] * sigma[1]), space[f].area);
    away.emplace_back(worst, space[f].area);
    if (worst > std::log(1.25)) far += space[f].area;
    // Corners in the cloth's order.
    if (cloth.turned[f]) {
      corners.col(1).swap(corners.col(2));
      rest.faces.back() = shell::rest_face(corners, f);
    }
  }
  const double scale = weighted_median(stretch), typical = weighted_median(away), most = std::log(1.1);
  if (metres && std::abs(std::log(scale)) > most)
    throw Error(ExitCode::bad_input,
                fmt::format("{}: --rest uv:{}m: the model at rest is {:.3g} times as large as its panels of "
                            "that size; uv:{:.4g}m would fit",
                            name, *metres, scale, fitting));
  if (typical > most)
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: --rest uv: the texture coordinates are no flat pattern of the model: lengths "
                    "differ by {:.0f} % in the median, and 10 % is the most; take another rest shape",
                    name, 100 * std::expm1(typical)));
  if (far > 0.01 * area)
    log::warn(fmt::format(
        "{}: --rest uv: on {:.0f} % of the cloth lengths differ from the model at rest by more than a "
        "quarter; that counts as stretch or compression",
        name, 100 * far / area));
  return rest;
}

}  // namespace plisse::cloth
