// The triangulation against its definition: empty circles, Euler's formula, areas, and constraints that are
// there.
#include "sizing/delaunay.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace plisse::sizing {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::map<Edge, std::uint16_t> tagged_edges(const Triangulation& mesh) {
  std::map<Edge, std::uint16_t> edges;
  for (const auto& triangle : mesh.triangles()) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = triangle.vertex[(i + 1) % 3], b = triangle.vertex[(i + 2) % 3];
      if (triangle.tag[i] != Triangulation::free_edge) edges[std::minmax(a, b)] = triangle.tag[i];
    }
  }
  return edges;
}

// Neighbours know each other, tags agree, all areas are positive and sum to the frame's, and every free edge
// is locally Delaunay (which makes the whole constrained Delaunay).
void expect_sound(const Triangulation& mesh) {
  const auto& points = mesh.points();
  __extension__ __int128 area = 0;
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    const auto& triangle = mesh.triangles()[t];
    const auto [a, b, c] = triangle.vertex;
    const std::int64_t twice = orientation(points[a], points[b], points[c]);
    EXPECT_GT(twice, 0);
    area += twice;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t other = triangle.neighbour[i];
      if (other == Triangulation::none) continue;
      const auto& across = mesh.triangles()[other];
      std::size_t j = 0;
      while (j < 3 && across.neighbour[j] != t) ++j;
      ASSERT_LT(j, 3U);
      EXPECT_EQ(across.vertex[(j + 1) % 3], triangle.vertex[(i + 2) % 3]);
      EXPECT_EQ(across.vertex[(j + 2) % 3], triangle.vertex[(i + 1) % 3]);
      EXPECT_EQ(across.tag[j], triangle.tag[i]);
      if (triangle.tag[i] == Triangulation::free_edge) {
        EXPECT_LE(in_circle(points[a], points[b], points[c], points[across.vertex[j]]), 0);
      }
    }
    for (const std::uint32_t v : triangle.vertex) EXPECT_LT(mesh.triangle_at(v), mesh.triangles().size());
  }
  const std::int64_t side = 4LL * Triangulation::limit;
  EXPECT_TRUE(area == static_cast<__int128>(side) * side * 2);
  EXPECT_EQ(mesh.triangles().size(), 2 * mesh.points().size() - 6);  // Euler, with four vertices on the hull
}

GridPoint somewhere(std::mt19937& random, std::int32_t reach) {
  const auto span = static_cast<std::uint32_t>(2 * reach + 1);
  return {static_cast<std::int32_t>(random() % span) - reach,
          static_cast<std::int32_t>(random() % span) - reach};
}

TEST(Predicates, AreExactAtTheEndsOfTheGrid) {
  constexpr std::int32_t far = Triangulation::limit;
  // A line over the whole grid, and the point beside its middle.
  EXPECT_EQ(orientation({-far, -far}, {far, far}, {0, 0}), 0);
  EXPECT_GT(orientation({-far, -far}, {far, far}, {0, 1}), 0);
  EXPECT_LT(orientation({-far, -far}, {far, far}, {1, 0}), 0);
  // Four corners of a square lie on a circle; one unit in or out decides.
  EXPECT_EQ(in_circle({-far, -far}, {far, -far}, {far, far}, {-far, far}), 0);
  EXPECT_EQ(in_circle({-far, -far}, {far, -far}, {far, far}, {-far + 1, far}), 1);
  EXPECT_EQ(in_circle({-far, -far}, {far, -far}, {far, far}, {-far, far + 1}), -1);
}

TEST(Delaunay, RandomPointsAndRepeats) {
  for (const std::int32_t reach : {3, 40, 1000, Triangulation::limit}) {
    std::mt19937 random(7);
    Triangulation mesh;
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint32_t> known;
    for (int i = 0; i < 800; ++i) {
      const GridPoint point = somewhere(random, reach);
      const std::uint32_t vertex = mesh.insert(point);
      const auto [entry, fresh] = known.try_emplace({point.x, point.y}, vertex);
      EXPECT_EQ(entry->second, vertex);
      EXPECT_EQ(mesh.points()[vertex], point);
    }
    EXPECT_EQ(mesh.points().size(), known.size() + Triangulation::frame_vertices);
    expect_sound(mesh);
  }
}

TEST(Delaunay, LatticeWhereEveryCircleHasFourPoints) {
  Triangulation mesh;
  for (std::int32_t y = -10; y <= 10; ++y) {
    for (std::int32_t x = -10; x <= 10; ++x) mesh.insert({x * 1000, y * 1000});
  }
  expect_sound(mesh);
}

