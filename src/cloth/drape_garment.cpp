#include "cloth/drape_garment.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base/error.h"

namespace plisse::cloth {

using shell::Positions;

Positions SewnGarment::sewn(const Positions& rest_placed) const {
  Positions sum = Positions::Zero(3, count);
  Eigen::RowVectorXd shares = Eigen::RowVectorXd::Zero(count);
  for (std::size_t v = 0; v < base_of.size(); ++v) {
    sum.col(base_of[v]) += rest_placed.col(static_cast<Eigen::Index>(v));
    shares[base_of[v]] += 1;
  }
  return sum.array().rowwise() / shares.array();
}

SewnGarment sew_garment(const sizing::Garment& garment, const sizing::SizingOptions& options) {
  const sizing::SizedGarment sized = sizing::mesh_garment(garment, options);
  SewnGarment sewn;
  sewn.base_of = sized.sewn;
  sewn.count = static_cast<std::uint32_t>(sized.vertices);
  sewn.rest.points.resize(3, static_cast<Eigen::Index>(sized.sewn.size()));
  for (std::size_t p = 0; p < sized.panels.size(); ++p) {
    const std::uint32_t first = sized.first[p];
    const sizing::PanelMesh& mesh = sized.panels[p]->mesh;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      sewn.rest.points.col(first + v) << mesh.vertices[v].x, mesh.vertices[v].y, 0;
      sewn.panel.push_back(p);
    }
    for (const auto& [a, b, c] : mesh.triangles) {
      sewn.rest.faces.push_back({first + a, first + b, first + c});
      sewn.faces.push_back({sized.sewn[first + a], sized.sewn[first + b], sized.sewn[first + c]});
    }
  }
  return sewn;
}

SewnGarment sew_garment(const sizing::Garment& garment, int vertices, std::uint32_t seed) {
  double area = 0, around = 0;
  for (const auto& panel : garment.panels) {
    if (!panel.holes.empty() || !panel.features.empty())
      throw Error(ExitCode::bad_input,
                  fmt::format("panel '{}' has holes or features: leave 'vertices' out, its own rules say how "
                              "fine it is",
                              panel.name));
    area += std::abs(sizing::signed_area(panel.outline));
    around += panel.outline.length();
  }
  sizing::SizingOptions options;
  options.seed = seed;
  // The panels are scaled until the mesher finds its fabric's own edge length in them.
  const double edge = sizing::fabric_resolution(options.law, garment.panels.front().fabric.weft);
  double scale = edge * edges_per_length(area, around, vertices);
  SewnGarment sewn;
  for (int round = 0; round < 4; ++round) {
    sizing::Garment scaled = garment;
    for (auto& panel : scaled.panels)
      for (glm::dvec2& point : panel.outline.points) point *= scale;
    for (auto& seam : scaled.seams)
      for (glm::dvec2* point : {&seam.a.from, &seam.a.to, &seam.b.from, &seam.b.to}) *point *= scale;
    sewn = sew_garment(scaled, options);
    sewn.rest.points /= scale;
    const double share = static_cast<double>(vertices) / sewn.count;
    if (std::abs(share - 1) < 0.02) break;
    scale *= std::sqrt(share);
  }
  return sewn;
}

Positions placed(const SewnGarment& sewn, const sizing::Garment& garment, double wrap) {
  Positions rest = sewn.rest.points;
  for (Eigen::Index v = 0; v < rest.cols(); ++v) {
    glm::dvec3 p(rest(0, v), rest(1, v), 0);
    if (wrap > 0) p = {wrap * std::sin(p.x / wrap), p.y, wrap * std::cos(p.x / wrap)};
    if (!garment.placements.empty()) {
      const auto& placement = garment.placements[sewn.panel[static_cast<std::size_t>(v)]];
      p = placement.rotation * p + placement.translation;
    }
    rest.col(v) << p.x, p.y, p.z;
  }
  return sewn.sewn(rest);
}

}  // namespace plisse::cloth
