// Tangents of normal maps, against what a parametrised surface's derivatives say.
#include "mesh/tangents.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plisse {
namespace {

// A strip of two triangles in the plane z = 0 with uv = map · (x, y).
std::vector<TangentCorner> square(const glm::dmat2& map) {
  const glm::dvec2 at[] = {{0, 0}, {2, 0}, {0, 1}, {2, 1}};
  std::vector<TangentCorner> corners;
  for (const std::uint32_t v : {0U, 1U, 2U, 1U, 3U, 2U})
    corners.push_back({v, glm::dvec3(at[v], 0), {0, 0, 1}, map * at[v]});
  return corners;
}

TEST(Tangents, PointWhereUGrows) {
  const double angle = 0.7;
  const glm::dmat2 turned(std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle));
  for (const CornerTangent& corner : mikktspace(square(turned))) {
    EXPECT_NEAR(glm::distance(corner.tangent, {std::cos(angle), std::sin(angle), 0}), 0, 1e-12);  // roundings
    EXPECT_EQ(corner.sign, 1);
  }
}

TEST(Tangents, MirroredUvTurnsTheBitangentNotTheTangent) {
  for (const CornerTangent& corner : mikktspace(square({-1, 0, 0, 1}))) {
    EXPECT_NEAR(glm::distance(corner.tangent, {-1, 0, 0}), 0, 1e-12);
    EXPECT_EQ(corner.sign, -1);  // −1 · n × t = (0, 1, 0): where v grows
  }
}

TEST(Tangents, MirroredHalvesDoNotShareTheirCommonEdge) {
  auto corners = square({1, 0, 0, 1});
  for (std::size_t i = 3; i < 6; ++i) corners[i].uv = {2 - corners[i].uv.x, corners[i].uv.y};
  // The vertices on the edge have one number, but the halves turn against each other.
  const auto tangents = mikktspace(corners);
  EXPECT_NEAR(tangents[1].tangent.x, 1, 1e-12);
  EXPECT_NEAR(tangents[3].tangent.x, -1, 1e-12);
}

TEST(Tangents, AngleWeighsHowMuchATriangleCounts) {
  // Round one vertex: a quarter turn whose u runs along x, an eighth whose u runs along y.
  const glm::dvec3 n(0, 0, 1);
  const std::vector<TangentCorner> corners{{0, {0, 0, 0}, n, {0, 0}}, {1, {1, 0, 0}, n, {1, 0}},
                                           {2, {0, 1, 0}, n, {0, 1}}, {0, {0, 0, 0}, n, {0, 0}},
                                           {3, {0, 1, 0}, n, {1, 0}}, {4, {-1, 1, 0}, n, {1, 1}}};
  const glm::dvec3 expected = glm::normalize(glm::dvec3(std::numbers::pi / 2, std::numbers::pi / 4, 0));
  EXPECT_NEAR(glm::distance(mikktspace(corners)[0].tangent, expected), 0, 1e-12);
}

TEST(Tangents, TrianglesWithoutAreaInUvHaveNone) {
  const auto tangents = mikktspace(square({0, 0, 0, 1}));
  for (const CornerTangent& corner : tangents) EXPECT_EQ(corner.tangent, glm::dvec3(0));
}

}  // namespace
}  // namespace plisse
