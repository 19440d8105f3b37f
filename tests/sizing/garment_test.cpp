// Panels sewn together: both sides of a seam meet vertex by vertex, and what comes out is a surface.
#include "sizing/garment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "support/errors.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;

Panel rectangle(const std::string& name, double width, double height) {
  Panel panel;
  panel.name = name;
  panel.fabric = *find_fabric("wine-style");  // 7.8 mm
  panel.outline = {{{0, 0}, {width, 0}, {width, height}, {0, height}}, true};
  return panel;
}

Seam seam(std::size_t a, dvec2 a_from, dvec2 a_to, std::size_t b, dvec2 b_from, dvec2 b_to) {
  return {"s", {a, a_from, a_to}, {b, b_from, b_to}};
}

struct Topology {
  std::size_t vertices = 0, edges = 0, triangles = 0, boundary = 0, crowded = 0;
  int euler() const {
    return static_cast<int>(vertices) - static_cast<int>(edges) + static_cast<int>(triangles);
  }
};

Topology topology_of(const SizedGarment& garment) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::set<std::uint32_t> used;
  Topology result;
  for (std::size_t p = 0; p < garment.panels.size(); ++p)
    for (const auto& triangle : garment.panels[p]->mesh.triangles) {
      ++result.triangles;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = garment.sewn[garment.first[p] + triangle[i]],
                            b = garment.sewn[garment.first[p] + triangle[(i + 1) % 3]];
        used.insert(a);
        ++edges[std::minmax(a, b)];
      }
    }
  result.vertices = used.size();
  result.edges = edges.size();
  for (const auto& [edge, count] : edges) {
    result.boundary += count == 1;
    result.crowded += count > 2;
  }
  return result;
}

TEST(Garment, TwoRectanglesMakeAPillow) {
  Garment pillow;
  pillow.panels = {rectangle("front", 0.2, 0.1), rectangle("back", 0.2, 0.1)};
  const dvec2 corner[] = {{0, 0}, {0.2, 0}, {0.2, 0.1}, {0, 0.1}};
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec2 from = corner[i], to = corner[(i + 1) % 4];
    pillow.seams.push_back(seam(0, from, to, 1, from, to));
  }
  const SizedGarment sewn = mesh_garment(pillow, {});
  const Topology topology = topology_of(sewn);
  EXPECT_EQ(topology.euler(), 2) << "a sphere";
  EXPECT_EQ(topology.boundary, 0U);
  EXPECT_EQ(topology.crowded, 0U) << "edges of more than two triangles";
  EXPECT_EQ(topology.vertices, sewn.vertices);
  // Every seam vertex lies at the same place of both panels, to the mesher's grid of 2^26 over the panel.
  for (const auto& join : sewn.joins) EXPECT_LT(join.gap, 1e-8);
}

TEST(Garment, ATubeFromOnePanelAndThePanelsOwnFigures) {
  // The right side to the left side of the same panel: a cylinder, placed where the panel is.
  Garment tube;
  tube.panels = {rectangle("sleeve", 0.3, 0.25)};
  tube.seams = {seam(0, {0, 0}, {0, 0.25}, 0, {0.3, 0}, {0.3, 0.25})};
  const SizedGarment sewn = mesh_garment(tube, {});
  const Topology topology = topology_of(sewn);
  EXPECT_EQ(topology.euler(), 0) << "an open cylinder";
  EXPECT_EQ(topology.crowded, 0U);
  EXPECT_NEAR(sewn.joins[0].gap, 0.3, 1e-8) << "unrolled, its sides are 0.3 m apart";
  EXPECT_EQ(sewn.joins[0].edges, sewn.seam_edges[0].size());
  EXPECT_GE(sewn.panels[0]->quality.edges_within, 0.99);
  EXPECT_GE(sewn.panels[0]->quality.least_angle, 25);
}

TEST(Garment, TheLongerSideIsGathered) {
  // A skirt's 0.6 m on a band of 0.3 m: the skirt is stitched with ρ = ½, and both have as many edges there.
  Garment skirt;
  skirt.panels = {rectangle("skirt", 0.6, 0.3), rectangle("band", 0.3, 0.05)};
  skirt.seams = {seam(0, {0, 0.3}, {0.6, 0.3}, 1, {0, 0}, {0.3, 0})};
  const SizedGarment sewn = mesh_garment(skirt, {});
  ASSERT_EQ(sewn.made[0].features.size(), 1U);
  EXPECT_EQ(sewn.made[0].features[0].rule, Feature::Rule::stitch);
  EXPECT_NEAR(sewn.made[0].features[0].other_length, 0.3, 1e-9);
  EXPECT_TRUE(sewn.made[1].features.empty());
  EXPECT_EQ(topology_of(sewn).euler(), 1) << "a disc";
  // 0.6 m in edges of half the fabric's 7.826 mm; whole numbers of them.
  EXPECT_NEAR(static_cast<double>(sewn.joins[0].edges), 0.6 / 3.913e-3, 0.05 * 0.6 / 3.913e-3);
}

