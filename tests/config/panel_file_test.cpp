// Panel files: what is read, and that everything wrong with a file is said at once with its place.
#include "config/panel_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"
#include "support/files.h"

namespace plisse {
namespace {

using testing::HasSubstr;

config::PanelFile parse(const std::string& text) {
  return config::parse_panels(text, "p.toml");
}

std::string complaint(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::bad_input);
    return error.what();
  }
  return "";
}

TEST(PanelFile, UnitsFabricsAndFeatures) {
  const config::PanelFile file = parse(R"(
units = "mm"
fabric = { B = "0.02 gf·cm²/cm", E = "0.3 MPa" }
[sizing]
transition = "literal"
fold = "literal"
floor = 2
[[panel]]
name = "front"
outline = [[0, 0], [300, 0], ["30 cm", 200], [0, 200]]
holes = ["M 100 100 a 20 20 0 0 0 40 0 a 20 20 0 0 0 -40 0 Z"]
  [[panel.feature]]
  rule = "stitch"
  line = { spline = [[10, 10], [50, 40], [90, 10]] }
  other_length = "6 cm"
  [[panel.feature]]
  rule = "fold"
  name = "crease"
  angle = 120
  line = "M 0 50 H 300"
[[panel]]
fabric = { thickness = 0.4, poisson = 0.3, weft = { E = 3e5 }, warp = { E = 6e5, B = 5e-6 } }
outline = [[0, 0], [1, 0], [0, 1]]
grain = 45
)");
  ASSERT_EQ(file.garment.panels.size(), 2U);
  const sizing::Panel& front = file.garment.panels[0];
  EXPECT_EQ(front.name, "front");
  EXPECT_DOUBLE_EQ(front.outline.points[2].x, 0.3);
  EXPECT_DOUBLE_EQ(front.outline.points[2].y, 0.2);
  EXPECT_DOUBLE_EQ(front.fabric.weft.bending, 0.02 * 9.80665e-5);
  EXPECT_DOUBLE_EQ(front.fabric.warp.modulus, 3e5);
  EXPECT_EQ(file.options.form, sizing::Transition::Form::literal);
  EXPECT_DOUBLE_EQ(file.options.floor, 2e-3);
  ASSERT_EQ(front.holes.size(), 1U);
  // A circle of 3° pieces: an inscribed polygon of 120 sides.
  EXPECT_NEAR(std::abs(signed_area(front.holes[0])), 60 * std::sin(std::numbers::pi / 60) * 4e-4, 1e-12);
  ASSERT_EQ(front.features.size(), 2U);
  EXPECT_DOUBLE_EQ(front.features[0].other_length, 0.06);
  EXPECT_EQ(front.features[1].name, "crease");
  EXPECT_EQ(front.features[1].line.points.size(), 2U);
  const sizing::Panel& second = file.garment.panels[1];
  EXPECT_EQ(second.name, "panel2");
  // E h³/12(1 − ν²)
  EXPECT_DOUBLE_EQ(second.fabric.weft.bending, 3e5 * std::pow(0.4e-3, 3) / (12 * 0.91));
  EXPECT_DOUBLE_EQ(second.fabric.warp.bending, 5e-6);
  EXPECT_DOUBLE_EQ(second.grain, 45);
}