TEST(Delaunay, ConstraintsAreThereAndCrossingsBecomeVertices) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    std::mt19937 random(seed);
    Triangulation mesh;
    for (int i = 0; i < 300; ++i) mesh.insert(somewhere(random, 100000));
    const std::uint32_t a = mesh.insert({-100000, 3}), b = mesh.insert({100000, 3});
    const std::uint32_t c = mesh.insert({7, -100000}), d = mesh.insert({7, 100000});
    mesh.constrain(a, b, 1);
    mesh.constrain(c, d, 2);
    expect_sound(mesh);
    const std::uint32_t crossing = mesh.insert({7, 3});  // exact here, and there already
    std::map<std::uint16_t, double> lengths;
    std::set<std::uint16_t> at_crossing;
    for (const auto& [edge, tag] : tagged_edges(mesh)) {
      const GridPoint p = mesh.points()[edge.first], q = mesh.points()[edge.second];
      EXPECT_TRUE(tag != 1 || (p.y == 3 && q.y == 3));
      EXPECT_TRUE(tag != 2 || (p.x == 7 && q.x == 7));
      lengths[tag] += std::abs(double{1} * p.x - q.x) + std::abs(double{1} * p.y - q.y);
      if (edge.first == crossing || edge.second == crossing) at_crossing.insert(tag);
    }
    EXPECT_EQ(lengths[1], 200000);
    EXPECT_EQ(lengths[2], 200000);
    EXPECT_EQ(at_crossing.size(), 2U);
  }
}

TEST(Delaunay, ConstraintsGoThroughVerticesOnTheirWay) {
  Triangulation mesh;
  const std::uint32_t a = mesh.insert({-500, 0}), b = mesh.insert({500, 0});
  const std::uint32_t between = mesh.insert({100, 0});
  mesh.constrain(a, b, 5);
  const auto edges = tagged_edges(mesh);
  EXPECT_EQ(edges.size(), 2U);
  EXPECT_TRUE(edges.contains(std::minmax(a, between)));
  EXPECT_TRUE(edges.contains(std::minmax(between, b)));
  mesh.insert({300, 0});  // on the constraint: both halves keep it
  EXPECT_EQ(tagged_edges(mesh).size(), 3U);
  expect_sound(mesh);
}

TEST(Delaunay, ManyCrossingConstraintsStaySound) {
  std::mt19937 random(11);
  Triangulation mesh;
  for (std::uint16_t k = 1; k <= 40; ++k) {
    const std::uint32_t a = mesh.insert(somewhere(random, 50000)), b = mesh.insert(somewhere(random, 50000));
    mesh.constrain(a, b, k);
  }
  expect_sound(mesh);
}

TEST(Delaunay, InsideIsWhatTheOutlineHoldsWithoutItsHole) {
  Triangulation mesh;
  const auto ring = [&](std::int32_t r, std::uint16_t tag) {
    const std::uint32_t corner[] = {mesh.insert({-r, -r}), mesh.insert({r, -r}), mesh.insert({r, r}),
                                    mesh.insert({-r, r})};
    for (std::size_t i = 0; i < 4; ++i) mesh.constrain(corner[i], corner[(i + 1) % 4], tag);
  };
  ring(1000, 1);
  ring(300, 2);
  ring(600, 3);  // a feature: parts nothing
  mesh.mark_inside(2);
  std::int64_t twice = 0;
  for (const auto& t : mesh.triangles()) {
    if (t.inside)
      twice +=
          orientation(mesh.points()[t.vertex[0]], mesh.points()[t.vertex[1]], mesh.points()[t.vertex[2]]);
  }
  EXPECT_EQ(twice, 2 * (2000 * 2000 - 600 * 600));
}

TEST(Delaunay, MovesThatWouldTurnATriangleOverAreRefused) {
  std::mt19937 random(3);
  Triangulation mesh;
  for (int i = 0; i < 200; ++i) mesh.insert(somewhere(random, 10000));
  int moved = 0;
  for (std::uint32_t v = Triangulation::frame_vertices; v < mesh.points().size(); ++v) {
    const GridPoint before = mesh.points()[v], to = somewhere(random, 10000);
    if (mesh.move(v, to)) {
      ++moved;
      EXPECT_EQ(mesh.points()[v], to);
    } else {
      EXPECT_EQ(mesh.points()[v], before);
    }
    const GridPoint near{mesh.points()[v].x + 3, mesh.points()[v].y - 2};
    moved += mesh.move(v, near);
  }
  EXPECT_GT(moved, 50);
  mesh.legalise();
  expect_sound(mesh);
}

}  // namespace
}  // namespace plisse::sizing
