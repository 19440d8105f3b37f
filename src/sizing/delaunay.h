// Constrained Delaunay triangulation of points on an integer grid.
//
// Incremental insertion with flips (C. Lawson, "Software for C¹ Surface Interpolation", 1977); constraints by
// flipping what they cross (S. Sloan, "A fast algorithm for generating constrained Delaunay triangulations",
// 1993). Coordinates are whole numbers of at most 26 bits, so orientation fits in 64 bits and the circle test
// in 128: both are exact, and nothing here has a tolerance.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace plisse::sizing {

struct GridPoint {
  std::int32_t x = 0, y = 0;
  bool operator==(const GridPoint&) const = default;
};

// Twice the signed area of abc: positive where it runs counterclockwise.
std::int64_t orientation(GridPoint a, GridPoint b, GridPoint c);
// Positive where d lies inside the circle through a, b, c (counterclockwise), negative outside, 0 on it.
int in_circle(GridPoint a, GridPoint b, GridPoint c, GridPoint d);

class Triangulation {
 public:
  static constexpr std::int32_t limit = 1 << 25;      // points lie in −limit … limit
  static constexpr std::uint32_t frame_vertices = 4;  // vertices 0 … 3: a square round everything
  static constexpr std::uint16_t free_edge = 0;

  struct Triangle {
    std::array<std::uint32_t, 3> vertex{};  // counterclockwise
    std::array<std::uint32_t, 3>
        neighbour{};                     // across the edge opposite to vertex[i]; none: outside the frame
    std::array<std::uint16_t, 3> tag{};  // of that edge: free_edge, or the tag given to `constrain`
    bool inside = true;                  // see `mark_inside`; kept by insert and flips
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  Triangulation();

  // Returns the new vertex, or the existing one at this point. An edge through the point is split; both
  // halves keep its tag.
  std::uint32_t insert(GridPoint point);

  // Makes a–b a chain of edges with this tag (not free_edge). It passes through vertices on the line; where
  // it crosses an edge with a tag, both get a vertex; an edge with two tags keeps the smaller one.
  void constrain(std::uint32_t a, std::uint32_t b, std::uint16_t tag);

  // Marks as inside the triangles that are separated from the frame by an odd number of edges with tags up to
  // `last_outline`.
  void mark_inside(std::uint16_t last_outline);

  // Moves a vertex, unless a triangle at it would turn over or lose its area. Edges are not flipped;
  // `legalise` does that for all of them.
  bool move(std::uint32_t vertex, GridPoint point);
  void legalise();

  const std::vector<GridPoint>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  // Some triangle that has this vertex.
  std::uint32_t triangle_at(std::uint32_t vertex) const { return at_[vertex]; }
  // The triangle that contains the point, found by walking from `start`.
  std::uint32_t locate(GridPoint point, std::uint32_t start) const;

 private:
  struct Edge {
    std::uint32_t triangle = none;
    int corner = 0;  // the edge opposite to it
  };
  Edge find_edge(std::uint32_t a, std::uint32_t b) const;  // triangle none: no such edge
  Edge across(Edge edge) const;
  void set_tag(Edge edge, std::uint16_t tag);
  void relink(std::uint32_t triangle, std::uint32_t from, std::uint32_t to);
  void flip(Edge edge);
  bool flip_if_needed(Edge edge);
  void settle();
  void split_triangle(std::uint32_t triangle, std::uint32_t vertex);
  void split_edge(Edge edge, std::uint32_t vertex);
  std::uint32_t force_piece(std::uint32_t a, std::uint32_t b, std::uint16_t tag, int depth);
  void constrain(std::uint32_t a, std::uint32_t b, std::uint16_t tag, int depth);

  std::vector<GridPoint> points_;
  std::vector<std::uint32_t> at_;
  std::vector<Triangle> triangles_;
  std::vector<Edge> stack_;
  std::uint32_t last_ = 0;
};

}  // namespace plisse::sizing
