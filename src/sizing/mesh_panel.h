// A panel's mesh, from outline and features to triangles and their quality: the steps of sizing in order.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "sizing/domain.h"
#include "sizing/panel.h"
#include "sizing/sample.h"
#include "sizing/size_map.h"

namespace plisse::sizing {

struct PanelMesh {
  std::vector<glm::dvec2> vertices;  // panel coordinates, m
  std::vector<double> sizes;         // at each vertex: wanted edge length, √(weft · warp), m
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counterclockwise
  struct Edge {
    std::uint32_t a, b;
    std::uint32_t line;  // of the domain
  };
  std::vector<Edge> line_edges;  // every edge that lies on a line
  std::vector<std::vector<std::uint32_t>>
      lines;  // by line of the domain: its vertices in order; none where it was lost
};

struct MeshQuality {
  double edges_within = 0;  // share of edges with half to double the wanted length
  double least_angle = 0;   // degrees, over all triangles that are not exempt
  std::size_t exempt = 0;   // triangles in fold strips or at corners where lines meet under 60°
  double mean_edge = 0;     // length over wanted length, mean
  double length_ratio = 1;  // anisotropy of the edges: 1 for an isotropic mesh
  double expected_vertices = 0;
  double lost = 0;  // length of lines that are not edges of the mesh, m
};

struct MeshTimes {
  double map = 0, sample = 0, triangulate = 0, improve = 0;  // seconds
};

struct SizedPanel {
  Domain domain;
  std::vector<Source> sources;
  std::unique_ptr<SizeMap> map;  // refers to `domain`
  PanelMesh mesh;
  MeshQuality quality;
  MeshTimes seconds;
};

// Throws Error(bad_input) as `prepare` and `sources_of` do.
std::unique_ptr<SizedPanel> mesh_panel(const Panel& panel, const SizingOptions& options);

// The same in two steps, for panels whose lines must have the same division as those of other panels: first
// everything but the mesh (with Domain::Line::seam_size of some lines), then the mesh.
std::unique_ptr<SizedPanel> size_panel(const Panel& panel, const SizingOptions& options,
                                       const std::map<std::size_t, double>& seam_sizes = {});
void mesh_sized(SizedPanel& sized, const SizingOptions& options, const Divisions& divisions);

// Square root of the ratio of the eigenvalues of Σ e eᵀ over a mesh's edges, which for an affine image of an
// isotropic mesh is the ratio of its stretches, and the ratio of mean edge lengths in the two directions.
double edge_length_ratio(const PanelMesh& mesh);

}  // namespace plisse::sizing
