#include "mesh/cut_polygon.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <utility>

namespace plisse {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// Angles that differ by less count as equal, so that the rounding of a file's decimals does not choose
// between the two diagonals of a rectangle.
constexpr double same_angle = 1e-5;

// The corners in the polygon's plane, seen so that it turns to the left; empty where it has no area.
std::vector<glm::dvec2> in_plane(std::span<const glm::dvec3> corners) {
  double size = 0;
  for (const glm::dvec3& corner : corners)
    for (int axis = 0; axis < 3; ++axis) size = std::max(size, std::abs(corner[axis] / 2));
  if (!(size > 0)) return {};
  // By a power of two, which rounds nothing; sizes below the range of doubles' squares count as none.
  const int exponent = std::ilogb(size);
  if (exponent < -1000) return {};
  const double scale = std::ldexp(1.0, -exponent - 2);
  std::vector<glm::dvec3> points;
  points.reserve(corners.size());
  for (const glm::dvec3& corner : corners) points.push_back(corner * scale - corners[0] * scale);
  glm::dvec3 normal{0};
  double area = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const glm::dvec3 part = glm::cross(points[i], points[i + 1]);
    normal += part;
    area += glm::length(part);
  }
  const double length = glm::length(normal);
  // What rounding leaves of a polygon whose parts cancel has no direction.
  if (!(length > 1e-14 * area)) return {};
  normal /= length;
  // Axes of the plane that are exactly those of space where the normal is one of them.
  int along = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::abs(normal[axis]) > std::abs(normal[along])) along = axis;
  glm::dvec3 across{0};
  across[(along + 1) % 3] = 1;
  const glm::dvec3 x = glm::normalize(across - normal * glm::dot(normal, across));
  const glm::dvec3 y = glm::cross(normal, x);
  std::vector<glm::dvec2> flat;
  flat.reserve(points.size());
  for (const glm::dvec3& point : points) flat.emplace_back(glm::dot(x, point), glm::dot(y, point));
  return flat;
}

double smallest_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const auto angle = [](const glm::dvec3& u, const glm::dvec3& v) {
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
  };
  return std::min({angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c)});
}

class Cutter {
 public:
  Cutter(std::span<const glm::dvec3> corners, std::vector<glm::dvec2> flat)
      : corners_(corners), flat_(std::move(flat)) {}

  std::vector<Triangle> run() {
    clip();
    flip();
    return std::move(triangles_);
  }

