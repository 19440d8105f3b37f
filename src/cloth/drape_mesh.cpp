#include "cloth/drape_mesh.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "sizing/mesh_panel.h"
#include "sizing/sample.h"

namespace plisse::cloth {

using shell::Face;

namespace {

double area_of(const sizing::Polyline& outline, const std::vector<sizing::Polyline>& holes) {
  double area = std::abs(sizing::signed_area(outline));
  for (const auto& hole : holes) area -= std::abs(sizing::signed_area(hole));
  return area;
}

sizing::Polyline scaled(sizing::Polyline line, double factor) {
  for (glm::dvec2& point : line.points) point *= factor;
  return line;
}

// `sized`, every length over `scale`.
FlatMesh flat(const sizing::PanelMesh& sized, double scale) {
  FlatMesh mesh;
  mesh.points.resize(3, static_cast<Eigen::Index>(sized.vertices.size()));
  for (std::size_t v = 0; v < sized.vertices.size(); ++v) {
    const glm::dvec2 point = sized.vertices[v] / scale;
    mesh.points.col(static_cast<Eigen::Index>(v)) << point.x, point.y, 0;
  }
  for (const auto& triangle : sized.triangles) mesh.faces.push_back(triangle);
  return mesh;
}

}  // namespace

double edges_per_length(double area, double around, int vertices) {
  const double a = sizing::vertex_density * area, b = around / 2, c = 1.0 - vertices;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

FlatMesh delaunay_mesh(const sizing::Polyline& outline, const std::vector<sizing::Polyline>& holes,
                       int vertices, std::uint32_t seed, double sewn) {
  double around = outline.length();
  for (const auto& hole : holes) around += hole.length();
  double per_edge = edges_per_length(area_of(outline, holes), around - sewn, vertices);

  sizing::Panel panel;
  panel.fabric = *sizing::find_fabric("wine-style");  // any would do: edges are scaled to the vertices
  panel.fabric.warp = panel.fabric.weft;              // alike in both directions
  sizing::SizingOptions options;
  options.seed = seed;
  const double edge = sizing::fabric_resolution(options.law, panel.fabric.weft);
  FlatMesh best;
  double least = std::numeric_limits<double>::max();
  for (int round = 0; round < 5 && least > 0.005; ++round) {
    const double scale = edge * per_edge;
    panel.outline = scaled(outline, scale);
    panel.holes.clear();
    for (const auto& hole : holes) panel.holes.push_back(scaled(hole, scale));
    FlatMesh mesh = flat(sizing::mesh_panel(panel, options)->mesh, scale);
    const double share = vertices / (static_cast<double>(mesh.points.cols()) - sewn * per_edge / 2);
    // Sides are divided into whole edges, so that small meshes can miss by a row.
    if (std::abs(share - 1) < least) {
      least = std::abs(share - 1);
      best = std::move(mesh);
    }
    per_edge *= std::sqrt(share);
  }
  return best;
}

FlatMesh fabric_mesh(const sizing::Polyline& outline, const sizing::Fabric& fabric, std::uint32_t seed) {
  sizing::Panel panel;
  panel.fabric = fabric;
  panel.outline = outline;
  sizing::SizingOptions options;
  options.seed = seed;
  return flat(sizing::mesh_panel(panel, options)->mesh, 1);
}

sizing::Polyline rectangle_outline(double width, double height) {
  return {{{0, 0}, {width, 0}, {width, height}, {0, height}}, true};
}

sizing::Polyline circle_outline(double radius, int pieces) {
  sizing::Polyline circle;
  circle.closed = true;
  for (int i = 0; i < pieces; ++i) {
    const double angle = 2 * std::numbers::pi * i / pieces;
    circle.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return circle;
}

FlatMesh grid_mesh(double width, double height, int columns, int rows, Diagonals diagonals) {
  FlatMesh mesh;
  mesh.points.resize(3, (columns + 1) * (rows + 1));
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh.points.col(id(i, j)) << width * i / columns, height * j / rows, 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
      const bool rising =
          diagonals == Diagonals::rising || (diagonals == Diagonals::alternating && (i + j) % 2 == 0);
      mesh.faces.push_back(rising ? Face{a, b, c} : Face{a, b, d});
      mesh.faces.push_back(rising ? Face{a, c, d} : Face{b, c, d});
    }
  return mesh;
}

Sewn sew(std::size_t rest_vertices, const std::vector<Face>& rest_faces,
         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
  std::vector<std::uint32_t> parent(rest_vertices);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b] : pairs) {
    const std::uint32_t x = root(a), y = root(b);
    parent[std::max(x, y)] = std::min(x, y);
  }
  Sewn sewn;
  sewn.base_of.resize(rest_vertices);
  for (std::uint32_t v = 0; v < rest_vertices; ++v)
    sewn.base_of[v] = root(v) == v ? sewn.count++ : sewn.base_of[root(v)];
  for (Face face : rest_faces) {
    for (auto& v : face) v = sewn.base_of[v];
    sewn.faces.push_back(face);
  }
  return sewn;
}

}  // namespace plisse::cloth
