// Painted wrinkles as files: the round trip through PLY and uv texture, over seams and mirrored islands, and
// what is refused.
#include "paint/bias_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/error.h"
#include "io/picture/image.h"
#include "io/picture/png.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/sheets.h"

namespace plisse::paint {
namespace {

using test::Sheet;
using ::testing::HasSubstr;

// A bumpy sheet of 17 × 17 vertices whose right half has uv of its own, mirrored: the column in the middle is
// a seam.
Sheet bumpy_sheet() {
  Sheet flat = test::grid(17, 17, 1.0 / 16, 0.2, 5);
  std::vector<glm::dvec3> points = flat.surface.rest;
  for (glm::dvec3& x : points) x.z = 0.1 * std::sin(5 * x.x) * std::cos(4 * x.y);
  Sheet sheet = test::sheet(points, flat.surface.triangles);
  Surface& surface = sheet.surface;
  surface.render_vertices.clear();
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    const bool right = (t / 2) % 16 >= 8;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = flat.surface.triangles[3 * t + c];
      const glm::dvec3 x = points[v];
      const glm::vec2 uv(right ? 0.95 - 0.4 * (x.x - 0.4) : 0.05 + 0.4 * x.x, 0.05 + 0.85 * x.y);
      const auto found = std::find_if(surface.render_vertices.begin(), surface.render_vertices.end(),
                                      [&](const RenderVertex& r) { return r.welded == v && r.uv == uv; });
      surface.triangles[3 * t + c] = static_cast<std::uint32_t>(found - surface.render_vertices.begin());
      if (found == surface.render_vertices.end()) surface.render_vertices.push_back({v, uv, {0, 0, 1}});
    }
  }
  return sheet;
}

std::vector<glm::dvec3> random_bias(const Sheet& sheet, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> angle(-3.2, 3.2), length(0, 0.99);
  std::vector<glm::dvec3> bias;
  for (std::size_t v = 0; v < sheet.size(); ++v) {
    const glm::dvec3 n = sheet.rest.normal[v], t = sheet.rest.tangent[v];
    const double a = angle(random);
    bias.push_back(length(random) * (std::cos(a) * t + std::sin(a) * glm::cross(n, t)));
  }
  return bias;
}

Painting only(const std::vector<glm::dvec3>& bias) {
  Painting painting(bias.size());
  painting.bias = bias;
  return painting;
}

// The tolerances: |p| within 1/255, the direction within 1°; where |p| rounds to nothing there is no
// direction.
void expect_same(const std::vector<glm::dvec3>& back, const std::vector<glm::dvec3>& bias) {
  ASSERT_EQ(back.size(), bias.size());
  for (std::size_t v = 0; v < bias.size(); ++v) {
    EXPECT_NEAR(glm::length(back[v]), glm::length(bias[v]), 1.0 / 255) << v;
    if (glm::length(bias[v]) < 1.0 / 255) continue;
    const double cosine = std::abs(glm::dot(glm::normalize(back[v]), glm::normalize(bias[v])));
    EXPECT_GT(cosine, std::cos(glm::radians(1.0))) << v;
  }
}

TEST(BiasFile, PlyComesBackBitForBit) {
  const test::TemporaryFolder folder;
  const Sheet sheet = bumpy_sheet();
  const auto bias = random_bias(sheet, 3);
  Painting painting(sheet.size());
  painting.bias = bias;
  write_bias_ply(folder / "bias.ply", sheet.surface, painting);
  EXPECT_EQ(read_bias(folder / "bias.ply", sheet.surface, sheet.rest).bias, bias);
  EXPECT_FALSE(read_bias(folder / "bias.ply", sheet.surface, sheet.rest).has_waves());
  for (std::size_t v = 0; v < sheet.size(); v += 2) {
    painting.gradient[v] = 300.0 * bias[v];
    painting.phase[v] = 0.01 * static_cast<double>(v) - 1;
  }
  write_bias_ply(folder / "bias.ply", sheet.surface, painting);
  const Painting back = read_bias(folder / "bias.ply", sheet.surface, sheet.rest);
  EXPECT_EQ(back.gradient, painting.gradient);
  EXPECT_EQ(back.phase, painting.phase);
}