TEST(PanelFile, AllThatIsWrongAtOnceWithPlaceAndRemedy) {
  const std::string text = complaint(R"(fabric = "wine-stile"
[sizing]
gradation = 3
[[panel]]
outline = [[0, 0], [1, "x"], [1, 1]]
grian = 3
  [[panel.feature]]
  rule = "shiring"
  line = "M 0 0 L 1 1"
  [[panel.feature]]
  rule = "shirring"
  line = "M 0 0 X"
  ratio = 0
)");
  EXPECT_THAT(text, HasSubstr("p.toml:1:10: key 'fabric': 'wine-stile' is unknown"));
  EXPECT_THAT(text, HasSubstr("did you mean 'wine-style'?"));
  EXPECT_THAT(text, HasSubstr("p.toml:3:13: key 'gradation': 3 is out of range; allowed: 0.01 to 0.5"));
  EXPECT_THAT(text, HasSubstr("p.toml:5:20: key 'outline'"));
  EXPECT_THAT(text, HasSubstr("p.toml:6:1: key 'grian': unknown"));
  EXPECT_THAT(text, HasSubstr("did you mean 'grain'?"));
  EXPECT_THAT(text, HasSubstr("p.toml:8:10: key 'rule': 'shiring' is unknown"));
  EXPECT_THAT(text, HasSubstr("path data, character 7"));
  EXPECT_THAT(text, HasSubstr("key 'ratio': 0 is out of range"));
  EXPECT_THAT(complaint("units = \"furlong\"\n[[panel]]\n"), HasSubstr("key 'units'"));
  EXPECT_THAT(complaint("[[panel]]\noutline = [[0,0],[1,0],[0,1]]"), HasSubstr("key 'fabric': missing"));
  EXPECT_THAT(complaint("x = "), HasSubstr("not TOML"));
  EXPECT_THAT(complaint(""), HasSubstr("key 'panel': missing"));
}

TEST(PanelFile, ArcsAndBeziersAreSvgs) {
  // A quarter of a circle by an arc; the same by the usual cubic, 2.7e-4 R off at most; and S and T go on
  // smoothly.
  const auto arc = sizing::parse_path("M 1 0 A 1 1 0 0 1 0 1")[0];
  for (const auto& point : arc.points) EXPECT_NEAR(glm::length(point), 1, 1e-12);
  EXPECT_GT(arc.points[arc.points.size() / 2].x, 0.6);
  const auto cubic = sizing::parse_path("M 1 0 C 1 0.5522847498 0.5522847498 1 0 1")[0];
  for (const auto& point : cubic.points) EXPECT_NEAR(glm::length(point), 1, 2.8e-4);
  const auto smooth = sizing::parse_path("m 0 0 q 1 1 2 0 t 2 0")[0];
  double low = 0, high = 0;
  for (const auto& point : smooth.points) {
    low = std::min(low, point.y);
    high = std::max(high, point.y);
  }
  EXPECT_NEAR(high, 0.5, 1e-12);
  EXPECT_NEAR(low, -0.5, 1e-12);
  EXPECT_EQ(sizing::parse_path("M0,0 1,0 1,1zM5 5l1 0 0 1z").size(), 2U);
}

TEST(PanelFile, CurvesFromSvgFiles) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "a.svg",
                   "<svg><path id='other' d='M0 0H1V1Z'/>\n<path\n fill=\"none\" id = \"front\"\n d=\"M 0 0 "
                   "L 40 0 L 40 20\"/></svg>");
  test::write_text(
      folder / "p.toml",
      "units = \"mm\"\nfabric = \"khaki\"\n[[panel]]\noutline = { svg = \"a.svg\", id = \"front\" }\n");
  const sizing::Polyline outline = config::load_panels(folder / "p.toml").garment.panels.at(0).outline;
  ASSERT_EQ(outline.points.size(), 3U);
  EXPECT_TRUE(outline.closed);
  EXPECT_DOUBLE_EQ(outline.points[2].x, 0.04);
  EXPECT_DOUBLE_EQ(outline.points[2].y, -0.02);  // SVG counts downward
  const auto text = [&](const std::string& curve) {
    return complaint("fabric = \"khaki\"\n[[panel]]\noutline = { svg = \"" + curve + "\" }");
  };
  EXPECT_THAT(text("none.svg"), HasSubstr("none.svg"));
  EXPECT_THAT(text((folder / "a.svg").string() + "\", id = \"back"), HasSubstr("has no <path id=\"back\">"));
  // Entities, cut files, tags without data: errors, never more.
  for (const char* broken : {"", "<path", "<path d=", "<path d='", "<path d=''>", "<path id='d'/>"})
    EXPECT_THROW(sizing::parse_svg(broken, ""), Error) << broken;
}

