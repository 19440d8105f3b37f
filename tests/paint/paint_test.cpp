// Strokes on surfaces made by hand: where they touch, which way they gather, how they blend, and what they
// are told when they miss.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "base/error.h"
#include "io/picture/png.h"
#include "io/ply.h"
#include "paint/canvas.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/sheets.h"

namespace plisse::paint {
namespace {

using ::testing::HasSubstr;
using Kind = config::PaintStroke::Kind;
using Direction = config::PaintDirection::Kind;
using test::Sheet;

constexpr double spacing = 0.1;

// A grid over 0…0.8 in the plane z = 0, uv = (x, y).
Sheet flat_sheet() {
  return test::grid(9, 9, spacing, 0, 1);
}

config::PaintStroke stroke(Kind kind, double strength = 0.5) {
  config::PaintStroke result;
  result.place = "paint.toml:7:1";
  result.kind = kind;
  result.strength = strength;
  result.radius = 0.25;
  return result;
}

config::PaintStroke line(const std::vector<glm::dvec3>& points, double strength = 0.5) {
  config::PaintStroke result = stroke(Kind::surface, strength);
  result.points = points;
  return result;
}

config::PaintStroke with_vector(config::PaintStroke result, const glm::dvec3& vector) {
  result.direction = {Direction::vector, 0, vector};
  return result;
}

// Looks down −z at the square 0…0.8, x to the right and y up, 80 × 80 pixels.
Screen from_above(const std::vector<glm::dvec3>& positions) {
  return {glm::ortho(0.0, 0.8, 0.0, 0.8, -2.0, 2.0), 80, 80, positions};
}

std::vector<glm::dvec3> painted(const Sheet& sheet, const std::vector<config::PaintStroke>& strokes) {
  const Canvas canvas{sheet.surface, sheet.rest,
                      [&](const config::PaintStroke&) { return from_above(sheet.surface.rest); }};
  return paint(canvas, strokes).bias;
}

std::string complaint(const Sheet& sheet, const config::PaintStroke& one) {
  return test::error_of([&] { painted(sheet, {one}); });
}

double smooth(double part) {
  const double s = std::max(0.0, 1 - part);
  return s * s * (3 - 2 * s);
}

TEST(Paint, ALineGathersAcrossItself) {
  const Sheet sheet = flat_sheet();
  const auto bias = painted(sheet, {line({{0.2, 0.4, 0}, {0.6, 0.4, 0}})});
  for (std::size_t v = 0; v < bias.size(); ++v) {
    const glm::dvec3 x = sheet.surface.rest[v];
    const double beyond = std::max({0.2 - x.x, x.x - 0.6, 0.0});
    const double expected = 0.5 * smooth(std::hypot(beyond, x.y - 0.4) / 0.25);
    EXPECT_NEAR(glm::length(bias[v]), expected, 1e-12);             // roundings of numbers below 1
    EXPECT_NEAR(std::abs(bias[v].y), glm::length(bias[v]), 1e-12);  // across a line along x is y
  }
}

TEST(Paint, TheSameLineOnScreenOnTheSurfaceAndInUv) {
  const Sheet sheet = flat_sheet();
  const auto expected = painted(sheet, {line({{0.1, 0.2, 0}, {0.5, 0.7, 0}})});
  config::PaintStroke uv = stroke(Kind::uv), screen = stroke(Kind::screen);
  uv.points = {{0.1, 0.2, 0}, {0.5, 0.7, 0}};
  screen.points = {{10, 60, 0}, {50, 10, 0}};  // y down, 100 pixels a metre
  screen.radius = 25;
  for (const config::PaintStroke& other : {uv, screen}) {
    const auto bias = painted(sheet, {other});
    for (std::size_t v = 0; v < bias.size(); ++v) {
      const double difference =
          std::min(glm::distance(bias[v], expected[v]), glm::distance(bias[v], -expected[v]));
      EXPECT_LT(difference, 1e-6) << v;  // uv is kept in single precision
    }
  }
}

TEST(Paint, DirectionsAreAskedForInFourWays) {
  const Sheet sheet = flat_sheet();
  const auto way = [&](Kind kind, const config::PaintDirection& direction) {
    config::PaintStroke one = stroke(kind);
    one.points = kind == Kind::screen ? std::vector<glm::dvec3>{{20, 40, 0}, {60, 40, 0}}
                                      : std::vector<glm::dvec3>{{0.2, 0.4, 0}, {0.6, 0.4, 0}};
    if (kind == Kind::screen) one.radius = 25;
    one.direction = direction;
    const glm::dvec3 p = painted(sheet, {one})[4 * 9 + 4];
    return p.y < 0 ? -p / 0.5 : p / 0.5;
  };
  const double angle = 30 * std::numbers::pi / 180;
  const glm::dvec3 turned(std::cos(angle), std::sin(angle), 0);
  for (const Kind kind : {Kind::surface, Kind::uv, Kind::screen}) {
    EXPECT_LT(glm::distance(way(kind, {Direction::across}), glm::dvec3(0, 1, 0)), 1e-6);
    EXPECT_NEAR(std::abs(way(kind, {Direction::along}).x), 1, 1e-6);
    EXPECT_LT(glm::distance(way(kind, {Direction::angle, 30, {}}), turned), 1e-6);  // counterclockwise
    // A vector out of the surface is laid into it.
    EXPECT_LT(glm::distance(way(kind, {Direction::vector, 0, turned + glm::dvec3(0, 0, 4)}), turned), 1e-6);
  }
}

// Loviscach 2006, figure 14: the direction on the screen is projected into the tangent space; seen on a slope
// of 60° and squeezed to half by the pose, it is that of the rest pose all the same.
TEST(Paint, AScreenDirectionIsBroughtBackToTheRestPose) {
  const Sheet sheet = flat_sheet();
  config::PaintStroke one = stroke(Kind::screen);
  one.points = {{40, 40, 0}};
  one.radius = 60;
  one.direction = {Direction::angle, 45, {}};
  // Posed: x halved; then the screen's 45° are (1, 1) of the posed plane, M⁻¹ of it (2, 1).
  const Canvas canvas{sheet.surface, sheet.rest, [&](const config::PaintStroke&) {
                        return from_above(mapped(
                            sheet, [](const glm::dvec3& x) { return glm::dvec3(0.2 + 0.5 * x.x, x.y, 0); }));
                      }};
  const glm::dvec3 p = paint(canvas, {one}).bias[4 * 9 + 4];
  EXPECT_NEAR(std::abs(glm::dot(glm::normalize(p), glm::normalize(glm::dvec3(2, 1, 0)))), 1,
              1e-5);  // μ of the regression
}

TEST(Paint, OnlyWhatIsSeenIsTouched) {
  // Two sheets, one 0.3 above the other; seen from above.
  Sheet sheet = test::grid(9, 9, spacing, 0, 1, 1, 2);
  for (std::size_t v = 81; v < 162; ++v) sheet.surface.rest[v].z = sheet.surface.bind[v].z = -0.3;
  config::PaintStroke one = stroke(Kind::screen);
  one.points = {{20, 40, 0}, {60, 40, 0}};
  one.radius = 25;
  const auto bias = painted(sheet, {one});
  for (std::size_t v = 81; v < 162; ++v) EXPECT_EQ(bias[v], glm::dvec3(0));
  EXPECT_GT(glm::length(bias[40]), 0.4);
}

TEST(Paint, TheFarSideOfASleeveIsNotTouched) {
  // As above: near in space, but not along the cloth.
  Sheet sheet = test::grid(9, 9, spacing, 0, 1, 1, 2);
  for (std::size_t v = 81; v < 162; ++v) sheet.surface.rest[v].z = sheet.surface.bind[v].z = -0.05;
  const auto bias = painted(sheet, {line({{0.4, 0.2, 0}, {0.4, 0.6, 0}})});
  for (std::size_t v = 81; v < 162; ++v) EXPECT_EQ(bias[v], glm::dvec3(0));
}

TEST(Paint, StrokesBlendAndStayBelowOne) {
  const Sheet sheet = flat_sheet();
  config::PaintStroke dab = with_vector(line({{0.4, 0.4, 0}}, 0.9), {1, 0, 0});
  std::vector<config::PaintStroke> strokes;
  for (int i = 0; i < 20; ++i) {
    strokes.push_back(dab);
    for (const glm::dvec3& p : painted(sheet, strokes)) EXPECT_LE(glm::length(p), 0.9 + 1e-12);
  }
  // Toward −x is the same as toward x: nothing cancels.
  strokes.push_back(with_vector(dab, {-1, 0, 0}));
  EXPECT_NEAR(glm::length(painted(sheet, strokes)[40]), 0.9, 1e-12);
  // A second stroke of weight w takes the place of that much of the first: p ← (1−w)p + w p₂.
  config::PaintStroke other = with_vector(line({{0.4, 0.4, 0}}, 0.6), {0, 1, 0});
  const std::size_t beside = 4 * 9 + 5;
  const double w = smooth(0.1 / 0.25);
  const glm::dvec3 p = painted(sheet, {dab, other})[beside];
  EXPECT_NEAR(p.x, (1 - w) * 0.9 * w, 1e-12);
  EXPECT_NEAR(p.y, w * 0.6, 1e-12);
}

TEST(Paint, EraseTakesItAwayAndSmoothEvensItOut) {
  const Sheet sheet = flat_sheet();
  const config::PaintStroke fill = with_vector(stroke(Kind::fill), {1, 0, 0});
  config::PaintStroke erase = stroke(Kind::fill, 1);
  erase.mode = config::PaintStroke::Mode::erase;
  for (const glm::dvec3& p : painted(sheet, {fill, erase})) EXPECT_EQ(p, glm::dvec3(0));

  const config::PaintStroke dab = with_vector(line({{0.4, 0.4, 0}}), {0, 1, 0});
  config::PaintStroke smooth = stroke(Kind::fill, 1);
  smooth.mode = config::PaintStroke::Mode::smooth;
  const auto rough = painted(sheet, {dab}), once = painted(sheet, {dab, smooth});
  smooth.rounds = 200;
  const auto often = painted(sheet, {dab, smooth});
  const auto spread = [](const std::vector<glm::dvec3>& bias) {
    double low = 1, high = 0;
    for (const glm::dvec3& p : bias)
      low = std::min(low, glm::length(p)), high = std::max(high, glm::length(p));
    return high - low;
  };
  EXPECT_LT(spread(once), spread(rough));
  EXPECT_LT(spread(often), 0.02 * spread(rough));
  const auto constant = painted(sheet, {fill, smooth});  // what is even stays
  for (const glm::dvec3& p : constant) EXPECT_NEAR(p.x, 0.5, 1e-12);
}

TEST(Paint, MasksLimitAStroke) {
  Sheet sheet = flat_sheet();
  const auto half = static_cast<std::uint32_t>(sheet.surface.triangle_count() / 2);
  sheet.surface.parts = {{"lower", "cotton", -1, 0, half, true, true},
                         {"upper", "silk", -1, half, half, true, true}};
  config::PaintStroke fill = with_vector(stroke(Kind::fill), {1, 0, 0});
  fill.only = {"lower"};
  auto bias = painted(sheet, {fill});
  EXPECT_GT(bias[0].x, 0.4);
  EXPECT_EQ(bias[80], glm::dvec3(0));
  fill.only.clear();
  fill.exclude = {"cotton"};
  bias = painted(sheet, {fill});
  EXPECT_EQ(bias[0], glm::dvec3(0));
  EXPECT_GT(bias[80].x, 0.4);
  fill.exclude = {"cottn"};
  EXPECT_THAT(complaint(sheet, fill), HasSubstr("paint.toml:7:1: 'cottn' is neither a mesh nor a material"));
}

TEST(Paint, RandomFoldsAreAsManyAsAskedAndRepeat) {
  const Sheet sheet = flat_sheet();
  config::PaintStroke random = stroke(Kind::random);
  random.direction.kind = Direction::random;
  random.density = 1 / 0.64;  // one on the whole sheet
  random.length = 0.3;
  random.radius = 0.12;
  int touched = 0;
  for (const glm::dvec3& p : painted(sheet, {random})) touched += p != glm::dvec3(0) ? 1 : 0;
  // A strip of .3 by .24 with round ends, on a grid of .1: about .072 + .045 = .117 m², twelve vertices; half
  // of it may hang over the border.
  EXPECT_GE(touched, 3);
  EXPECT_LE(touched, 20);
  random.density = 30;
  const auto one = painted(sheet, {random});
  EXPECT_EQ(one, painted(sheet, {random}));
  random.seed = 2;
  EXPECT_NE(one, painted(sheet, {random}));
  random.density = 1e9;
  EXPECT_THAT(complaint(sheet, random), HasSubstr("100000 are allowed"));
  random.density = 1e-3;
  EXPECT_THAT(complaint(sheet, random), HasSubstr("less than one wrinkle"));
}

TEST(Paint, APictureSaysHowMuch) {
  const test::TemporaryFolder folder;
  io::Image image{2, 2, std::vector<std::uint8_t>(16, 255)};
  for (std::size_t i : {0U, 2U})
    image.rgba[4 * i] = image.rgba[4 * i + 1] = image.rgba[4 * i + 2] = 0;  // left: black
  io::write_png(folder / "amount.png", image);
  config::PaintStroke one = with_vector(stroke(Kind::image), {0, 1, 0});
  one.file = folder / "amount.png";
  const Sheet sheet = flat_sheet();
  const auto bias = painted(sheet, {one});
  for (std::size_t v = 0; v < bias.size(); ++v) {
    // Bilinear between texel middles at u = ¼ and ¾, repeated beyond.
    const double u = sheet.surface.rest[v].x, amount = u < 0.25   ? 0.5 - 2 * u
                                                       : u < 0.75 ? 2 * u - 0.5
                                                                  : 2.5 - 2 * u;
    EXPECT_NEAR(bias[v].y, 0.5 * amount, 1e-6) << u;
  }
}

TEST(Paint, VertexColoursFromAnotherProgram) {
  const test::TemporaryFolder folder;
  const Sheet sheet = flat_sheet();
  using Type = io::PlyProperty::Type;
  io::PlyElement vertex{"vertex",
                        sheet.size(),
                        {{"x", Type::float32},
                         {"y", Type::float32},
                         {"z", Type::float32},
                         {"red", Type::uint8},
                         {"green", Type::uint8},
                         {"blue", Type::uint8}}};
  for (std::size_t i = sheet.size(); i-- > 0;) {  // another order, and z up
    const glm::dvec3 x = sheet.surface.rest[i];
    const double values[] = {x.x, -x.z, x.y};
    for (std::size_t k = 0; k < 3; ++k) vertex.properties[k].values.push_back(values[k]);
    for (std::size_t k = 3; k < 6; ++k) vertex.properties[k].values.push_back(i < 9 ? 255 : 0);
  }
  io::write_ply(folder / "colours.ply", {{}, {vertex}});
  config::PaintStroke one = with_vector(stroke(Kind::colours), {1, 0, 0});
  one.file = folder / "colours.ply";
  one.up = "z";
  const auto bias = painted(sheet, {one});
  for (std::size_t v = 0; v < bias.size(); ++v) EXPECT_NEAR(bias[v].x, v < 9 ? 0.5 : 0, 1e-12);
  one.up = "y";
  EXPECT_THAT(complaint(sheet, one), HasSubstr("say 'up'"));
}

TEST(Paint, SaysWhereAStrokeMisses) {
  const Sheet sheet = flat_sheet();
  EXPECT_THAT(complaint(sheet, line({{0.4, 0.4, 0}, {0.4, 0.4, 1}})),
              HasSubstr("paint.toml:7:1: the point [0.4, 0.4, 1] is off the mesh"));
  config::PaintStroke one = stroke(Kind::screen);
  one.points = {{-10, -10, 0}, {-10, 90, 0}};
  EXPECT_THAT(complaint(sheet, one), HasSubstr("misses the mesh"));
  one = stroke(Kind::uv);
  one.points = {{5, 5, 0}, {6, 6, 0}};
  EXPECT_THAT(complaint(sheet, one), HasSubstr("touches no vertex"));
  one = stroke(Kind::surface);
  one.vertices = {3, 81};
  EXPECT_THAT(complaint(sheet, one), HasSubstr("there is no vertex 81; the model has 81"));
  Sheet bare = flat_sheet();
  bare.surface.parts[0].has_uv = false;
  one = stroke(Kind::uv);
  one.points = {{0.1, 0.1, 0}, {0.2, 0.2, 0}};
  EXPECT_THAT(complaint(bare, one), HasSubstr("the model has none"));
}

// A radius smaller than the mesh: the vertex nearest to the line, as with the paper's mouse.
TEST(Paint, AFineLineTakesTheNearestVertices) {
  const Sheet sheet = flat_sheet();
  config::PaintStroke fine = line({{0.21, 0.42, 0}, {0.6, 0.42, 0}});
  fine.radius = 0.01;
  config::PaintStroke screen = stroke(Kind::screen);
  screen.points = {{21, 38, 0}, {60, 38, 0}};
  screen.radius = 1;
  for (const config::PaintStroke& one : {fine, screen}) {
    const auto bias = painted(sheet, {one});
    for (std::size_t v = 0; v < bias.size(); ++v) {
      const bool on_it = v / 9 == 4 && v % 9 >= 2 && v % 9 <= 6;
      EXPECT_NEAR(glm::length(bias[v]), on_it ? 0.5 : 0, 1e-12) << v;
    }
  }
}

}  // namespace
}  // namespace plisse::paint
