// Triangles of any kind become oriented shells: what is joined, what is parted, what is left out.
#include "cloth/cloth_of_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace plisse::cloth {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

Surface surface_of(std::vector<glm::dvec3> places, const std::vector<Triangle>& triangles) {
  Surface surface;
  surface.rest = std::move(places);
  for (std::uint32_t v = 0; v < surface.rest.size(); ++v) surface.render_vertices.push_back({v});
  for (const Triangle& t : triangles) surface.triangles.insert(surface.triangles.end(), t.begin(), t.end());
  Part part;
  part.triangle_count = static_cast<std::uint32_t>(triangles.size());
  surface.parts = {part};
  return surface;
}

// As shells: build_topology refuses edges of three faces and faces that are turned over.
shell::Topology topology_of(const Cloth& cloth) {
  return shell::build_topology(cloth.faces, cloth.welded.size());
}

const std::vector<glm::dvec3> square = {{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},
                                        {0.5, 0, 1}, {2, 0.5, 0}, {0.5, -1, 0}};

TEST(ClothOfSurface, NeighboursThatAreTurnedOverAreTurnedBack) {
  const Cloth cloth = cloth_of(surface_of(square, {{0, 1, 2}, {0, 3, 2}, {1, 5, 2}}));
  EXPECT_EQ(cloth.turned, (std::vector<bool>{false, true, false}));
  EXPECT_EQ(cloth.cut, 0U);
  const shell::Topology topology = topology_of(cloth);
  EXPECT_EQ(topology.component_count, 1U);
  EXPECT_EQ(cloth.welded.size(), 5U);
  EXPECT_EQ(cloth.triangle, (std::vector<std::uint32_t>{0, 1, 2}));
}

// A pocket on a shirt: the sheet goes on straight, the third face is parted, with vertices of its own.
TEST(ClothOfSurface, SheetsGoOnStraightAtEdgesOfThreeFaces) {
  const Cloth cloth = cloth_of(surface_of(square, {{0, 1, 4}, {0, 1, 2}, {1, 0, 6}}));
  EXPECT_EQ(cloth.cut, 1U);
  const shell::Topology topology = topology_of(cloth);
  EXPECT_EQ(topology.component_count, 2U);
  EXPECT_EQ(topology.component[cloth.faces[1][0]], topology.component[cloth.faces[2][0]]);
}

// A sheet that is modelled twice, back to back, is two sheets and no bag.
TEST(ClothOfSurface, BackToBackIsTwoSheets) {
  const Cloth cloth = cloth_of(surface_of(square, {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}}));
  const shell::Topology topology = topology_of(cloth);
  EXPECT_EQ(topology.component_count, 2U);
  EXPECT_EQ(cloth.welded.size(), 8U);
  EXPECT_EQ(topology.component[cloth.faces[0][0]], topology.component[cloth.faces[1][0]]);
}

TEST(ClothOfSurface, SheetsThatMeetAtAVertexHaveOneEach) {
  const Cloth cloth =
      cloth_of(surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(cloth.welded, (std::vector<std::uint32_t>{0, 1, 2, 0, 3, 4}));
  EXPECT_EQ(cloth.cut, 0U);
  const shell::Positions places = cloth.places({{7, 8, 9}, {}, {}, {}, {}});
  EXPECT_EQ(places.col(3), Eigen::Vector3d(7, 8, 9));
}

TEST(ClothOfSurface, AMoebiusBandIsCutOnce) {
  constexpr int n = 12;
  std::vector<glm::dvec3> places;
  for (int i = 0; i < n; ++i) {
    const double turn = 2 * M_PI * i / n;
    for (const double side : {-0.3, 0.3})
      places.emplace_back((1 + side * std::cos(turn / 2)) * std::cos(turn),
                          (1 + side * std::cos(turn / 2)) * std::sin(turn), side * std::sin(turn / 2));
  }
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1, next = 2 * ((i + 1) % n);
    const std::uint32_t c = i + 1 < n ? next : next + 1, d = i + 1 < n ? next + 1 : next;
    triangles.push_back({a, b, c});
    triangles.push_back({b, d, c});
  }
  const Cloth cloth = cloth_of(surface_of(places, triangles));
  EXPECT_EQ(cloth.cut, 1U);
  EXPECT_EQ(topology_of(cloth).component_count, 1U);
  EXPECT_EQ(cloth.welded.size(), 2U * n + 2);  // both ends of the cut have a vertex more
}

TEST(ClothOfSurface, TrianglesWithoutAreaAreLeftOut) {
  const Cloth cloth = cloth_of(surface_of(square, {{0, 1, 1}, {0, 1, 2}}));
  EXPECT_EQ(cloth.without_area, 1U);
  EXPECT_EQ(cloth.triangle, (std::vector<std::uint32_t>{1}));
  EXPECT_THROW(cloth_of(surface_of(square, {{0, 1, 1}})), Error);
  Surface none = surface_of(square, {{0, 1, 2}});
  none.parts[0].wrinkles = false;
  EXPECT_THROW(cloth_of(none), Error);
}

}  // namespace
}  // namespace plisse::cloth