 private:
  int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return side_of_line(flat_[a], flat_[b], flat_[c]);
  }
  double angle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return smallest_angle(corners_[a], corners_[b], corners_[c]);
  }

  // --- ears
  struct Ear {
    double angle;  // the smallest of its triangle: the best ears are cut first
    std::uint32_t tip, version;
    bool operator<(const Ear& other) const {
      return std::pair(angle, other.tip) < std::pair(other.angle, tip);
    }
  };

  // Looks at a corner again after one beside it has gone.
  void renew(std::uint32_t at) {
    const int before = turns_[at];
    turns_[at] = turn(previous_[at], at, next_[at]);
    ++versions_[at];
    if (turns_[at] > 0) ears_.push({angle(previous_[at], at, next_[at]), at, versions_[at]});
    if (turns_[at] <= 0 && before > 0) blockers_.push_back(at);
    if (turns_[at] > 0 && before <= 0) release(at);
  }

  // The ears that this corner stood in are tried again.
  void release(std::uint32_t blocker) {
    for (const Ear& ear : waiting_[blocker])
      if (ear.version == versions_[ear.tip]) ears_.push(ear);
    waiting_[blocker].clear();
  }

  // A corner in the triangle of an ear, its border included; n where there is none. Only corners that do not
  // turn left can be the first in it.
  std::uint32_t blocker_of(std::uint32_t tip) {
    const std::uint32_t a = previous_[tip], c = next_[tip];
    std::erase_if(blockers_, [&](std::uint32_t corner) { return gone_[corner] || turns_[corner] > 0; });
    for (const std::uint32_t corner : blockers_) {
      const glm::dvec2& p = flat_[corner];
      if (p == flat_[a] || p == flat_[tip] || p == flat_[c]) continue;
      if (turn(a, tip, corner) >= 0 && turn(tip, c, corner) >= 0 && turn(c, a, corner) >= 0) return corner;
    }
    return static_cast<std::uint32_t>(flat_.size());
  }

  void cut(std::uint32_t tip) {
    const std::uint32_t a = previous_[tip], c = next_[tip];
    triangles_.push_back({a, tip, c});
    next_[a] = c;
    previous_[c] = a;
    gone_[tip] = true;
    ++versions_[tip];
    renew(a);
    renew(c);
    release(tip);
  }

  // The corner to cut where no ear is left, because the rest has no area or crosses itself: one on a line
  // with its neighbours, else the best that turns left, else the first.
  std::uint32_t forced() const {
    std::uint32_t best = static_cast<std::uint32_t>(flat_.size());
    double largest = -1;
    for (std::uint32_t i = 0; i < flat_.size(); ++i) {
      if (gone_[i]) continue;
      const double value = turns_[i] == 0 ? 10 : turns_[i] > 0 ? angle(previous_[i], i, next_[i]) : -0.5;
      if (value > largest) largest = value, best = i;
    }
    return best;
  }

  void clip() {
    const auto n = static_cast<std::uint32_t>(flat_.size());
    previous_.resize(n);
    next_.resize(n);
    turns_.assign(n, 1);
    versions_.assign(n, 0);
    gone_.assign(n, false);
    waiting_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
      previous_[i] = (i + n - 1) % n;
      next_[i] = (i + 1) % n;
    }
    for (std::uint32_t i = 0; i < n; ++i) renew(i);
    for (std::uint32_t left = n; left > 3;) {
      if (ears_.empty()) {
        cut(forced());
        --left;
        continue;
      }
      const Ear ear = ears_.top();
      ears_.pop();
      if (gone_[ear.tip] || ear.version != versions_[ear.tip]) continue;
      const std::uint32_t blocker = blocker_of(ear.tip);
      if (blocker < n) {
        waiting_[blocker].push_back(ear);
        continue;
      }
      cut(ear.tip);
      --left;
    }
    const auto last =
        static_cast<std::uint32_t>(std::find(gone_.begin(), gone_.end(), false) - gone_.begin());
    triangles_.push_back({last, next_[last], previous_[last]});
  }

  // --- flips
  // Replaces inner edges whose two triangles have a larger smallest angle with the other diagonal, which
  // takes slivers away that ears leave at corners on nearly a straight line.
  void flip() {
    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    std::map<Edge, std::size_t> owner;  // directed edge → its triangle
    std::vector<Edge> queue;
    const auto own = [&](std::size_t t) {
      for (std::size_t k = 0; k < 3; ++k) owner[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = t;
    };
    for (std::size_t t = 0; t < triangles_.size(); ++t) own(t);
    for (const auto& [edge, t] : owner)
      if (edge.first < edge.second) queue.push_back(edge);
    const auto opposite = [&](const Edge& edge) {
      const Triangle& t = triangles_[owner.at(edge)];
      for (const std::uint32_t corner : t)
        if (corner != edge.first && corner != edge.second) return corner;
      return t[0];
    };
    // Every flip enlarges the smallest angle of two triangles, so they end; the bound is for rounding.
    for (std::size_t left = 64 * flat_.size(); left > 0 && !queue.empty(); --left) {
      const Edge edge = queue.back(), back{edge.second, edge.first};
      queue.pop_back();
      const auto here = owner.find(edge), there = owner.find(back);
      if (here == owner.end() || there == owner.end()) continue;
      const auto [a, b] = edge;
      const std::uint32_t c = opposite(edge), d = opposite(back);
      if (c == d || owner.contains({c, d}) || owner.contains({d, c})) continue;
      if (turn(a, d, c) <= 0 || turn(d, b, c) <= 0) continue;
      if (std::min(angle(a, d, c), angle(d, b, c)) <= std::min(angle(a, b, c), angle(b, a, d)) + same_angle)
        continue;
      const std::size_t first = here->second, second = there->second;
      owner.erase(edge);
      owner.erase(back);
      triangles_[first] = {a, d, c};
      triangles_[second] = {d, b, c};
      own(first);
      own(second);
      for (const Edge& side : {Edge{a, d}, Edge{d, b}, Edge{b, c}, Edge{c, a}})
        queue.push_back(std::minmax(side.first, side.second));
    }
  }

  std::span<const glm::dvec3> corners_;
  std::vector<glm::dvec2> flat_;
  std::vector<std::uint32_t> previous_, next_, versions_, blockers_;
  std::vector<int> turns_;
  std::vector<bool> gone_;
  std::vector<std::vector<Ear>> waiting_;  // by the corner that blocks them
  std::priority_queue<Ear> ears_;
  std::vector<Triangle> triangles_;
};

std::vector<Triangle> fan(std::size_t corners) {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 1; i + 1 < corners; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

}  // namespace

int side_of_line(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double rough = left - right;
  // Shewchuk's bound A: (3 + 16 ε) ε with ε = 2^−53.
  if (std::abs(rough) > 3.3306690738754716e-16 * (std::abs(left) + std::abs(right)))
    return rough > 0 ? 1 : -1;
  // The six products of the determinant, each exactly as two doubles, summed without rounding: the sum is a
  // list of doubles that do not overlap, the largest last.
  std::array<double, 12> sum{};
  std::size_t count = 0;
  const auto add = [&](double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double total = value + sum[i], part = total - value;
      const double rest = (value - (total - part)) + (sum[i] - part);
      if (rest != 0) sum[kept++] = rest;
      value = total;
    }
    sum[kept++] = value;
    count = kept;
  };
  const auto add_product = [&](double u, double v) {
    const double product = u * v;
    add(std::fma(u, v, -product));
    add(product);
  };
  add_product(a.x, b.y);
  add_product(-a.x, c.y);
  add_product(-c.x, b.y);
  add_product(-a.y, b.x);
  add_product(a.y, c.x);
  add_product(c.y, b.x);
  const double value = sum[count - 1];
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

std::vector<Triangle> cut_polygon(std::span<const glm::dvec3> corners) {
  if (corners.size() <= 3) return fan(corners.size());
  std::vector<glm::dvec2> flat = in_plane(corners);
  if (flat.empty()) return fan(corners.size());
  if (corners.size() > 4) return Cutter(corners, std::move(flat)).run();
  const auto smallest = [&](const Triangle& t) {
    if (side_of_line(flat[t[0]], flat[t[1]], flat[t[2]]) <= 0) return -1.0;
    return smallest_angle(corners[t[0]], corners[t[1]], corners[t[2]]);
  };
  const std::array<Triangle, 2> first{{{0, 1, 2}, {0, 2, 3}}}, second{{{0, 1, 3}, {1, 2, 3}}};
  const bool other = std::min(smallest(second[0]), smallest(second[1])) >
                     std::min(smallest(first[0]), smallest(first[1])) + same_angle;
  const auto& best = other ? second : first;
  return {best.begin(), best.end()};
}

}  // namespace plisse
