// C. Lawson 1977 (insertion by flips) and S. Sloan 1993 (constraints), in exact integer arithmetic.

#include "sizing/delaunay.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "base/error.h"

namespace plisse::sizing {
namespace {

__extension__ using Wide = __int128;

constexpr int next(int corner) {
  return corner == 2 ? 0 : corner + 1;
}
constexpr int previous(int corner) {
  return corner == 0 ? 2 : corner - 1;
}

int corner_of(const Triangulation::Triangle& triangle, std::uint32_t vertex) {
  return triangle.vertex[0] == vertex   ? 0
         : triangle.vertex[1] == vertex ? 1
         : triangle.vertex[2] == vertex ? 2
                                        : -1;
}

int corner_facing(const Triangulation::Triangle& triangle, std::uint32_t neighbour) {
  return triangle.neighbour[0] == neighbour ? 0 : triangle.neighbour[1] == neighbour ? 1 : 2;
}

}  // namespace

std::int64_t orientation(GridPoint a, GridPoint b, GridPoint c) {
  return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
         (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

int in_circle(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
  const std::int64_t ax = std::int64_t{a.x} - d.x, ay = std::int64_t{a.y} - d.y;
  const std::int64_t bx = std::int64_t{b.x} - d.x, by = std::int64_t{b.y} - d.y;
  const std::int64_t cx = std::int64_t{c.x} - d.x, cy = std::int64_t{c.y} - d.y;
  const Wide determinant = Wide{ax * ax + ay * ay} * (bx * cy - by * cx) +
                           Wide{bx * bx + by * by} * (cx * ay - cy * ax) +
                           Wide{cx * cx + cy * cy} * (ax * by - ay * bx);
  return determinant > 0 ? 1 : determinant < 0 ? -1 : 0;
}

Triangulation::Triangulation() {
  constexpr std::int32_t far = 2 * limit;
  points_ = {{-far, -far}, {far, -far}, {far, far}, {-far, far}};
  at_ = {0, 0, 0, 1};
  triangles_ = {{{0, 1, 2}, {none, 1, none}, {}, true}, {{0, 2, 3}, {none, none, 0}, {}, true}};
}

std::uint32_t Triangulation::locate(GridPoint point, std::uint32_t start) const {
  // The walk begins with another side in each step: in a constrained Delaunay triangulation, a fixed order of
  // the three sides could lead in a circle.
  std::uint32_t current = start;
  for (std::uint32_t step = 0;; ++step) {
    const Triangle& triangle = triangles_[current];
    std::uint32_t to = none;
    for (int i = 0, side = static_cast<int>((step * 2654435761U >> 16) % 3); i < 3; ++i, side = next(side)) {
      if (orientation(points_[triangle.vertex[next(side)]], points_[triangle.vertex[previous(side)]], point) <
          0) {
        to = triangle.neighbour[side];
        break;
      }
    }
    if (to == none) return current;
    current = to;
  }
}

void Triangulation::relink(std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
  if (triangle == none) return;
  for (std::uint32_t& neighbour : triangles_[triangle].neighbour) {
    if (neighbour == from) {
      neighbour = to;
      return;
    }
  }
}

Triangulation::Edge Triangulation::across(Edge edge) const {
  const std::uint32_t other = triangles_[edge.triangle].neighbour[edge.corner];
  return other == none ? Edge{} : Edge{other, corner_facing(triangles_[other], edge.triangle)};
}

void Triangulation::set_tag(Edge edge, std::uint16_t tag) {
  triangles_[edge.triangle].tag[edge.corner] = tag;
  if (const Edge other = across(edge); other.triangle != none)
    triangles_[other.triangle].tag[other.corner] = tag;
}

// (p, a, b) and (q, b, a) become (p, a, q) and (q, b, p).
void Triangulation::flip(Edge edge) {
  const Edge opposite = across(edge);
  const std::uint32_t t = edge.triangle, o = opposite.triangle;
  const Triangle old = triangles_[t], other = triangles_[o];
  const int i = edge.corner, j = opposite.corner;
  const std::uint32_t p = old.vertex[i], a = old.vertex[next(i)], b = old.vertex[previous(i)],
                      q = other.vertex[j];
  // The neighbour across a–p is that of old's side opposite to b, across a–q that of other's side opposite to
  // b; likewise for b.
  const int old_b = previous(i), old_a = next(i), other_a = previous(j), other_b = next(j);
  triangles_[t] = {{p, a, q},
                   {other.neighbour[other_b], o, old.neighbour[old_b]},
                   {other.tag[other_b], free_edge, old.tag[old_b]},
                   old.inside};
  triangles_[o] = {{q, b, p},
                   {old.neighbour[old_a], t, other.neighbour[other_a]},
                   {old.tag[old_a], free_edge, other.tag[other_a]},
                   old.inside};
  relink(other.neighbour[other_b], o, t);
  relink(old.neighbour[old_a], t, o);
  at_[p] = t;
  at_[a] = t;
  at_[q] = o;
  at_[b] = o;
}

bool Triangulation::flip_if_needed(Edge edge) {
  const Triangle& triangle = triangles_[edge.triangle];
  const Edge opposite = across(edge);
  if (opposite.triangle == none || triangle.tag[edge.corner] != free_edge) return false;
  const std::uint32_t facing = triangles_[opposite.triangle].vertex[opposite.corner];
  if (in_circle(points_[triangle.vertex[0]], points_[triangle.vertex[1]], points_[triangle.vertex[2]],
                points_[facing]) <= 0)
    return false;
  flip(edge);
  // The four sides of the pair may now violate the Delaunay condition.
  const std::uint32_t t = edge.triangle, o = opposite.triangle;
  stack_.push_back({t, 0});
  stack_.push_back({t, 2});
  stack_.push_back({o, 0});
  stack_.push_back({o, 2});
  return true;
}

void Triangulation::settle() {
  while (!stack_.empty()) {
    const Edge edge = stack_.back();
    stack_.pop_back();
    flip_if_needed(edge);
  }
}

void Triangulation::split_triangle(std::uint32_t t, std::uint32_t vertex) {
  const Triangle old = triangles_[t];
  const auto second = static_cast<std::uint32_t>(triangles_.size()), third = second + 1;
  triangles_[t] = {{vertex, old.vertex[0], old.vertex[1]},
                   {old.neighbour[2], second, third},
                   {old.tag[2], free_edge, free_edge},
                   old.inside};
  triangles_.push_back({{vertex, old.vertex[1], old.vertex[2]},
                        {old.neighbour[0], third, t},
                        {old.tag[0], free_edge, free_edge},
                        old.inside});
  triangles_.push_back({{vertex, old.vertex[2], old.vertex[0]},
                        {old.neighbour[1], t, second},
                        {old.tag[1], free_edge, free_edge},
                        old.inside});
  relink(old.neighbour[0], t, second);
  relink(old.neighbour[1], t, third);
  at_[vertex] = t;
  at_[old.vertex[0]] = t;
  at_[old.vertex[1]] = second;
  at_[old.vertex[2]] = third;
  stack_ = {{t, 0}, {second, 0}, {third, 0}};
  settle();
}

// (p, a, b) and (q, b, a) become (p, a, v), (p, v, b) and (q, b, v), (q, v, a).
void Triangulation::split_edge(Edge edge, std::uint32_t vertex) {
  const Edge opposite = across(edge);
  const std::uint32_t t = edge.triangle, o = opposite.triangle;
  const Triangle old = triangles_[t], other = triangles_[o];
  const int i = edge.corner, j = opposite.corner;
  const std::uint32_t p = old.vertex[i], a = old.vertex[next(i)], b = old.vertex[previous(i)],
                      q = other.vertex[j];
  const std::uint16_t tag = old.tag[i];
  const auto t2 = static_cast<std::uint32_t>(triangles_.size()), o2 = t2 + 1;
  triangles_[t] = {{p, a, vertex},
                   {o2, t2, old.neighbour[previous(i)]},
                   {tag, free_edge, old.tag[previous(i)]},
                   old.inside};
  triangles_.push_back(
      {{p, vertex, b}, {o, old.neighbour[next(i)], t}, {tag, old.tag[next(i)], free_edge}, old.inside});
  triangles_[o] = {{q, b, vertex},
                   {t2, o2, other.neighbour[previous(j)]},
                   {tag, free_edge, other.tag[previous(j)]},
                   other.inside};
  triangles_.push_back(
      {{q, vertex, a}, {t, other.neighbour[next(j)], o}, {tag, other.tag[next(j)], free_edge}, other.inside});
  relink(old.neighbour[next(i)], t, t2);
  relink(other.neighbour[next(j)], o, o2);
  at_[vertex] = t;
  at_[p] = t;
  at_[a] = t;
  at_[b] = o;
  at_[q] = o;
  stack_ = {{t, 2}, {t2, 1}, {o, 2}, {o2, 1}};
  settle();
}

std::uint32_t Triangulation::insert(GridPoint point) {
  const std::uint32_t t = locate(point, last_);
  last_ = t;
  const Triangle& triangle = triangles_[t];
  for (const std::uint32_t vertex : triangle.vertex) {
    if (points_[vertex] == point) return vertex;
  }
  const auto vertex = static_cast<std::uint32_t>(points_.size());
  points_.push_back(point);
  at_.push_back(t);
  for (int side = 0; side < 3; ++side) {
    if (orientation(points_[triangle.vertex[next(side)]], points_[triangle.vertex[previous(side)]], point) ==
        0) {
      split_edge({t, side}, vertex);
      last_ = at_[vertex];
      return vertex;
    }
  }
  split_triangle(t, vertex);
  last_ = at_[vertex];
  return vertex;
}

Triangulation::Edge Triangulation::find_edge(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t start = at_[a];
  std::uint32_t t = start;
  do {
    const Triangle& triangle = triangles_[t];
    const int i = corner_of(triangle, a);
    if (triangle.vertex[next(i)] == b) return {t, previous(i)};
    if (triangle.vertex[previous(i)] == b) return {t, next(i)};
    t = triangle.neighbour[next(i)];  // round a, counterclockwise
  } while (t != start && t != none);
  return {};
}

void Triangulation::constrain(std::uint32_t a, std::uint32_t b, std::uint16_t tag) {
  constrain(a, b, tag, 0);
  last_ = at_[a];
}

void Triangulation::constrain(std::uint32_t a, std::uint32_t b, std::uint16_t tag, int depth) {
  // Rounding a crossing to the grid moves lines by at most one unit. New crossings could arise so many times
  // only for lines that overlap along their whole length.
  if (depth > 64)
    throw Error(ExitCode::bad_input, "lines of the panel lie within each other and cannot be kept apart");
  while (a != b) a = force_piece(a, b, tag, depth);
}

// Makes an edge from a to the first vertex on the line to b; returns that vertex.
std::uint32_t Triangulation::force_piece(std::uint32_t a, std::uint32_t b, std::uint16_t tag, int depth) {
  const auto keep = [&](Edge edge) {
    const std::uint16_t old = triangles_[edge.triangle].tag[edge.corner];
    set_tag(edge, old == free_edge ? tag : std::min(old, tag));
  };
  const GridPoint from = points_[a], to = points_[b];
  // The side of a's triangles that the line crosses.
  Edge edge;
  for (std::uint32_t t = at_[a];;) {
    const Triangle& triangle = triangles_[t];
    const int i = corner_of(triangle, a);
    const std::uint32_t u = triangle.vertex[next(i)], w = triangle.vertex[previous(i)];
    const std::int64_t right = orientation(from, points_[u], to), left = orientation(from, points_[w], to);
    const auto ahead = [&](std::uint32_t v) {
      return (std::int64_t{points_[v].x} - from.x) * (std::int64_t{to.x} - from.x) +
                 (std::int64_t{points_[v].y} - from.y) * (std::int64_t{to.y} - from.y) >
             0;
    };
    if (right == 0 && ahead(u)) {
      keep({t, previous(i)});
      return u;
    }
    if (right > 0 && left < 0) {
      edge = {t, i};
      break;
    }
    t = triangle.neighbour[next(i)];
  }

  std::deque<std::pair<std::uint32_t, std::uint32_t>> crossed;
  std::uint32_t end = b;
  for (;;) {
    const Triangle& triangle = triangles_[edge.triangle];
    const std::uint32_t u = triangle.vertex[next(edge.corner)], w = triangle.vertex[previous(edge.corner)];
    if (const std::uint16_t other_tag = triangle.tag[edge.corner]; other_tag != free_edge) {
      const auto toward_a = static_cast<double>(orientation(points_[u], points_[w], from));
      const auto toward_b = static_cast<double>(orientation(points_[u], points_[w], to));
      const double share = toward_a / (toward_a - toward_b);
      const GridPoint crossing{
          static_cast<std::int32_t>(std::lround(from.x + share * (static_cast<double>(to.x) - from.x))),
          static_cast<std::int32_t>(std::lround(from.y + share * (static_cast<double>(to.y) - from.y)))};
      set_tag(edge, free_edge);
      last_ = edge.triangle;
      const std::uint32_t vertex = insert(crossing);
      constrain(u, vertex, other_tag, depth + 1);
      constrain(vertex, w, other_tag, depth + 1);
      constrain(a, vertex, tag, depth + 1);
      return vertex;
    }
    crossed.emplace_back(u, w);
    const Edge beyond = across(edge);
    const Triangle& other = triangles_[beyond.triangle];
    const std::uint32_t facing = other.vertex[beyond.corner];
    const std::int64_t side = orientation(from, to, points_[facing]);
    if (side == 0) {
      end = facing;
      break;
    }
    // beyond: vertex[next] is w, vertex[previous] is u; u is on the right of the line, w on the left.
    edge = side > 0 ? Edge{beyond.triangle, next(beyond.corner)}
                    : Edge{beyond.triangle, previous(beyond.corner)};
  }

  // Flips every crossed edge away; an edge whose pair of triangles is not convex yet is flipped later.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> fresh;
  while (!crossed.empty()) {
    const auto [u, w] = crossed.front();
    crossed.pop_front();
    const Edge crossing = find_edge(u, w), opposite = across(crossing);
    const std::uint32_t p = triangles_[crossing.triangle].vertex[crossing.corner];
    const std::uint32_t q = triangles_[opposite.triangle].vertex[opposite.corner];
    const std::uint32_t left = triangles_[crossing.triangle].vertex[next(crossing.corner)];
    const std::uint32_t right = triangles_[crossing.triangle].vertex[previous(crossing.corner)];
    if (orientation(points_[p], points_[left], points_[q]) <= 0 ||
        orientation(points_[q], points_[right], points_[p]) <= 0) {
      crossed.emplace_back(u, w);
      continue;
    }
    flip(crossing);
    const std::int64_t side_p = p == a || p == end ? 0 : orientation(from, to, points_[p]);
    const std::int64_t side_q = q == a || q == end ? 0 : orientation(from, to, points_[q]);
    if ((side_p > 0 && side_q < 0) || (side_p < 0 && side_q > 0)) {
      crossed.emplace_back(p, q);
    } else {
      fresh.emplace_back(p, q);
    }
  }
  keep(find_edge(a, end));
  for (const auto& [u, w] : fresh) {
    if (const Edge created = find_edge(u, w); created.triangle != none) stack_.push_back(created);
  }
  settle();
  return end;
}

void Triangulation::mark_inside(std::uint16_t last_outline) {
  std::vector<std::uint8_t> seen(triangles_.size());
  std::vector<std::uint32_t> pending{at_[0]};
  seen[at_[0]] = 1;
  triangles_[at_[0]].inside = false;
  while (!pending.empty()) {
    const Triangle& triangle = triangles_[pending.back()];
    pending.pop_back();
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = triangle.neighbour[i];
      if (other == none || seen[other]) continue;
      seen[other] = 1;
      const bool outline = triangle.tag[i] != free_edge && triangle.tag[i] <= last_outline;
      triangles_[other].inside = outline != triangle.inside;
      pending.push_back(other);
    }
  }
}

bool Triangulation::move(std::uint32_t vertex, GridPoint point) {
  const std::uint32_t start = at_[vertex];
  std::uint32_t t = start;
  do {
    const Triangle& triangle = triangles_[t];
    const int i = corner_of(triangle, vertex);
    if (orientation(point, points_[triangle.vertex[next(i)]], points_[triangle.vertex[previous(i)]]) <= 0)
      return false;
    t = triangle.neighbour[next(i)];
  } while (t != start);
  points_[vertex] = point;
  return true;
}

void Triangulation::legalise() {
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      if (triangles_[t].neighbour[i] < t) continue;  // handled from its other side
      flip_if_needed({t, i});
      settle();
    }
  }
}

}  // namespace plisse::sizing
