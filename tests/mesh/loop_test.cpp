// Loop's masks as Loop and OpenSubdiv's documentation have them, and meshes that are no surfaces.
#include "mesh/loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "support/errors.h"

namespace plisse {
namespace {

using Faces = std::vector<std::array<std::uint32_t, 3>>;

// Vertex 0 with a ring of `valence` vertices round it, and another ring outside, so that nothing that touches
// vertex 0 is on the outline.
Faces two_rings(std::uint32_t valence) {
  Faces faces;
  for (std::uint32_t i = 0; i < valence; ++i) {
    const std::uint32_t a = 1 + i, b = 1 + (i + 1) % valence, c = a + valence, d = b + valence;
    faces.push_back({0, a, b});
    faces.push_back({a, c, d});
    faces.push_back({a, d, b});
  }
  return faces;
}

std::map<std::uint32_t, double> row(const Rows<LoopWeight>& masks, std::uint32_t v) {
  std::map<std::uint32_t, double> result;
  for (std::uint32_t i = masks.offsets[v]; i < masks.offsets[v + 1]; ++i)
    result[masks.items[i].vertex] += masks.items[i].weight;
  return result;
}

TEST(Loop, MasksAreLoops) {
  for (const std::uint32_t n : {3U, 5U, 6U, 9U}) {
    const LoopSubdivision loop = subdivide_loop(two_rings(n), 1 + 2 * n, 1);
    const LoopLevel &coarse = loop.levels[0], &fine = loop.levels[1];
    ASSERT_EQ(fine.faces.size(), 4 * coarse.faces.size());
    const double beta = (0.625 - std::pow(0.375 + std::cos(2 * std::numbers::pi / n) / 4, 2)) / n;
    std::size_t centre = 0, spokes = 0;
    for (std::size_t f = 0; f < fine.faces.size(); ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto& parent = coarse.faces[fine.parent[f]];
        const std::uint8_t place = fine.place[f][c];
        const auto mask = row(fine.masks, fine.faces[f][c]);
        double sum = 0;
        for (const auto& [vertex, weight] : mask) {
          EXPECT_GE(weight, 0);
          sum += weight;
        }
        EXPECT_NEAR(sum, 1, 1e-15);
        if (place < 3 && parent[place] == 0) {
          ++centre;
          ASSERT_EQ(mask.size(), n + 1);
          EXPECT_NEAR(mask.at(0), 1 - n * beta, 1e-15);
          EXPECT_NEAR(mask.at(1), beta, 1e-15);
        } else if (place >= 3 && (parent[place - 3] == 0 || parent[(place - 2) % 3] == 0)) {
          ++spokes;
          ASSERT_EQ(mask.size(), 4U);
          EXPECT_NEAR(mask.at(0), 0.375, 1e-15);
        }
      }
    }
    EXPECT_EQ(centre, n);
    EXPECT_EQ(spokes, 6 * n);  // a spoke's middle is a corner of six small faces
    // Sides know each other.
    for (std::uint32_t f = 0; f < fine.faces.size(); ++f) {
      for (std::uint32_t s = 0; s < 3; ++s) {
        const std::uint32_t beyond = fine.across[f][s];
        if (beyond == LoopLevel::none) continue;
        EXPECT_EQ(fine.across[beyond / 3][beyond % 3], 3 * f + s);
        EXPECT_EQ(fine.faces[beyond / 3][beyond % 3], fine.faces[f][(s + 1) % 3]);
      }
    }
  }
  // Where six faces meet, the limit is half the vertex and a twelfth of each neighbour; tangents are nothing
  // of constants.
  const LoopSubdivision regular = subdivide_loop(two_rings(6), 13, 0);
  const auto limit = row(regular.limit, 0);
  EXPECT_NEAR(limit.at(0), 0.5, 1e-15);
  EXPECT_NEAR(limit.at(4), 1.0 / 12, 1e-15);
  for (const auto& tangent : regular.tangents) {
    double sum = 0, size = 0;
    for (const auto& [vertex, weight] : row(tangent, 0)) {
      sum += weight;
      size += std::abs(weight);
    }
    EXPECT_NEAR(sum, 0, 1e-15);
    EXPECT_GT(size, 0.1);
  }
  // Outlines are cubic splines, sharp corners stay.
  const LoopSubdivision sharp = subdivide_loop(two_rings(6), 13, 0, {7});
  EXPECT_EQ(row(sharp.limit, 7).at(7), 1);
  EXPECT_NEAR(row(sharp.limit, 8).at(8), 2.0 / 3, 1e-15);
}

TEST(Loop, RefusesWhatIsNoSurface) {
  const auto said = [](const Faces& faces, std::uint32_t vertices) {
    return test::error_of([&] { subdivide_loop(faces, vertices, 1); });
  };
  EXPECT_NE(said({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 5).find("faces 0 and 2 run along edge 0-1"),
            std::string::npos);
  EXPECT_NE(said({{0, 1, 2}, {0, 1, 3}}, 4).find("one each way"), std::string::npos);
  EXPECT_NE(said({{0, 1, 2}, {0, 3, 4}}, 5).find("vertex 0 hang together only there"), std::string::npos);
  Faces closed_twice = {{1, 2, 3}, {0, 2, 1}, {0, 3, 2}, {0, 1, 3}};
  const Faces other = {{4, 5, 6}, {0, 5, 4}, {0, 6, 5}, {0, 4, 6}};
  closed_twice.insert(closed_twice.end(), other.begin(), other.end());
  EXPECT_NE(said(closed_twice, 7).find("vertex 0 hang together only there"), std::string::npos);
  EXPECT_NE(said({{0, 1, 9}}, 3).find("names vertex 9"), std::string::npos);
  EXPECT_NE(said({{0, 1, 1}}, 3).find("twice"), std::string::npos);
  EXPECT_NE(said({}, 3).find("no faces"), std::string::npos);
  EXPECT_EQ(said({{0, 1, 2}}, 4), "");  // a vertex that no face has is none of its business
}

}  // namespace
}  // namespace plisse
