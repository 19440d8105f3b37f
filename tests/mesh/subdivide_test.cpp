// Splitting a surface finely: nothing gapes, nothing is lost, and what was there keeps its number.
#include "mesh/subdivide.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"

namespace plisse {
namespace {

Surface surface_of(const std::vector<glm::dvec3>& places, const std::vector<std::uint32_t>& triangles) {
  Surface surface;
  surface.rest = surface.bind = places;
  for (std::uint32_t v = 0; v < places.size(); ++v)
    surface.render_vertices.push_back({v, glm::vec2(places[v].x, places[v].y), glm::vec3(0, 0, 1)});
  surface.triangles = triangles;
  return surface;
}

Surface octahedron() {
  return surface_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                    {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5});
}

// Places of a subdivision's positions, from any triangle that has them.
std::vector<glm::dvec3> places(const Surface& surface, const Subdivision& fine) {
  std::vector<glm::dvec3> result(fine.position_count, glm::dvec3(NAN));
  fine.for_each_point([&](std::size_t t, const FinePoint& point) {
    const glm::dvec3 b = point.barycentric();
    glm::dvec3 x(0);
    for (std::size_t c = 0; c < 3; ++c)
      x +=
          b[static_cast<int>(c)] * surface.rest[surface.render_vertices[surface.triangles[3 * t + c]].welded];
    glm::dvec3& known = result[fine.vertices[point.vertex].position];
    // One number is one place, whoever asks; roundings of numbers up to 1.
    if (!std::isnan(known.x)) {
      EXPECT_NEAR(glm::distance(known, x), 0, 1e-15);
    }
    known = x;
  });
  return result;
}

TEST(Subdivide, AClosedSurfaceStaysClosed) {
  const Surface surface = octahedron();
  for (const int n : {1, 2, 3, 7, 16}) {
    const Subdivision fine = subdivide(surface, n);
    ASSERT_EQ(fine.triangle_count(), static_cast<std::size_t>(8 * n * n));
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // directed
    for (std::size_t i = 0; i < fine.triangles.size(); ++i) {
      const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
      ++edges[{fine.vertices[fine.triangles[i]].position, fine.vertices[fine.triangles[next]].position}];
    }
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_TRUE(edges.contains({edge.second, edge.first}));  // a neighbour, turned the same way
    }
    // Euler: V − E + F = 2.
    EXPECT_EQ(fine.position_count + fine.triangle_count(), edges.size() / 2 + 2) << n;
  }
}

// Segments from 1 to 16 an edge, as a hash of its ends has it.
int some_segments(std::uint32_t a, std::uint32_t b) {
  return 1 << (7 * (a + b) + 5 * a * b) % 5;
}

