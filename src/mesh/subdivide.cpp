#include "mesh/subdivide.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/log.h"

namespace plisse {
namespace {

using Steps = std::array<int, 3>;  // how many segments lead toward each corner, together all of them

// A triangle's segments, and those of each edge: edge c lies opposite corner c.
struct Split {
  int segments = 1;
  std::array<int, 3> edges{1, 1, 1};
};

// Points on an edge that has fewer segments move along it to the nearest that it has (ties: toward the corner
// that comes next), in steps of the triangle's own.
Steps snapped(Steps steps, const Split& split) {
  for (std::size_t c = 0; c < 3; ++c) {
    const int own = split.edges[c];
    if (steps[c] > 0 || own == split.segments) continue;
    const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
    const int ratio = split.segments / own;
    steps[b] = (2 * steps[b] + ratio - 1) / (2 * ratio) * ratio;
    steps[a] = split.segments - steps[b];
  }
  return steps;
}

// Numbers the points of triangles whose corners are numbered already: the same number for the same point of
// an edge, whichever triangle asks and however it runs through the edge.
class Numbering {
 public:
  explicit Numbering(std::size_t corners) : next_(corners) {}

  std::size_t number(const std::array<std::uint32_t, 3>& corners, const Steps& steps, const Split& split) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (steps[c] == split.segments) return corners[c];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (steps[c] > 0) continue;
      const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
      const bool forward = corners[a] < corners[b] || (corners[a] == corners[b] && a < b);
      const auto key = forward ? std::pair(corners[a], corners[b]) : std::pair(corners[b], corners[a]);
      const auto [edge, fresh] = edges_.try_emplace(std::uint64_t{key.first} << 32U | key.second, next_);
      if (fresh) next_ += static_cast<std::size_t>(split.edges[c] - 1);
      const int along = steps[forward ? b : a] / (split.segments / split.edges[c]);
      return edge->second + static_cast<std::size_t>(along - 1);
    }
    return next_++;
  }
  std::size_t count() const { return next_; }

 private:
  std::size_t next_;
  std::unordered_map<std::uint64_t, std::size_t> edges_;  // → the first number on it
};

// Render vertices of one welded vertex share a normal where theirs are equal bit for bit.
std::vector<std::uint32_t> normal_groups(const Surface& surface, std::size_t& count) {
  std::map<std::pair<std::uint32_t, std::array<float, 3>>, std::uint32_t> groups;
  std::vector<std::uint32_t> of;
  for (const RenderVertex& vertex : surface.render_vertices) {
    const auto& n = vertex.normal;
    of.push_back(
        groups.try_emplace({vertex.welded, {n.x, n.y, n.z}}, static_cast<std::uint32_t>(groups.size()))
            .first->second);
  }
  count = groups.size();
  return of;
}

void check_count(std::size_t count) {
  if (count > std::numeric_limits<std::uint32_t>::max() / 4) {
    throw Error(ExitCode::bad_input,
                fmt::format("{} small triangles and more are too many; take fewer levels", count));
  }
}

}  // namespace

Subdivision subdivide(const Surface& surface, int segments) {
  return subdivide(surface, [segments](std::uint32_t, std::uint32_t) { return segments; });
}

Subdivision subdivide(const Surface& surface, const EdgeSegments& segments) {
  Subdivision fine;
  std::size_t normal_count = 0;
  const std::vector<std::uint32_t> normal_of = normal_groups(surface, normal_count);
  Numbering vertices(surface.render_vertices.size()), positions(surface.vertex_count()),
      normals(normal_count);

  std::vector<Split> splits(surface.triangle_count());
  std::size_t point_count = 0, small_count = 0;
  for (std::size_t t = 0; t < splits.size(); ++t) {
    const auto welded = [&](std::size_t c) {
      return surface.render_vertices[surface.triangles[3 * t + c % 3]].welded;
    };
    for (std::size_t c = 0; c < 3; ++c) splits[t].edges[c] = segments(welded(c + 1), welded(c + 2));
    splits[t].segments = std::ranges::max(splits[t].edges);
    const auto n = static_cast<std::size_t>(splits[t].segments);
    point_count += (n + 1) * (n + 2) / 2;
    small_count += n * n;
    check_count(std::max(point_count, small_count));
  }
  fine.points.reserve(point_count);
  fine.triangles.reserve(3 * small_count);

  std::vector<std::uint32_t> ids;  // of a triangle's points, in rows: i segments toward B, j toward C
  for (std::size_t t = 0; t < splits.size(); ++t) {
    fine.first_point.push_back(static_cast<std::uint32_t>(fine.points.size()));
    fine.first_triangle.push_back(static_cast<std::uint32_t>(fine.triangle_count()));
    std::array<std::uint32_t, 3> corners{}, welded{}, normal{};
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] = surface.triangles[3 * t + c];
      welded[c] = surface.render_vertices[corners[c]].welded;
      normal[c] = normal_of[corners[c]];
    }
    const Split& split = splits[t];
    const int n = split.segments;
    ids.clear();
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Steps own{n - i - j, i, j}, steps = snapped(own, split);
        const std::size_t id = vertices.number(corners, steps, split);
        ids.push_back(static_cast<std::uint32_t>(id));
        if (steps != own) continue;  // moved onto another point, which sets the vertex itself
        if (fine.vertices.size() <= id) fine.vertices.resize(std::max(id + 1, vertices.count()));
        fine.vertices[id] = {static_cast<std::uint32_t>(positions.number(welded, steps, split)),
                             static_cast<std::uint32_t>(normals.number(normal, steps, split))};
        fine.points.push_back({static_cast<std::uint32_t>(id), static_cast<std::uint16_t>(i),
                               static_cast<std::uint16_t>(j), static_cast<std::uint16_t>(n)});
      }
    }
    // Row i begins after i rows of n+1, n, … points.
    const auto point = [&](int i, int j) {
      return ids[static_cast<std::size_t>(i * (2 * n + 3 - i) / 2 + j)];
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (a == b || b == c || c == a) return;
      for (const std::uint32_t id : {a, b, c}) fine.triangles.push_back(id);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        add(point(i, j), point(i + 1, j), point(i, j + 1));
        if (i + j + 1 < n) add(point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
      }
    }
  }
  fine.first_point.push_back(static_cast<std::uint32_t>(fine.points.size()));
  fine.first_triangle.push_back(static_cast<std::uint32_t>(fine.triangle_count()));
  // Render vertices that no triangle has keep their places.
  fine.vertices.resize(vertices.count());
  fine.position_count = positions.count();
  fine.normal_count = normals.count();
  for (std::size_t v = 0; v < surface.render_vertices.size(); ++v)
    fine.vertices[v] = {surface.render_vertices[v].welded, normal_of[v]};
  return fine;
}

int halvings(double segments) {
  int levels = 0;
  while (levels < most_levels && std::exp2(levels) < segments) ++levels;
  return levels;
}

int levels_for(double waves, std::size_t triangles, double most) {
  const double segments = segments_per_wave * waves;
  int levels = halvings(segments);
  const int wanted = levels;
  while (levels > 0 && static_cast<double>(triangles) * std::exp2(2 * levels) > most) --levels;
  if (levels < wanted || std::exp2(levels) < segments) {
    log::warn(fmt::format(
        "the longest edge has {:.1f} waves; edges are halved {} times, which gives a wave {:.1f} segments "
        "there in place of {:.0f}",
        waves, levels, std::exp2(levels) * segments_per_wave / segments, segments_per_wave));
  }
  return levels;
}

}  // namespace plisse
