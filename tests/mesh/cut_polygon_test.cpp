// Polygons cut into triangles: the triangles turn as the polygon does and add up to its area, so that they
// lie inside it and do not overlap.
#include "mesh/cut_polygon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

namespace plisse {
namespace {

using Corners = std::vector<glm::dvec3>;

// Twice the directed area.
glm::dvec3 doubled(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::cross(b - a, c - a);
}
glm::dvec3 doubled(const Corners& polygon) {
  glm::dvec3 sum{0};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) sum += doubled(polygon[0], polygon[i], polygon[i + 1]);
  return sum;
}

// Checks number, direction and areas of the triangles of a flat polygon that does not cross itself; returns
// the smallest height of a triangle over its longest side, relative to that side.
double check(const Corners& polygon) {
  const auto triangles = cut_polygon(polygon);
  EXPECT_EQ(triangles.size(), polygon.size() - 2);
  const glm::dvec3 whole = doubled(polygon), up = glm::normalize(whole);
  double sum = 0, thinnest = 1;
  std::vector<bool> used(polygon.size(), false);
  for (const auto& [a, b, c] : triangles) {
    const glm::dvec3 part = doubled(polygon.at(a), polygon.at(b), polygon.at(c));
    EXPECT_GE(glm::dot(part, up), -1e-12 * glm::length(whole)) << a << " " << b << " " << c;
    sum += glm::length(part);
    used[a] = used[b] = used[c] = true;
    const double longest =
        std::max({glm::distance(polygon[a], polygon[b]), glm::distance(polygon[b], polygon[c]),
                  glm::distance(polygon[c], polygon[a])});
    thinnest = std::min(thinnest, glm::length(part) / (longest * longest));
  }
  // A few thousand roundings of sums.
  EXPECT_NEAR(sum, glm::length(whole), 1e-12 * glm::length(whole));
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  return thinnest;
}

// From every first corner, in both directions.
double check_from_all(Corners polygon) {
  double thinnest = 1;
  for (int direction = 0; direction < 2; ++direction) {
    for (std::size_t first = 0; first < polygon.size(); ++first) {
      thinnest = std::min(thinnest, check(polygon));
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    }
    std::reverse(polygon.begin(), polygon.end());
  }
  return thinnest;
}

Corners turned(Corners polygon) {
  const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  for (glm::dvec3& corner : polygon) corner = turn * corner + glm::dvec3(0.3, -4, 0.1);
  return polygon;
}

TEST(CutPolygon, ConcaveOnesFromEveryCorner) {
  const Corners ell{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  const Corners arrow{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5, 1, 0}};
  const Corners comb{{0, 0, 0}, {7, 0, 0}, {7, 3, 0}, {6, 1, 0}, {5, 3, 0},
                     {4, 1, 0}, {3, 3, 0}, {2, 1, 0}, {1, 3, 0}, {0, 1, 0}};
  for (const Corners& polygon : {ell, arrow, comb}) {
    check_from_all(polygon);
    check_from_all(turned(polygon));
  }
}

TEST(CutPolygon, CornersOnAStraightLine) {
  // A triangle whose sides have further corners, exactly and nearly on them. A triangle of three corners of
  // one side would have no height: the thinnest possible ones have a third of a side as base.
  Corners triangle;
  const Corners ends{{0, 0, 0}, {3, 0, 0}, {1.5, 2.5, 0}};
  for (std::size_t side = 0; side < 3; ++side)
    for (int k = 0; k < 3; ++k) triangle.push_back(glm::mix(ends[side], ends[(side + 1) % 3], k / 3.0));
  EXPECT_GT(check_from_all(triangle), 0.1);
  EXPECT_GT(check_from_all(turned(triangle)), 0.1);
  // A corner just outside a square's side: the largest ears would leave it in a triangle of no height.
  EXPECT_GT(check_from_all({{0, 0, 0}, {1, -1e-9, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}), 0.3);
  // As single precision leaves them, inside and outside the line.
  std::mt19937 random(1);
  for (int n = 0; n < 20; ++n) {
    Corners near = triangle;
    const auto step = [&] { return static_cast<double>(random() % 3) - 1; };
    for (glm::dvec3& corner : near) corner += 1e-7 * glm::dvec3(step(), step(), 0);
    EXPECT_GT(check_from_all(near), 0.1);
  }
}

// A square with a square hole, as files write it: a bridge of two edges on one place leads to the hole.
TEST(CutPolygon, BridgeToAHole) {
  const Corners square{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                       {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
  EXPECT_NEAR(glm::length(doubled(square)), 16, 1e-12);
  check_from_all(square);
  check_from_all(turned(square));
}

TEST(CutPolygon, StarsAndSpirals) {
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int n = 5; n < 60; ++n) {
    Corners star;
    for (int i = 0; i < n; ++i) {
      const double angle = glm::two_pi<double>() * i / n, radius = 0.1 + number();
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    check(star);
    check(turned(star));
    // A band that winds three times round: nearly every corner of its inner side turns right.
    Corners spiral;
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i) {
        const double t = 18.0 * (side == 0 ? i : n - 1 - i) / (n - 1),
                     radius = 1 + 0.2 * t + (side == 0 ? 0 : -0.5);
        spiral.emplace_back(radius * std::cos(t), radius * std::sin(t), 0);
      }
    if (n > 40) check(spiral);
  }
}

TEST(CutPolygon, QuadsByTheBetterDiagonal) {
  using testing::ElementsAre;
  using T = std::array<std::uint32_t, 3>;
  // A rectangle: both diagonals are alike, and its decimals' rounding does not choose.
  EXPECT_THAT(cut_polygon(Corners{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1000001, 0}, {0, 0.1, 0}}),
              ElementsAre(T{0, 1, 2}, T{0, 2, 3}));
  // A kite, flat and folded: the short diagonal.
  for (const double fold : {0.0, 0.3}) {
    EXPECT_THAT(cut_polygon(Corners{{0, 0, 0}, {1, -0.2, fold}, {2, 0, 0}, {1, 0.2, fold}}),
                ElementsAre(T{0, 1, 3}, T{1, 2, 3}));
    EXPECT_THAT(cut_polygon(Corners{{1, -0.2, fold}, {2, 0, 0}, {1, 0.2, fold}, {0, 0, 0}}),
                ElementsAre(T{0, 1, 2}, T{0, 2, 3}));
  }
  // A corner in the middle of an edge belongs to no triangle without area.
  EXPECT_GT(check_from_all({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}), 0.4);
}

// Without an inside there is no right answer, but an answer, with every corner in its place.
TEST(CutPolygon, WithoutAnInside) {
  for (const Corners& polygon :
       {Corners{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
        Corners{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}, Corners(6, glm::dvec3(1, 2, 3)),
        Corners(5, glm::dvec3(0)), Corners{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}, {2, 5, 0}, {3, -1, 0}},
        Corners{{0, 0, 0}, {1e300, 0, 0}, {1e300, 1e300, 0}, {0, 1e300, 0}, {-1, 5, 0}},
        Corners{{0, 0, 0}, {1e-320, 0, 0}, {1e-320, 1e-320, 0}, {0, 1e-320, 0}}}) {
    const auto triangles = cut_polygon(polygon);
    EXPECT_EQ(triangles.size(), polygon.size() - 2);
    for (const auto& triangle : triangles)
      for (const std::uint32_t corner : triangle) EXPECT_LT(corner, polygon.size());
  }
}

// Kettner et al. 2008, "Classroom examples of robustness problems": points one unit in the last place apart
// near a line, where plain doubles give the wrong sign. The right sign here: c is on the side that its own
// small step from the line says.
TEST(CutPolygon, SideOfALineIsExact) {
  const glm::dvec2 a(12, 12), b(24, 24);
  const double step = std::ldexp(1.0, -53);
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) {
      const glm::dvec2 c(0.5 + i * step, 0.5 + j * step);
      ASSERT_EQ(side_of_line(a, b, c), (c.y > c.x) - (c.y < c.x)) << i << " " << j;
      ASSERT_EQ(side_of_line(b, a, c), (c.y < c.x) - (c.y > c.x)) << i << " " << j;
    }
}

}  // namespace
}  // namespace plisse