TEST(Subdivide, ASurfaceWhoseEdgesDifferStaysClosed) {
  const Surface surface = octahedron();
  std::set<int> used;
  const Subdivision fine = subdivide(surface, [&](std::uint32_t a, std::uint32_t b) {
    EXPECT_EQ(some_segments(a, b), some_segments(b, a));
    return *used.insert(some_segments(a, b)).first;
  });
  ASSERT_GE(used.size(), 4U);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // directed
  for (std::size_t i = 0; i < fine.triangles.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    ++edges[{fine.vertices[fine.triangles[i]].position, fine.vertices[fine.triangles[next]].position}];
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  EXPECT_EQ(fine.position_count + fine.triangle_count(), edges.size() / 2 + 2);
  for (const glm::dvec3& x : places(surface, fine))
    EXPECT_FALSE(std::isnan(x.x));  // no vertex of no triangle
  EXPECT_EQ(fine.first_triangle.back(), fine.triangle_count());
  EXPECT_EQ(fine.first_point.back(), fine.points.size());
}

TEST(Subdivide, AnEdgeHasTheSegmentsItIsGivenAndNothingTurnsOver) {
  const Surface surface = surface_of({{0, 0, 0}, {3, 0, 0}, {0, 2, 0}}, {0, 1, 2});
  for (const int first : {1, 2, 4, 8}) {
    for (const int second : {1, 2, 4, 8}) {
      for (const int third : {1, 2, 4, 8}) {
        const Subdivision fine = subdivide(surface, [&](std::uint32_t a, std::uint32_t b) {
          return a + b == 1 ? first : a + b == 3 ? second : third;
        });
        const auto x = places(surface, fine);
        std::array<int, 3> points{};  // inside each edge
        for (const glm::dvec3& p : x) {
          const double beyond = p.x / 3 + p.y / 2 - 1;  // rounding: thirds
          if (std::abs(beyond) > 1e-12 && p.y == 0 && p.x > 0) ++points[0];
          if (std::abs(beyond) < 1e-12 && p.x > 0 && p.y > 0) ++points[1];
          if (std::abs(beyond) > 1e-12 && p.x == 0 && p.y > 0) ++points[2];
        }
        EXPECT_EQ(points, (std::array{first - 1, second - 1, third - 1}));
        double sum = 0;
        for (std::size_t t = 0; t < fine.triangle_count(); ++t) {
          const auto at = [&](std::size_t c) { return x[fine.vertices[fine.triangles[3 * t + c]].position]; };
          const double area = 0.5 * glm::cross(at(1) - at(0), at(2) - at(0)).z;
          EXPECT_GT(area, -1e-15);
          sum += area;
        }
        EXPECT_NEAR(sum, 3, 1e-13);
      }
    }
  }
}

TEST(Subdivide, SmallTrianglesFillTheLargeOne) {
  const Surface surface = surface_of({{0, 0, 0}, {3, 0, 0}, {0, 2, 0}}, {0, 1, 2});
  const Subdivision fine = subdivide(surface, 5);
  const auto x = places(surface, fine);
  for (std::size_t t = 0; t < fine.triangle_count(); ++t) {
    const auto at = [&](std::size_t c) { return x[fine.vertices[fine.triangles[3 * t + c]].position]; };
    // All alike, and none turned over.
    EXPECT_NEAR(0.5 * glm::cross(at(1) - at(0), at(2) - at(0)).z, 3.0 / 25, 1e-14);
  }
}

TEST(Subdivide, VerticesThatWereThereKeepTheirNumbers) {
  const Surface surface = octahedron();
  const auto x = places(surface, subdivide(surface, 4));
  for (std::size_t v = 0; v < surface.vertex_count(); ++v) EXPECT_EQ(x[v], surface.rest[v]);
}

TEST(Subdivide, ASeamOfUvSplitsVerticesButNeitherPlacesNorNormals) {
  // Two triangles with a common edge 1–2, whose vertices the file has twice.
  Surface surface = surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 4, 3, 5});
  surface.render_vertices.push_back({1, glm::vec2(5, 0), glm::vec3(0, 0, 1)});
  surface.render_vertices.push_back({2, glm::vec2(5, 1), glm::vec3(0, 0, 1)});
  const Subdivision seam = subdivide(surface, 3);
  EXPECT_EQ(seam.vertices.size(), 20U);  // ten a triangle
  EXPECT_EQ(seam.position_count, 16U);   // four on the edge are shared
  EXPECT_EQ(seam.normal_count, 16U);
  surface.render_vertices[4].normal = surface.render_vertices[5].normal = {1, 0, 0};
  const Subdivision hard = subdivide(surface, 3);
  EXPECT_EQ(hard.position_count, 16U);
  EXPECT_EQ(hard.normal_count, 20U);
}

TEST(Subdivide, TooManyTrianglesAreRefused) {
  Surface surface = octahedron();
  for (int i = 0; i < 8; ++i) {
    const auto more = surface.triangles;
    surface.triangles.insert(surface.triangles.end(), more.begin(), more.end());
  }
  EXPECT_THROW(subdivide(surface, 1 << 10), Error);
}

}  // namespace
}  // namespace plisse