// Solved waves beside the texture: eight bits of cosine and sine are within a third of a degree, and the
// direction, which decides the sign of a phase, is that of the texel; a step of the wavelength is 3.3 %.
TEST(BiasFile, WavesComeBackFromTheirTexture) {
  const test::TemporaryFolder folder;
  const Sheet sheet = bumpy_sheet();
  Painting painting(sheet.size());
  painting.bias = random_bias(sheet, 9);
  for (std::size_t v = 0; v < sheet.size(); v += 2) {
    painting.gradient[v] = (20 + 3.0 * static_cast<double>(v)) * glm::normalize(painting.bias[v]);
    painting.phase[v] = std::remainder(0.7 * static_cast<double>(v), 2 * std::numbers::pi);
  }
  io::write_png(folder / "bias.png", encode_bias(sheet.surface, sheet.rest, painting.bias, 512));
  io::write_png(folder / "bias_waves.png", encode_waves(sheet.surface, sheet.rest, painting, 512));
  const Painting back = read_bias(folder / "bias.png", sheet.surface, sheet.rest);
  expect_same(back.bias, painting.bias);
  for (std::size_t v = 0; v < sheet.size(); ++v) {
    if (v % 2 == 1 || glm::length(painting.bias[v]) < 1.0 / 255) {
      EXPECT_TRUE(v % 2 == 0 || back.gradient[v] == glm::dvec3(0)) << v;
      continue;
    }
    EXPECT_NEAR(glm::length(back.gradient[v]) / glm::length(painting.gradient[v]), 1, 0.017) << v;
    const double sign = glm::dot(back.bias[v], painting.bias[v]) < 0 ? -1 : 1;
    EXPECT_GT(glm::dot(back.bias[v], back.gradient[v]), 0) << v;
    EXPECT_NEAR(std::remainder(sign * back.phase[v] - painting.phase[v], 2 * std::numbers::pi), 0, 0.006)
        << v;
  }
  io::write_png(folder / "bias_waves.png", encode_waves(sheet.surface, sheet.rest, painting, 256));
  EXPECT_THAT(test::error_of([&] { read_bias(folder / "bias.png", sheet.surface, sheet.rest); }),
              HasSubstr("bias_waves.png: is 256×256 pixels"));
}

// Vectors that change at random from vertex to vertex, the hardest case: every vertex has its own texel.
TEST(BiasFile, TextureComesBackOverSeamsAndMirroredIslands) {
  const test::TemporaryFolder folder;
  const Sheet sheet = bumpy_sheet();
  for (const int size : {256, 1000}) {
    const auto bias = random_bias(sheet, 4);
    io::write_png(folder / "bias.png", encode_bias(sheet.surface, sheet.rest, bias, size));
    expect_same(read_bias(folder / "bias.png", sheet.surface, sheet.rest).bias, bias);
  }
}

// A constant vector of the flat sheet has the same colour all over each island, and in its margin of eight
// texels.
TEST(BiasFile, TextureIsFilledAndWidened) {
  Sheet sheet = test::grid(5, 5, 0.2, 0, 1);
  for (auto& vertex : sheet.surface.render_vertices) vertex.uv = 0.1F + 0.5F * vertex.uv;
  const double angle = glm::radians(20.0);
  const std::vector<glm::dvec3> bias(sheet.size(), 0.4 * glm::dvec3(std::cos(angle), std::sin(angle), 0));
  constexpr int size = 200;
  const io::Image image = encode_bias(sheet.surface, sheet.rest, bias, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const std::uint8_t* texel = &image.rgba[4 * static_cast<std::size_t>(y * size + x)];
      const double u = (x + 0.5) / size, v = 1 - (y + 0.5) / size;
      const double outside = std::max({0.1 - u, u - 0.5, 0.1 - v, v - 0.5}) * size;
      if (outside < 7) {
        EXPECT_NEAR(texel[0], 255 * (0.5 + 0.5 * std::cos(2 * angle)), 1) << x << " " << y;
        EXPECT_NEAR(texel[1], 255 * (0.5 + 0.5 * std::sin(2 * angle)), 1);
        EXPECT_NEAR(texel[2], 255 * 0.4, 1);
      } else if (outside > 10) {
        EXPECT_EQ(texel[2], 0);
      }
    }
  }
}