TEST(PanelFile, CurvesFromObjFiles) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "front.obj",
                   "v 0 0 0\nv 40 0 0\nv 40 20 0\nv 0 20 0\nv 10 5 0\nv 12 5 0\nv 11 7 0\nv 0 10 0\n"
                   "v 40 10 0\ng cut\nl 5 6 7 5\nl 1 2 3 4 1\ng crease\nl 8 9\n");
  test::write_text(folder / "p.toml",
                   "units = \"mm\"\nfabric = \"khaki\"\n[[panel]]\noutline = { obj = \"front.obj\", id = "
                   "\"cut\" }\n[[panel.feature]]\nrule = \"fold\"\nangle = 90\nline = { obj = "
                   "\"front.obj\", id = \"crease\" }\n");
  const sizing::Panel panel = config::load_panels(folder / "p.toml").garment.panels.at(0);
  EXPECT_DOUBLE_EQ(std::abs(signed_area(panel.outline)), 8e-4);
  ASSERT_EQ(panel.holes.size(), 1U);  // what lies in the outer line
  EXPECT_DOUBLE_EQ(std::abs(signed_area(panel.holes[0])), 2e-6);
  EXPECT_EQ(panel.features.at(0).line.points, (std::vector<glm::dvec2>{{0, 0.01}, {0.04, 0.01}}));
  const auto text = [&](const std::string& curve) {
    return complaint("fabric = \"khaki\"\n[[panel]]\noutline = { " + curve + " }");
  };
  const std::string file = "obj = \"" + (folder / "front.obj").string() + "\"";
  EXPECT_THAT(text(file + ", id = \"crease\""), HasSubstr("front.obj: a line is open"));
  EXPECT_THAT(text(file + ", id = \"cutt\""), HasSubstr("has no group or object 'cutt'; it has crease, cut"));
  EXPECT_THAT(text(file + ", svg = \"a.svg\""), HasSubstr("take one of them out"));
  EXPECT_THAT(text("obj = \"none.obj\""), HasSubstr("none.obj"));
}

TEST(PanelFile, AFabricBesideTheFileTakesThePlaceOfItsOwn) {
  const std::string text =
      "fabric = \"khaki\"\n[[panel]]\noutline = [[0,0],[1,0],[0,1]]\n[[panel]]\nfabric = \"rose\"\n"
      "outline = [[0,0],[1,0],[0,1]]\n";
  EXPECT_EQ(parse(text).garment.panels[1].fabric.name, "rose");
  const sizing::Fabric& green = *sizing::find_fabric("green");
  for (const sizing::Panel& panel : config::parse_panels(text, "p.toml", &green).garment.panels)
    EXPECT_EQ(panel.fabric.name, "green");
  // Then the file need not have one.
  EXPECT_EQ(config::parse_panels("[[panel]]\noutline = [[0,0],[1,0],[0,1]]", "p.toml", &green)
                .garment.panels.at(0)
                .fabric.name,
            "green");
  // Two numbers as on the command line.
  EXPECT_EQ(parse("fabric = \"2e-6,3e5\"\n[[panel]]\noutline = [[0,0],[1,0],[0,1]]")
                .garment.panels.at(0)
                .fabric.weft,
            sizing::find_fabric("wine-style")->weft);
}

TEST(PanelFile, PiecesStayWithTheSeamsBetweenThem) {
  config::PanelFile skirt = config::load_panels(test::asset("skirt.toml"));
  config::keep_pieces(skirt, {"band-back", "back"});
  ASSERT_EQ(skirt.garment.panels.size(), 2U);
  EXPECT_EQ(skirt.garment.panels[0].name, "back");  // in the file's order
  EXPECT_EQ(skirt.garment.placements.size(), 2U);
  ASSERT_EQ(skirt.garment.seams.size(), 1U);
  EXPECT_EQ(skirt.garment.seams[0].name, "back waist");
  EXPECT_EQ(skirt.garment.seams[0].a.panel, 0U);
  EXPECT_EQ(skirt.garment.seams[0].b.panel, 1U);
  try {
    config::keep_pieces(skirt, {"bakc"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'back'?"));
  }
  EXPECT_TRUE(config::is_panel_file(test::asset("skirt.toml")));
  EXPECT_FALSE(config::is_panel_file(test::asset("sleeve.toml")));
}

TEST(PanelFile, TheExamplesAreRead) {
  const config::PanelFile file = config::load_panels(test::asset("panels.toml"));
  EXPECT_GE(file.garment.panels.size(), 8U);
}

}  // namespace
}  // namespace plisse