TEST(Garment, CornersOnOneSideAreVerticesOnTheOther) {
  // A strip along two sides of an L: the strip gets a vertex where the L has its corner, 0.1 of 0.25 m along.
  Garment garment;
  garment.panels = {rectangle("panel", 0.1, 0.15), rectangle("strip", 0.25, 0.04)};
  garment.seams = {seam(0, {0, 0}, {0.1, 0.15}, 1, {0, 0}, {0.25, 0})};
  // Both ways from corner to corner are as long; the one along the outline's own direction is taken.
  const SizedGarment sewn = mesh_garment(garment, {});
  std::map<std::uint32_t, dvec2> on_panel, on_strip;
  for (std::uint32_t v = 0; v < sewn.panels[0]->mesh.vertices.size(); ++v)
    on_panel[sewn.sewn[v]] = sewn.panels[0]->mesh.vertices[v];
  for (std::uint32_t v = 0; v < sewn.panels[1]->mesh.vertices.size(); ++v)
    on_strip[sewn.sewn[sewn.first[1] + v]] = sewn.panels[1]->mesh.vertices[v];
  int shared = 0;
  for (const auto& [id, at] : on_panel) {
    const auto other = on_strip.find(id);
    if (other == on_strip.end()) continue;
    ++shared;
    // The same length from the seam's beginning on both: the sides are equally long.
    const double along = at.y < 1e-6 ? at.x : 0.1 + at.y;
    EXPECT_NEAR(other->second.x, along, 1e-7);
  }
  EXPECT_EQ(static_cast<std::size_t>(shared), sewn.joins[0].edges + 1);
}

TEST(Garment, PlacedPanelsMeetInTheMiddle) {
  Garment tent;
  tent.panels = {rectangle("left", 0.1, 0.1), rectangle("right", 0.1, 0.1)};
  tent.seams = {seam(0, {0, 0.1}, {0.1, 0.1}, 1, {0, 0.1}, {0.1, 0.1})};
  // The right one a quarter turn round x and half a metre up: its y axis becomes z.
  tent.placements = {{}, {turned_by({90, 0, 0}), {0, 0, 0.5}}};
  const SizedGarment sewn = mesh_garment(tent, {});
  // (x, 0.1, 0) and (x, 0, 0.6) meet halfway.
  for (const auto& [a, b] : sewn.seam_edges[0])
    for (const std::uint32_t v : {a, b}) {
      EXPECT_NEAR(sewn.positions[v].y, 0.05, 1e-8);
      EXPECT_NEAR(sewn.positions[v].z, 0.3, 1e-8);
    }
  EXPECT_NEAR(sewn.joins[0].gap, std::hypot(0.1, 0.6), 1e-8);
  // x first, then y, then z, round axes that stay: a point on y goes to z, stays there round … and comes to
  // x.
  const glm::dvec3 turned = turned_by({90, 90, 0}) * glm::dvec3(0, 1, 0);
  EXPECT_NEAR(glm::distance(turned, glm::dvec3(1, 0, 0)), 0, 1e-15);
}

TEST(Garment, SaysWhatCannotBeSewn) {
  Garment garment;
  garment.panels = {rectangle("front", 0.2, 0.1), rectangle("back", 0.2, 0.1)};
  const auto error_of = [&](std::vector<Seam> seams) {
    garment.seams = std::move(seams);
    return test::error_of([&] { mesh_garment(garment, {}); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(error_of({seam(0, {0.1, 0.05}, {0.2, 0}, 1, {0, 0}, {0.2, 0})}),
              HasSubstr("panel 'front': (0.1, 0.05) m is no point of its outline"));
  EXPECT_THAT(error_of({seam(0, {0, 0}, {0, 0}, 1, {0, 0}, {0.2, 0})}),
              HasSubstr("seam 's': begins and ends at one point of panel 'front'"));
  EXPECT_THAT(error_of({seam(0, {0, 0}, {0.2, 0}, 0, {0, 0}, {0.2, 0})}),
              HasSubstr("sews a stretch of outline to itself"));
  EXPECT_THAT(error_of({seam(0, {0, 0}, {0.2, 0}, 1, {0, 0}, {0.2, 0}),
                        seam(0, {0, 0}, {0.2, 0}, 1, {0, 0.1}, {0.2, 0.1})}),
              HasSubstr("overlaps another seam on panel 'front'"));
}

}  // namespace
}  // namespace plisse::sizing
