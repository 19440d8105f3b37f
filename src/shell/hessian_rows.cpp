#include "shell/hessian_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace plisse::shell {

std::vector<HessianRows> hessian_rows(const Topology& topology, const std::vector<RestFace>& rest) {
  struct Corner {
    std::uint32_t face, corner;
  };
  std::vector<std::vector<Corner>> ring(topology.vertex_count);
  std::vector<bool> inner(topology.vertex_count, true);
  for (std::uint32_t f = 0; f < topology.faces.size(); ++f)
    for (std::uint32_t c = 0; c < 3; ++c) ring[topology.faces[f][c]].push_back({f, c});
  for (const Edge& edge : topology.edges)
    if (edge.boundary())
      for (const std::uint32_t v : edge.vertex) inner[v] = false;
  std::vector<HessianRows> result;
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v) {
    if (!inner[v] || ring[v].empty()) continue;
    // The faces in order round the vertex, with the directions of their first sides and their angles there.
    struct Sector {
      std::uint32_t face;
      double first, angle;
    };
    std::vector<Sector> sectors;
    Corner at = ring[v].front();
    double whole = 0;
    do {
      Eigen::Matrix<double, 2, 3> corner;
      corner << Eigen::Vector2d::Zero(), rest[at.face].edges;
      const Eigen::Vector2d a = corner.col((at.corner + 1) % 3) - corner.col(at.corner),
                            b = corner.col((at.corner + 2) % 3) - corner.col(at.corner);
      const double first = std::atan2(a.y(), a.x()),
                   angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
      sectors.push_back({at.face, first, angle});
      whole += angle;
      const Edge& edge = topology.edges[topology.face_edges[at.face][(at.corner + 1) % 3]];
      const std::uint32_t next = edge.face[0] == at.face ? edge.face[1] : edge.face[0];
      const Face& face = topology.faces[next];
      at = {next, static_cast<std::uint32_t>(std::find(face.begin(), face.end(), v) - face.begin())};
    } while (at.face != ring[v].front().face && sectors.size() < ring[v].size());
    // The ring laid flat, its angles scaled to a whole turn.
    const double scale = 2 * std::numbers::pi / whole;
    std::map<std::uint32_t, Eigen::Matrix2d> of;
    double turned = 0;
    for (const Sector& sector : sectors) {
      const double by = turned * scale + sector.angle * (scale - 1) / 2 - sector.first;
      turned += sector.angle;
      const Eigen::Rotation2Dd turn(by);
      const RestFace& face = rest[sector.face];
      const Eigen::Matrix<double, 2, 3> gradients = turn.toRotationMatrix() * face.gradients;
      const Face& ids = topology.faces[sector.face];
      const auto own = std::find(ids.begin(), ids.end(), v) - ids.begin();
      for (std::size_t k = 0; k < 3; ++k) {
        auto& sum = of.try_emplace(ids[k], Eigen::Matrix2d::Zero()).first->second;
        sum -= face.area * gradients.col(own) * gradients.col(static_cast<Eigen::Index>(k)).transpose();
      }
    }
    HessianRows& rows = result.emplace_back(HessianRows{v, {}});
    for (const auto& [u, h] : of) {
      rows.integral[0].emplace_back(u, h(0, 0));
      rows.integral[1].emplace_back(u, h(1, 1));
      rows.integral[2].emplace_back(u, (h(0, 1) + h(1, 0)) / std::numbers::sqrt2);
    }
  }
  return result;
}

}  // namespace plisse::shell
