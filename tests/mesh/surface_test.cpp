// Adjacency and rest frames on meshes small enough to do by hand.
#include "mesh/surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/frames.h"

namespace plisse {
namespace {

Surface surface_of(const std::vector<glm::dvec3>& rest, const std::vector<std::uint32_t>& triangles) {
  Surface surface;
  surface.rest = surface.bind = rest;
  surface.bind_normal.assign(rest.size(), glm::dvec3{0, 1, 0});
  for (std::uint32_t v = 0; v < rest.size(); ++v) surface.render_vertices.push_back({v, {}, {}});
  surface.triangles = triangles;
  build_adjacency(surface);
  return surface;
}

std::vector<std::uint32_t> neighbours(const Surface& surface, std::size_t v) {
  return {surface.neighbours.items.begin() + surface.neighbours.offsets[v],
          surface.neighbours.items.begin() + surface.neighbours.offsets[v + 1]};
}

// A square of two triangles in the xy-plane, diagonal 0–2.
Surface square() {
  return surface_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3});
}

TEST(Adjacency, OfASquare) {
  const Surface surface = square();
  EXPECT_EQ(neighbours(surface, 0), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(neighbours(surface, 1), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(neighbours(surface, 2), (std::vector<std::uint32_t>{0, 1, 3}));
  EXPECT_EQ(neighbours(surface, 3), (std::vector<std::uint32_t>{0, 2}));
  ASSERT_EQ(surface.corners.items.size(), 6U);
  // Vertex 2: (2, 0, 1) of the first triangle, (2, 3, 0) of the second.
  const std::uint32_t first = surface.corners.offsets[2];
  EXPECT_EQ(surface.corners.items[first].second, 0U);
  EXPECT_EQ(surface.corners.items[first].third, 1U);
  EXPECT_EQ(surface.corners.items[first + 1].second, 3U);
  EXPECT_EQ(surface.corners.items[first + 1].third, 0U);
}

TEST(Adjacency, LeavesOutTrianglesWithACornerTwice) {
  const Surface surface = surface_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {0, 1, 1, 0, 1, 2});
  EXPECT_EQ(surface.corners.items.size(), 3U);
  EXPECT_EQ(surface.neighbours.items.size(), 6U);
}

TEST(Adjacency, GoesAcrossSplitVertices) {
  Surface surface = surface_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {});
  // The second triangle has render vertices of its own, as along a uv seam.
  surface.render_vertices.push_back({0, {}, {}});
  surface.render_vertices.push_back({2, {}, {}});
  surface.triangles = {0, 1, 2, 4, 5, 3};
  build_adjacency(surface);
  EXPECT_EQ(neighbours(surface, 0), (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST(RestFrames, OfASquareByHand) {
  const Surface surface = square();
  const RestFrames frames = rest_frames(surface);
  // Longest neighbour of corner 0 is 2 along the diagonal, of corner 1 it is 0 (a tie with 2: the smaller
  // id).
  EXPECT_EQ(frames.tangent_neighbour, (std::vector<std::uint32_t>{2, 0, 0, 0}));
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(glm::distance(frames.normal[0], {0, 0, 1}), 0, 1e-15);
  EXPECT_NEAR(glm::distance(frames.tangent[0], {half, half, 0}), 0, 1e-15);
  EXPECT_NEAR(glm::distance(frames.tangent[1], {-1, 0, 0}), 0, 1e-15);
  // Neighbours 1, 2, 3 of corner 0 in (t, b), b = n × t = (−½√2, ½√2, 0). Rounding of a few units in the last
  // place.
  const std::uint32_t first = surface.neighbours.offsets[0];
  EXPECT_NEAR(glm::distance(frames.edge[first], {half, -half}), 0, 1e-15);
  EXPECT_NEAR(glm::distance(frames.edge[first + 1], {2 * half, 0}), 0, 1e-15);
  EXPECT_NEAR(glm::distance(frames.edge[first + 2], {half, half}), 0, 1e-15);
}

TEST(RestFrames, AreOrthonormalOnACrookedMesh) {
  // An octahedron pulled out of shape, a vertex without triangles, and two copies of a triangle back to back.
  Surface surface =
      surface_of({{1, 0.1, 0},
                  {-1.3, 0, 0.2},
                  {0, 2, 0},
                  {0.3, -1, 0},
                  {0, 0, 0.5},
                  {0.1, 0, -3},
                  {9, 9, 9},
                  {5, 0, 0},
                  {6, 0, 0},
                  {5, 1, 0}},
                 {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5, 7, 8, 9, 7, 9, 8});
  const RestFrames frames = rest_frames(surface);
  for (std::size_t v = 0; v < surface.rest.size(); ++v) {
    // A few roundings of doubles near 1.
    EXPECT_NEAR(glm::length(frames.normal[v]), 1, 1e-14);
    EXPECT_NEAR(glm::length(frames.tangent[v]), 1, 1e-14);
    EXPECT_NEAR(glm::dot(frames.normal[v], frames.tangent[v]), 0, 1e-14);
  }
  EXPECT_EQ(frames.tangent_neighbour[6], 6U);
  EXPECT_EQ(frames.normal[6], glm::dvec3(0, 1, 0));
  // The two sides' areas cancel: the bind normal stands in.
  EXPECT_EQ(frames.normal[7], glm::dvec3(0, 1, 0));
  // An octahedron's normals point away from its middle.
  for (std::size_t v = 0; v < 6; ++v) EXPECT_GT(glm::dot(frames.normal[v], surface.rest[v]), 0);
}

TEST(RestFrames, PerpendicularTakesTheSmallestComponentAndTheFirstOfEquals) {
  EXPECT_EQ(any_perpendicular({0, 1, 0}), glm::dvec3(1, 0, 0));
  EXPECT_EQ(any_perpendicular({1, 0, 0}), glm::dvec3(0, 1, 0));
  const glm::dvec3 p = any_perpendicular(glm::normalize(glm::dvec3{2, 2, 1}));
  // z made perpendicular to (2, 2, 1)/3: (−2, −2, 8)/√72.
  EXPECT_NEAR(glm::distance(p, glm::dvec3(-2, -2, 8) / std::sqrt(72.0)), 0, 1e-15);
}

}  // namespace
}  // namespace plisse
