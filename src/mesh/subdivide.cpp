#include "mesh/subdivide.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "base/error.h"

namespace plisse {
namespace {

// Numbers the points of triangles whose corners are numbered already: the same number for the same point of
// an edge, whichever triangle asks and however it runs through the edge.
class Numbering {
 public:
  Numbering(std::size_t corners, int segments) : next_(corners), segments_(segments) {}

  // `steps`: how many of the segments lead toward each corner, together all of them.
  std::size_t number(const std::array<std::uint32_t, 3>& corners, const std::array<int, 3>& steps) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (steps[c] == segments_) return corners[c];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (steps[c] > 0) continue;
      const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
      const bool forward = corners[a] < corners[b] || (corners[a] == corners[b] && a < b);
      const auto key = forward ? std::pair(corners[a], corners[b]) : std::pair(corners[b], corners[a]);
      const auto [edge, fresh] = edges_.try_emplace(std::uint64_t{key.first} << 32U | key.second, next_);
      if (fresh) next_ += static_cast<std::size_t>(segments_ - 1);
      return edge->second + static_cast<std::size_t>(steps[forward ? b : a] - 1);
    }
    return next_++;
  }
  std::size_t count() const { return next_; }

 private:
  std::size_t next_;
  int segments_;
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

}  // namespace

Subdivision subdivide(const Surface& surface, int segments) {
  Subdivision fine;
  fine.segments = segments;
  std::vector<std::array<int, 3>> steps;  // toward A, B, C
  for (int i = 0; i <= segments; ++i) {
    for (int j = 0; i + j <= segments; ++j) {
      steps.push_back({segments - i - j, i, j});
      fine.lattice.push_back(glm::dvec3(segments - i - j, i, j) / static_cast<double>(segments));
    }
  }
  std::size_t normal_count = 0;
  const std::vector<std::uint32_t> normal_of = normal_groups(surface, normal_count);
  Numbering vertices(surface.render_vertices.size(), segments), positions(surface.vertex_count(), segments),
      normals(normal_count, segments);
  const std::size_t triangles = surface.triangle_count(),
                    small = static_cast<std::size_t>(segments) * static_cast<std::size_t>(segments);
  if (triangles * fine.lattice.size() > std::numeric_limits<std::uint32_t>::max() / 4) {
    throw Error(
        ExitCode::bad_input,
        fmt::format("{} triangles split into {} each are too many; take fewer levels", triangles, small));
  }
  fine.points.reserve(triangles * fine.lattice.size());
  fine.triangles.reserve(3 * triangles * small);
  for (std::size_t t = 0; t < triangles; ++t) {
    std::array<std::uint32_t, 3> corners{}, welded{}, normal{};
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] = surface.triangles[3 * t + c];
      welded[c] = surface.render_vertices[corners[c]].welded;
      normal[c] = normal_of[corners[c]];
    }
    const std::size_t first = fine.points.size();
    for (const auto& step : steps) {
      const std::size_t id = vertices.number(corners, step);
      if (fine.vertices.size() <= id) fine.vertices.resize(std::max(id + 1, vertices.count()));
      fine.vertices[id] = {static_cast<std::uint32_t>(positions.number(welded, step)),
                           static_cast<std::uint32_t>(normals.number(normal, step))};
      fine.points.push_back(static_cast<std::uint32_t>(id));
    }
    // Row i begins after i rows of n+1, n, … points.
    const auto point = [&](int i, int j) {
      return fine.points[first + static_cast<std::size_t>(i * (2 * segments + 3 - i) / 2 + j)];
    };
    for (int i = 0; i < segments; ++i) {
      for (int j = 0; i + j < segments; ++j) {
        for (const auto id : {point(i, j), point(i + 1, j), point(i, j + 1)}) fine.triangles.push_back(id);
        if (i + j + 1 == segments) continue;
        for (const auto id : {point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)})
          fine.triangles.push_back(id);
      }
    }
  }
  // Render vertices that no triangle has keep their places.
  fine.vertices.resize(vertices.count());
  fine.position_count = positions.count();
  fine.normal_count = normals.count();
  for (std::size_t v = 0; v < surface.render_vertices.size(); ++v)
    fine.vertices[v] = {surface.render_vertices[v].welded, normal_of[v]};
  return fine;
}

}  // namespace plisse
