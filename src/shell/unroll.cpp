#include "shell/unroll.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace plisse::shell {
namespace {

using Eigen::Vector2d;
using Corners = std::array<Vector2d, 3>;

Corners corners_of(const RestFace& face) {
  return {Vector2d::Zero(), face.edges.col(0), face.edges.col(1)};
}

// The triangle moved so that its side from corner `side` on runs as a → b does, their middles together.
Corners moved_to(const Corners& x, std::size_t side, const Vector2d& a, const Vector2d& b) {
  const Vector2d from = x[(side + 1) % 3] - x[side], to = b - a;
  const double size = from.norm() * to.norm();
  Eigen::Matrix2d turn;
  const double c = from.dot(to) / size, s = (from.x() * to.y() - from.y() * to.x()) / size;
  turn << c, -s, s, c;
  const Vector2d middle = (x[side] + x[(side + 1) % 3]) / 2;
  Corners result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = (a + b) / 2 + turn * (x[i] - middle);
  return result;
}

class Layout {
 public:
  Layout(const Topology& topology, const std::vector<RestFace>& rest)
      : topology_(topology), rest_(rest), places_(rest.size()), at_vertex_(topology.vertex_count) {}

  std::vector<Corners> lay() {
    double right = 0;
    for (std::size_t f = 0; f < rest_.size(); ++f) {
      if (places_[f]) continue;
      for (auto& places : at_vertex_) places.clear();
      const std::vector<std::size_t> piece = spread_from(f);
      const double infinity = std::numeric_limits<double>::infinity();
      Vector2d low(infinity, infinity), high = -low;
      for (const std::size_t face : piece) {
        for (const Vector2d& x : *places_[face]) {
          low = low.cwiseMin(x);
          high = high.cwiseMax(x);
        }
      }
      for (const std::size_t face : piece) {
        for (Vector2d& x : *places_[face]) x += Vector2d(right, 0) - low;
      }
      right += 1.02 * (high.x() - low.x());
    }
    double extent = 0;
    for (const auto& face : places_) {
      for (const Vector2d& x : *face) extent = std::max(extent, x.maxCoeff());
    }
    std::vector<Corners> result;
    for (auto& face : places_) {
      for (Vector2d& x : *face) x /= extent;
      result.push_back(*face);
    }
    return result;
  }

 private:
  std::vector<std::size_t> spread_from(std::size_t first) {
    std::vector<std::size_t> piece{first};
    place(first, corners_of(rest_[first]));
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::size_t f = piece[i];
      for (std::size_t e = 0; e < 3; ++e) {
        const Edge& edge = topology_.edges[topology_.face_edges[f][e]];
        const std::uint32_t g = edge.face[0] == f ? edge.face[1] : edge.face[0];
        if (g == none || places_[g]) continue;
        // Edge e is opposite to corner e: from corner e + 1 to e + 2.
        const std::size_t a = (e + 1) % 3, b = (e + 2) % 3;
        std::size_t side = 0;  // of g, running the other way
        while (topology_.faces[g][side] != topology_.faces[f][b]) ++side;
        const Corners own = corners_of(rest_[f]), other = corners_of(rest_[g]);
        const double here = (own[b] - own[a]).norm(), there = (other[(side + 1) % 3] - other[side]).norm();
        if (std::abs(here - there) > 1e-6 * here) continue;
        const Corners& placed = *places_[f];
        Corners next = moved_to(other, side, placed[b], placed[a]);
        next[side] = placed[b];
        next[(side + 1) % 3] = placed[a];
        place(g, next);
        piece.push_back(g);
      }
    }
    return piece;
  }

  void place(std::size_t f, Corners x) {
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < 3; ++c) shortest = std::min(shortest, (x[(c + 1) % 3] - x[c]).norm());
    for (std::size_t c = 0; c < 3; ++c) {
      auto& known = at_vertex_[topology_.faces[f][c]];
      const auto near = std::find_if(known.begin(), known.end(),
                                     [&](const Vector2d& k) { return (k - x[c]).norm() <= 0.1 * shortest; });
      if (near != known.end())
        x[c] = *near;
      else
        known.push_back(x[c]);
    }
    places_[f] = x;
  }

  const Topology& topology_;
  const std::vector<RestFace>& rest_;
  std::vector<std::optional<Corners>> places_;
  std::vector<std::vector<Vector2d>> at_vertex_;  // of the current piece
};

}  // namespace

std::vector<Corners> unrolled(const Topology& topology, const std::vector<RestFace>& rest) {
  return Layout(topology, rest).lay();
}

}  // namespace plisse::shell
