// GarmentCode patterns, written here after the format's own description: two panels that make a sleeve.
#include "config/garment_code.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "config/panel_file.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse {
namespace {

using testing::HasSubstr;

// Centimetres. The front's top is a half circle bulging upward, its bottom a parabola; the back stands 20 cm
// behind it and looks the other way: half a turn round y.
const std::string sleeve = R"({
  "pattern": {
    "panels": {
      "front": {
        "translation": [0, 100, 10], "rotation": [0, 0, 0],
        "vertices": [[-10, 0], [10, 0], [10, 30], [-10, 30]],
        "edges": [
          {"endpoints": [0, 1], "curvature": [0.5, -0.25]},
          {"endpoints": [1, 2]},
          {"endpoints": [2, 3], "curvature": {"type": "circle", "params": [10, 0, 1]}},
          {"endpoints": [3, 0]}
        ]
      },
      "back": {
        "translation": [0, 100, -10], "rotation": [0, 180, 0],
        "vertices": [[-10, 0], [10, 0], [10, 30], [-10, 30]],
        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]
      }
    },
    "stitches": [
      [{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}],
      [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 1}]
    ]
  },
  "parameters": {},
  "properties": {"curvature_coords": "relative", "units_in_meter": 100}
})";

sizing::Garment parse(const std::string& text) {
  return config::parse_garment_code(text, "p.json", *sizing::find_fabric("khaki"));
}

TEST(GarmentCode, PanelsStitchesAndPlaces) {
  const sizing::Garment garment = parse(sleeve);
  ASSERT_EQ(garment.panels.size(), 2U);
  EXPECT_EQ(garment.panels[0].name, "front");
  EXPECT_EQ(garment.panels[0].fabric.name, "khaki");
  // 20 × 30 cm, half a disc of 10 cm, and a parabola's 2/3 of 20 × 2.5 cm: a Bézier's middle is half as high
  // as its control point, which lies a quarter of the edge to the right. Arcs are polygons of 3 degrees: 1
  // − 4.6e-4.
  EXPECT_NEAR(sizing::signed_area(garment.panels[0].outline),
              0.06 + 0.005 * std::numbers::pi + 2.0 / 3 * 0.2 * 0.025, 2e-5);
  EXPECT_NEAR(sizing::signed_area(garment.panels[1].outline), 0.06, 1e-12);
  ASSERT_EQ(garment.placements.size(), 2U);
  // The back's (0.1, 0) is turned to x = −0.1: its left side stands behind the front's right.
  const glm::dvec3 corner =
      garment.placements[1].rotation * glm::dvec3(0.1, 0, 0) + garment.placements[1].translation;
  EXPECT_NEAR(glm::distance(corner, glm::dvec3(-0.1, 1, -0.1)), 0, 1e-12);

  ASSERT_EQ(garment.seams.size(), 2U);
  // Upward on the front, and upward on the back, whose edge 3 runs down.
  EXPECT_EQ(garment.seams[0].a.from, glm::dvec2(0.1, 0));
  EXPECT_EQ(garment.seams[0].a.to, glm::dvec2(0.1, 0.3));
  EXPECT_EQ(garment.seams[0].b.from, glm::dvec2(-0.1, 0));
  EXPECT_EQ(garment.seams[0].b.to, glm::dvec2(-0.1, 0.3));

  // Sewn, the two sides lie 0.2 m apart as they are placed.
  const sizing::SizedGarment sewn = sizing::mesh_garment(garment, {});
  for (const auto& join : sewn.joins) EXPECT_NEAR(join.gap, 0.2, 1e-8);
}

TEST(GarmentCode, SaysWhatIsWrongAndWhere) {
  const auto error_after = [](const std::string& old, const std::string& by) {
    std::string text = sleeve;
    EXPECT_NE(text.find(old), std::string::npos);
    return test::error_of([&] { parse(text.replace(text.find(old), old.size(), by)); });
  };
  EXPECT_THAT(error_after(R"("endpoints": [1, 2])", R"("endpoints": [1, 7])"),
              HasSubstr("p.json: pattern.panels.front.edges[1].endpoints: must be two of the 4 vertices"));
  EXPECT_THAT(error_after(R"("endpoints": [1, 2])", R"("endpoints": [0, 2])"),
              HasSubstr("pattern.panels.front.edges[1]: does not begin where the edge before it ends"));
  EXPECT_THAT(error_after(R"("vertices": [[-10, 0])", R"("vertices": [["x", 0])"),
              HasSubstr("pattern.panels.front.vertices[0]: is no point"));
  EXPECT_THAT(error_after(R"("type": "circle")", R"("type": "ellipse")"),
              HasSubstr("pattern.panels.front.edges[2].curvature"));
  EXPECT_THAT(error_after(R"("panel": "back", "edge": 3)", R"("panel": "bakc", "edge": 3)"),
              HasSubstr("pattern.stitches[0][1].panel: there is no panel 'bakc' (did you mean 'back'?)"));
  EXPECT_THAT(error_after(R"("panel": "back", "edge": 3)", R"("panel": "back", "edge": 4)"),
              HasSubstr("pattern.stitches[0][1].edge: must be one of the 4 edges of panel 'back'"));
  EXPECT_THAT(error_after(R"("units_in_meter": 100)", R"("units_in_meter": 0)"),
              HasSubstr("properties.units_in_meter"));
  EXPECT_THAT(test::error_of([] { parse("{\"pattern\": 3}"); }), HasSubstr("pattern.panels: is missing"));
  EXPECT_THAT(test::error_of([] { parse("{"); }), HasSubstr("p.json"));
  EXPECT_THAT(error_after(R"("translation": [0, 100, 10])", R"("translation": "here")"),
              HasSubstr("pattern.panels.front.translation"));
}

TEST(GarmentCode, NeedsAFabricAndTomlDoesNot) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "p.json", sleeve);
  const sizing::Fabric* khaki = sizing::find_fabric("khaki");
  EXPECT_EQ(config::load_panels(folder / "p.json", khaki).garment.seams.size(), 2U);
  EXPECT_THAT(test::error_of([&] { config::load_panels(folder / "p.json"); }),
              HasSubstr("tells no fabric; give one beside it, a name or B,E: --fabric"));
  // A fabric that is given counts for all panels, whatever their file says.
  const sizing::Garment own = config::load_panels(test::asset("panels.toml")).garment,
                        given = config::load_panels(test::asset("panels.toml"), khaki).garment;
  ASSERT_EQ(given.panels.size(), own.panels.size());
  bool differs = false;
  for (std::size_t i = 0; i < given.panels.size(); ++i) {
    EXPECT_EQ(given.panels[i].fabric.weft, khaki->weft);
    EXPECT_EQ(given.panels[i].fabric.warp, khaki->warp);
    differs = differs || own.panels[i].fabric.weft != khaki->weft;
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace plisse
