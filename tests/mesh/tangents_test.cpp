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

// uv = (|x|, |y|) round the origin: the quarters of positive orientation lie opposite each other and their
// tangents point against each other; they only touch in the middle, where mikktspace.c keeps them apart.
TEST(Tangents, QuartersMirroredTwiceDoNotCancel) {
  const glm::dvec2 at[] = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  std::vector<TangentCorner> corners;
  for (const std::uint32_t v : {0U, 1U, 2U, 0U, 2U, 3U, 0U, 3U, 4U, 0U, 4U, 1U})
    corners.push_back({v, glm::dvec3(at[v], 0), {0, 0, 1}, glm::abs(at[v])});
  const auto tangents = mikktspace(corners);
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    const bool left = quarter == 1 || quarter == 2, below = quarter >= 2;
    EXPECT_NEAR(tangents[3 * quarter].tangent.x, left ? -1 : 1, 1e-12) << quarter;
    EXPECT_EQ(tangents[3 * quarter].sign, left != below ? -1 : 1) << quarter;
  }
}

TEST(Tangents, AngleWeighsHowMuchATriangleCounts) {
  // Round one vertex: a quarter turn whose u runs along x, then an eighth whose u runs along x + y.
  const glm::dvec3 at[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  const glm::dvec2 uv[] = {{0, 0}, {1, 0}, {0, 1}, {-1, 2}};
  std::vector<TangentCorner> corners;
  for (const std::uint32_t v : {0U, 1U, 2U, 0U, 2U, 3U}) corners.push_back({v, at[v], {0, 0, 1}, uv[v]});
  const double eighth = std::numbers::pi / 4;
  const glm::dvec3 expected =
      glm::normalize(2 * eighth * glm::dvec3(1, 0, 0) + eighth * glm::normalize(glm::dvec3(1, 1, 0)));
  EXPECT_NEAR(glm::distance(mikktspace(corners)[0].tangent, expected), 0, 1e-12);
}

TEST(Tangents, TrianglesWithoutAreaInUvHaveNone) {
  const auto tangents = mikktspace(square({0, 0, 0, 1}));
  for (const CornerTangent& corner : tangents) EXPECT_EQ(corner.tangent, glm::dvec3(0));
}

}  // namespace
}  // namespace plisse
