// Adjacency and rest frames of the welded surface (docs/passes.md, "Data per welded vertex", "Skin",
// "Crush").
#include "mesh/surface.h"

#include <algorithm>
#include <utility>

#include "mesh/frames.h"

namespace plisse {
namespace {

// Counting sort of (row, item) pairs into compressed rows; items keep the order they were given in.
template <typename Item>
Rows<Item> rows_of(std::size_t row_count, const std::vector<std::pair<std::uint32_t, Item>>& entries) {
  Rows<Item> rows;
  rows.offsets.assign(row_count + 1, 0);
  for (const auto& [row, item] : entries) ++rows.offsets[row + 1];
  for (std::size_t i = 0; i < row_count; ++i) rows.offsets[i + 1] += rows.offsets[i];
  rows.items.resize(entries.size());
  std::vector<std::uint32_t> next(rows.offsets.begin(), rows.offsets.end() - 1);
  for (const auto& [row, item] : entries) rows.items[next[row]++] = item;
  return rows;
}

}  // namespace

void build_adjacency(Surface& surface) {
  std::vector<std::pair<std::uint32_t, Corner>> corners;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  corners.reserve(surface.triangles.size());
  edges.reserve(2 * surface.triangles.size());
  for (std::size_t first = 0; first + 2 < surface.triangles.size(); first += 3) {
    std::array<std::uint32_t, 3> v{};
    for (std::size_t c = 0; c < 3; ++c) v[c] = surface.render_vertices[surface.triangles[first + c]].welded;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t second = v[(c + 1) % 3];
      corners.emplace_back(v[c], Corner{second, v[(c + 2) % 3]});
      edges.emplace_back(v[c], second);
      edges.emplace_back(second, v[c]);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  surface.corners = rows_of(surface.vertex_count(), corners);
  surface.neighbours = rows_of(surface.vertex_count(), edges);
}

glm::dvec3 any_perpendicular(const glm::dvec3& normal) {
  const glm::dvec3 size = glm::abs(normal);
  glm::dvec3 axis{1, 0, 0};
  if (size.y < size.x && size.y <= size.z)
    axis = {0, 1, 0};
  else if (size.z < size.x && size.z < size.y)
    axis = {0, 0, 1};
  return glm::normalize(axis - glm::dot(axis, normal) * normal);
}

glm::dvec3 area_normal(const Surface& surface, const std::vector<glm::dvec3>& positions, std::size_t vertex,
                       const glm::dvec3& fallback) {
  glm::dvec3 sum{0};
  double sizes = 0;
  for (std::uint32_t i = surface.corners.offsets[vertex]; i < surface.corners.offsets[vertex + 1]; ++i) {
    const Corner& corner = surface.corners.items[i];
    const glm::dvec3 second = positions[corner.second] - positions[vertex];
    const glm::dvec3 third = positions[corner.third] - positions[vertex];
    sum += glm::cross(second, third);
    sizes += glm::length(second) * glm::length(third);
  }
  const double length = glm::length(sum);
  return length > 1e-6 * sizes ? sum / length : fallback;
}

glm::dvec3 tangent_along(const glm::dvec3& edge, const glm::dvec3& normal) {
  const glm::dvec3 tangential = edge - glm::dot(edge, normal) * normal;
  if (glm::dot(tangential, tangential) <= 1e-12 * glm::dot(edge, edge)) return any_perpendicular(normal);
  return glm::normalize(tangential);
}

RestFrames rest_frames(const Surface& surface) {
  const std::size_t count = surface.vertex_count();
  RestFrames frames;
  frames.normal.resize(count);
  frames.tangent.resize(count);
  frames.tangent_neighbour.resize(count);
  frames.edge.resize(surface.neighbours.items.size());
  for (std::size_t v = 0; v < count; ++v) {
    const glm::dvec3 n = area_normal(surface, surface.rest, v, surface.bind_normal[v]);
    const glm::dvec3 x = surface.rest[v];
    const std::uint32_t begin = surface.neighbours.offsets[v];
    const std::uint32_t end = surface.neighbours.offsets[v + 1];

    auto chosen = static_cast<std::uint32_t>(v);
    double longest = -1;
    for (std::uint32_t i = begin; i < end; ++i) {
      const glm::dvec3 e = surface.rest[surface.neighbours.items[i]] - x;
      const glm::dvec3 tangential = e - glm::dot(e, n) * n;
      const double length = glm::dot(tangential, tangential);
      if (length > longest) {
        longest = length;
        chosen = surface.neighbours.items[i];
      }
    }
    const glm::dvec3 t = tangent_along(surface.rest[chosen] - x, n);
    const glm::dvec3 b = glm::cross(n, t);
    for (std::uint32_t i = begin; i < end; ++i) {
      const glm::dvec3 e = surface.rest[surface.neighbours.items[i]] - x;
      frames.edge[i] = {glm::dot(t, e), glm::dot(b, e)};
    }
    frames.normal[v] = n;
    frames.tangent[v] = t;
    frames.tangent_neighbour[v] = chosen;
  }
  return frames;
}

}  // namespace plisse
