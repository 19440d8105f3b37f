// Splits a surface's triangles, for geometry finer than the mesh: either each edge into its own number of
// segments, a power of two, so that triangles are small only where they must be, or all edges into the same
// number.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface.h"

namespace plisse {

constexpr int most_levels = 8;  // of halved edges: each edge in 256

// The indices that a fine vertex shares with others: its position with all vertices at that point, its normal
// with those across a seam of uv, but not across a hard edge.
struct FineVertex {
  std::uint32_t position = 0, normal = 0;
};

// A vertex as a point of one of the triangles that were split: `toward_b` and `toward_c` of its `segments`
// lead from the first corner to the second and the third.
struct FinePoint {
  std::uint32_t vertex = 0;
  std::uint16_t toward_b = 0, toward_c = 0, segments = 1;
  glm::dvec3 barycentric() const {
    return glm::dvec3(segments - toward_b - toward_c, toward_b, toward_c) / static_cast<double>(segments);
  }
};

// Ids count up from the surface's own: positions begin with the welded vertices, vertices with the render
// vertices, each in their order; then those on edges and inside triangles. All triangles at an edge have the
// same points on it, so there are no gaps.
struct Subdivision {
  std::size_t position_count = 0, normal_count = 0;
  std::vector<FineVertex> vertices;
  std::vector<FinePoint> points;         // of each triangle in turn
  std::vector<std::uint32_t> triangles;  // three vertices each; of each triangle in turn
  // Where those of triangle t begin; one entry more than there are triangles.
  std::vector<std::uint32_t> first_point, first_triangle;

  std::size_t triangle_count() const { return triangles.size() / 3; }
  // The small triangles of `count` triangles from `first` on.
  struct Range {
    std::uint32_t first, count;
  };
  Range small_triangles(std::uint32_t first, std::uint32_t count) const {
    return {first_triangle[first], first_triangle[first + count] - first_triangle[first]};
  }
  // Calls work(triangle, its point) for all of them.
  template <typename Work>
  void for_each_point(const Work& work) const {
    for (std::size_t t = 0; t + 1 < first_point.size(); ++t)
      for (std::uint32_t i = first_point[t]; i < first_point[t + 1]; ++i) work(t, points[i]);
  }
};

// The number of segments of the edge between two welded vertices; it must not depend on their order.
using EdgeSegments = std::function<int(std::uint32_t, std::uint32_t)>;

// A triangle is split as finely as its finest edge; where another edge has fewer segments, points on it move
// to the nearest of that edge's points, and small triangles that thereby lose their area are left out.
// Segments: 1 … 1023, any for all edges alike, powers of two otherwise. Throws Error(bad_input) where the
// numbers of vertices do not fit into 32 bits.
Subdivision subdivide(const Surface& surface, const EdgeSegments& segments);
Subdivision subdivide(const Surface& surface, int segments);

// A displaced subdivision, in any unit of length.
struct DisplacedSurface {
  std::vector<glm::dvec3> positions;  // one per position
  std::vector<glm::dvec3> base;       // where they were before
  std::vector<glm::dvec3> normals;    // one a normal, unit
  // One per position: the displacement along the surface's normal, and its largest value there, the amplitude
  // (both in the unit of positions); the share of the sky that is visible from the groove, on the side of the
  // normals and on the other, 0…1.
  std::vector<glm::dvec4> relief;
};

// How often edges have to be halved so that each wave has `segments_per_wave` segments, for `waves` on the
// edge that has most of them; fewer times where `triangles` would become more than `most_triangles` (with a
// warning). 0 without waves. With eight straight segments, the middle of a crest may be a thirteenth of its
// height too low (1 − cos π/8); normals are exact at every vertex.
constexpr double segments_per_wave = 8;
int levels_for(double waves, std::size_t triangles, double most_triangles);

// The least number of halvings that gives so many segments.
int halvings(double segments);

}  // namespace plisse
