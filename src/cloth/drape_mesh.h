// Meshes for draping: irregular Delaunay meshes with a given number of vertices, and sewing.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "shell/rest_shape.h"
#include "sizing/fabric.h"
#include "sizing/polyline.h"

namespace plisse::cloth {

struct FlatMesh {
  shell::Positions points;  // z = 0
  std::vector<shell::Face> faces;
};

// Edges a length with which panels of this area and this length of outline have so many vertices in all:
// (2/√3) A/r² + P/2r + 1 (src/sizing/sample.h), solved for 1/r.
double edges_per_length(double area, double around, int vertices);

// An irregular mesh of a panel with about `vertices` vertices (within some percent; the panel is scaled so
// that the mesher of src/sizing finds its fabric's own edge length in it). Straight sides are divided evenly,
// so that opposite sides of a rectangle match. `sewn`: metres of its outline that will be sewn to this or
// another panel; their vertices count half, so that `vertices` is the number in the base mesh. Throws
// Error(bad_input) for panels that cannot be meshed.
FlatMesh delaunay_mesh(const sizing::Polyline& outline, const std::vector<sizing::Polyline>& holes,
                       int vertices, std::uint32_t seed, double sewn = 0);

// As fine as a fabric needs, with its warp along y. Throws Error(bad_input) as sizing::mesh_panel.
FlatMesh fabric_mesh(const sizing::Polyline& outline, const sizing::Fabric& fabric, std::uint32_t seed);

sizing::Polyline rectangle_outline(double width, double height);  // from (0, 0)
sizing::Polyline circle_outline(double radius, int pieces);       // about (0, 0), counterclockwise

enum class Diagonals { rising, falling, alternating };
FlatMesh grid_mesh(double width, double height, int columns, int rows, Diagonals diagonals);

// Base vertices for rest vertices: the given pairs become one vertex.
struct Sewn {
  std::vector<std::uint32_t> base_of;  // of each rest vertex
  std::uint32_t count = 0;
  std::vector<shell::Face> faces;
};
Sewn sew(std::size_t rest_vertices, const std::vector<shell::Face>& rest_faces,
         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs);

}  // namespace plisse::cloth