TEST(BiasFile, RefusesWhatDoesNotFit) {
  const test::TemporaryFolder folder;
  const Sheet sheet = bumpy_sheet(), other = test::grid(4, 4, 0.1, 0, 1);
  auto bias = random_bias(sheet, 5);
  write_bias_ply(folder / "bias.ply", sheet.surface, only(bias));
  const auto ply = folder / "bias.ply";
  EXPECT_THAT(test::error_of([&] { read_bias(ply, other.surface, other.rest); }),
              HasSubstr("has 289 vertices, the model has 16"));
  Sheet moved = sheet;
  moved.surface.rest[7].x += 0.01;
  EXPECT_THAT(test::error_of([&] { read_bias(ply, moved.surface, moved.rest); }),
              HasSubstr("vertex 7 is 0.01 m"));
  bias[9] = {0, 1.5, 0};
  write_bias_ply(ply, sheet.surface, only(bias));
  EXPECT_THAT(test::error_of([&] { read_bias(ply, sheet.surface, sheet.rest); }),
              HasSubstr("vertex 9: bias has a length of 1.5"));
  test::write_text(folder / "points.ply", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n");
  EXPECT_THAT(test::error_of([&] { read_bias(folder / "points.ply", sheet.surface, sheet.rest); }),
              HasSubstr("has 0 vertices"));

  const io::Image wide{4, 2, std::vector<std::uint8_t>(32, 128)},
      square{4, 4, std::vector<std::uint8_t>(64, 128)};
  EXPECT_THAT(test::error_of([&] { decode_bias(sheet.surface, sheet.rest, wide, "a.png"); }),
              HasSubstr("a.png: is 4x2 pixels"));
  Sheet bare = sheet;
  bare.surface.parts[0].has_uv = false;
  EXPECT_THAT(test::error_of([&] { decode_bias(bare.surface, bare.rest, square, "a.png"); }),
              HasSubstr("no uv"));
  EXPECT_THAT(test::error_of([&] { encode_bias(bare.surface, bare.rest, bias, 64); }), HasSubstr("no uv"));
  EXPECT_THAT(test::error_of([&] { encode_bias(sheet.surface, sheet.rest, random_bias(sheet, 1), 16); }),
              HasSubstr("a texture of 16×16 has too few"));
  Sheet outside = sheet;
  outside.surface.render_vertices[0].uv.x = 100.5F;
  EXPECT_THAT(test::error_of([&] { encode_bias(outside.surface, outside.rest, bias, 64); }),
              HasSubstr("at most 64 tiles a side"));
}

// A pattern that repeats, islands on top of each other, all of the uv at one point, and triangles without
// area in uv: each vertex is read back as it was painted.
TEST(BiasFile, TextureComesBackWhereUvRepeatOverlapAndCollapse) {
  const test::TemporaryFolder folder;
  const Sheet plain = bumpy_sheet();
  std::vector<Sheet> sheets(4, plain);
  for (auto& vertex : sheets[0].surface.render_vertices) vertex.uv = 7.0F * vertex.uv - glm::vec2(3, 1);
  for (auto& vertex : sheets[1].surface.render_vertices)
    if (vertex.uv.x > 0.5F) vertex.uv.x = 1 - vertex.uv.x;
  for (auto& vertex : sheets[2].surface.render_vertices) vertex.uv = {0.3F, 0.7F};
  for (auto& vertex : sheets[3].surface.render_vertices) vertex.uv.y = 0.25F;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const Sheet& sheet = sheets[i];
    const auto bias = random_bias(sheet, 7);
    std::size_t moved = 0;
    io::write_png(folder / "bias.png", encode_bias(sheet.surface, sheet.rest, bias, 512, &moved));
    expect_same(read_bias(folder / "bias.png", sheet.surface, sheet.rest).bias, bias);
    EXPECT_TRUE(i == 1 || (moved > 0) == (i > 1)) << i;  // those of 1 overlap between their vertices, too
  }
}

}  // namespace
}  // namespace plisse::paint
