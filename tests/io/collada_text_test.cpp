// COLLADA as assimp cannot read it: curves between keys, and lists with blanks before their first number.
#include "io/assimp/collada_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>

#include "base/log.h"
#include "io/import.h"
#include "scene/animation.h"
#include "support/files.h"

namespace plisse::io {
namespace {

std::string source(const std::string& id, const std::string& numbers, std::size_t count, std::size_t stride) {
  return fmt::format(
      R"(<source id="{0}"><float_array id="{0}-array" count="{2}">{1}</float_array><technique_common><accessor source="#{0}-array" count="{3}" stride="{4}">{5}</accessor></technique_common></source>)",
      id, numbers, count, count / stride, stride,
      stride == 1
          ? R"(<param name="X" type="float"/>)"
          : R"(<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>)");
}

// A triangle that its node moves along x with keys at 0, 1 and 2 s of 0, 1 and 0 m.
std::string triangle(const std::string& mode, const std::string& in, const std::string& out,
                     std::size_t tangents) {
  std::string text =
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>)";
  text += source("places", "0 0 0 1 0 0 1 1 0 0 1 0", 12, 3);
  text +=
      R"(<vertices id="v"><input semantic="POSITION" source="#places"/></vertices><polylist count="2"><input semantic="VERTEX" source="#v" offset="0"/><vcount>3 3</vcount><p>0 1 2 0 2 3</p></polylist></mesh></geometry></library_geometries><library_animations><animation id="a">)";
  text += source("times", "0 1 2", 3, 1) + source("values", "0 1 0", 3, 1);
  if (tangents > 0)
    text += source("in", in, 3 * tangents, tangents) + source("out", out, 3 * tangents, tangents);
  text += fmt::format(
      R"(<source id="modes"><Name_array id="modes-array" count="3">{0} {0} {0}</Name_array><technique_common><accessor source="#modes-array" count="3" stride="1"><param name="INTERPOLATION" type="name"/></accessor></technique_common></source>)",
      mode);
  text +=
      R"(<sampler id="s"><input semantic="INPUT" source="#times"/><input semantic="OUTPUT" source="#values"/><input semantic="INTERPOLATION" source="#modes"/>)";
  if (tangents > 0)
    text += R"(<input semantic="IN_TANGENT" source="#in"/><input semantic="OUT_TANGENT" source="#out"/>)";
  return text +
         R"(</sampler><channel source="#s" target="n/move.X"/></animation></library_animations><library_visual_scenes><visual_scene id="scene"><node id="n" name="n"><translate sid="move">0 0 0</translate><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#scene"/></scene></COLLADA>)";
}

class ColladaText : public testing::Test {
 protected:
  // Where the node stands at this time.
  double place(const std::string& text, double time) const {
    test::write_text(folder_ / "m.dae", text);
    scene::Animation animation(import_model(folder_ / "m.dae"), {.frames_per_second = 1 / time});
    return scene::posed(animation.surface(), animation.pose(2)).at(0).x;
  }
  test::TemporaryFolder folder_;
};

// Straight lines are right to 1e-6 of the largest value, 1 m; assimp holds keys in single precision.
constexpr double tolerance = 2e-6;

TEST_F(ColladaText, Bezier) {
  // Control points (time, value): from (0, 0) by (0.5, 0) and (0.5, 1) to (1, 1), which is steepest in the
  // middle; then back by (1.1, 1) and (1.4, 0).
  const std::string text = triangle("BEZIER", "-1 0 .5 1 1.4 0", ".5 0 1.1 1 3 0", 2);
  for (const double s : {0.1, 0.25, 0.5, 0.8}) {
    const double r = 1 - s;
    EXPECT_NEAR(place(text, 1.5 * r * r * s + 1.5 * r * s * s + s * s * s), 3 * r * s * s + s * s * s,
                tolerance)
        << s;
    EXPECT_NEAR(place(text, r * r * r + 3.3 * r * r * s + 4.2 * r * s * s + 2 * s * s * s),
                r * r * r + 3 * r * r * s, tolerance)
        << s;
  }
  // Values alone: time runs evenly. Out of the first key to 0, into the second from 1: 3 s² − 2 s³.
  const std::string even = triangle("BEZIER", "0 1 0", "0 1 0", 1);
  for (const double t : {0.25, 0.5, 0.9})
    EXPECT_NEAR(place(even, t), 3 * t * t - 2 * t * t * t, tolerance) << t;
}

TEST_F(ColladaText, Hermite) {
  // Out of the first key with slope 2, into the second with slope −1: 2 (t³ − 2 t² + t) + 3 t² − 2 t³ − (t³ −
  // t²).
  const std::string text = triangle("HERMITE", "0 -1 0", "2 0 0", 1);
  for (const double t : {0.2, 0.5, 0.75})
    EXPECT_NEAR(place(text, t),
                2 * (t * t * t - 2 * t * t + t) + 3 * t * t - 2 * t * t * t - (t * t * t - t * t), tolerance)
        << t;
}

TEST_F(ColladaText, Step) {
  const std::string text = triangle("STEP", "", "", 0);
  EXPECT_NEAR(place(text, 0.5), 0, tolerance);
  EXPECT_NEAR(place(text, 0.999), 0, tolerance);
  EXPECT_NEAR(place(text, 0.9999995), 1, tolerance);  // the rounding of a key's time
  EXPECT_NEAR(place(text, 1), 1, tolerance);
  EXPECT_NEAR(place(text, 1.9), 1, tolerance);
}

TEST_F(ColladaText, OthersAreTold) {
  EXPECT_NEAR(place(triangle("LINEAR", "", "", 0), 0.25), 0.25, tolerance);
  EXPECT_THAT(log::warnings(),
              testing::Not(testing::Contains(testing::HasSubstr((folder_ / "m.dae").string()))));
  EXPECT_NEAR(place(triangle("CARDINAL", "", "", 0), 0.25), 0.25, tolerance);
  EXPECT_THAT(log::warnings(),
              testing::Contains(testing::HasSubstr("m.dae: CARDINAL keys are read as straight")));
  EXPECT_NEAR(place(triangle("BEZIER", "", "", 0), 0.25), 0.25, tolerance);
  EXPECT_THAT(log::warnings(), testing::Contains(testing::HasSubstr("m.dae: BEZIER keys without tangents")));
}

TEST_F(ColladaText, BlanksBeforeLists) {
  std::string text = triangle("LINEAR", "", "", 0);
  text.insert(
      text.find("<library_animations>"),
      "<library_effects><effect id=\"e\"><profile_COMMON><technique sid=\"t\"><lambert><diffuse><color>1 0 0 "
      "1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>");
  for (std::size_t at = 0; (at = text.find('>', at)) != std::string::npos; ++at)
    if (std::isdigit(static_cast<unsigned char>(text[at + 1])) != 0) text.insert(at + 1, "\n \t");
  test::write_text(folder_ / "m.dae", text);
  const Model model = import_model(folder_ / "m.dae");
  EXPECT_EQ(model.meshes.at(0).triangles.size(), 6U);
  EXPECT_EQ(model.meshes[0].positions.at(model.meshes[0].triangles[5]), glm::dvec3(0, 1, 0));
}

}  // namespace
}  // namespace plisse::io
