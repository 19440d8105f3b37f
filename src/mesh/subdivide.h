// A surface's triangles split evenly, for geometry finer than the mesh: n segments an edge, n² triangles
// each.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface.h"

namespace plisse {

// What a small vertex shares with others: its place with all that meet there, its normal with those across a
// seam of uv, but not across a hard edge.
struct FineVertex {
  std::uint32_t position = 0, normal = 0;
};

// Ids count up from the surface's own: positions begin with the welded vertices, vertices with the render
// vertices, each in their order; then those on edges, then those inside triangles. On an edge there is one
// point for all triangles beside it, so nothing gapes.
struct Subdivision {
  int segments = 1;  // n
  std::size_t position_count = 0, normal_count = 0;
  std::vector<FineVertex> vertices;
  // Points of a triangle in rows: i segments from corner B, j from corner C, (n+1)(n+2)/2 of them a triangle.
  std::vector<glm::dvec3> lattice;       // barycentric coordinates of those points, the same in all triangles
  std::vector<std::uint32_t> points;     // [triangle · lattice.size() + point] → vertex
  std::vector<std::uint32_t> triangles;  // three vertices each; those of triangle t begin at 3 t n²

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// `segments` ≥ 1. Throws Error(bad_input) where the numbers of vertices do not fit into 32 bits.
Subdivision subdivide(const Surface& surface, int segments);

// A subdivision moved off the surface, in whatever unit.
struct DisplacedSurface {
  std::vector<glm::dvec3> positions;  // one a position
  std::vector<glm::dvec3> base;       // where they were before
  std::vector<glm::dvec3> normals;    // one a normal, unit
  // One a position: by how much it was moved along the surface's normal, and by how much at most (both in the
  // unit of positions); what the groove it lies in leaves of the sky on the side of the normals and on the
  // other, 0…1.
  std::vector<glm::dvec4> relief;
};

}  // namespace plisse
