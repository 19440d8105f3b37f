// A panel's mesh, from outline and features to triangles and their quality: the story of sizing.
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
  std::vector<double> sizes;         // at each vertex: edge length wanted there, √(weft · warp), m
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
  double edges_within = 0;  // share of edges whose length lies between half and double what is wanted there
  double least_angle = 0;   // degrees, over triangles that are bound to it; see `exempt`
  std::size_t exempt = 0;   // triangles in fold strips or at corners where lines meet under 60°
  double mean_edge = 0;     // length over what is wanted, mean
  double length_ratio = 1;  // anisotropy of the edges: 1 for a mesh that looks alike in all directions
  double expected_vertices = 0;
  double lost = 0;  // length of lines that are no edges of the mesh, m
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

// The same in two steps, for panels whose lines are to be divided as those of other panels are: all but the
// mesh (with Domain::Line::seam_size of some lines); the mesh.
std::unique_ptr<SizedPanel> size_panel(const Panel& panel, const SizingOptions& options,
                                       const std::map<std::size_t, double>& seam_sizes = {});
void mesh_sized(SizedPanel& sized, const SizingOptions& options, const Divisions& divisions);

// Square root of the ratio of the eigenvalues of Σ e eᵀ over a mesh's edges, which for affine images of an
// isotropic mesh is how much it was stretched, and the mean edge lengths that belong to it lie in the same
// ratio.
double edge_length_ratio(const PanelMesh& mesh);

}  // namespace plisse::sizing
