// Skin on the GPU against closed forms: matrices whose result is known, eight influences, morph targets,
// palettes of any size, and normals where the triangles or the matrix give none.
#include "passes/skin.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "support/opengl.h"
#include "support/sheets.h"

namespace plisse::passes {
namespace {

using test::Passes;
using test::Readings;
using test::Sheet;

class Skin : public test::OpenGlTest {};

// Sheets here are about 1 unit large; single precision keeps 6e-8 of that, and a sum of eight influences
// about ten times it.
constexpr double position_tolerance = 1e-6;
// Frames come from differences of positions over edges of .1 and more: 6e-8/.1, times ten.
constexpr double frame_tolerance = 1e-5;

Sheet small_grid(double jitter = 0.3) {
  return test::grid(7, 6, 0.15, jitter, 3);
}

glm::dmat4 random_affine(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  glm::dmat4 m(1);
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) m[c][r] = number(random) + (c == r ? 1.0 : 0.0);
  }
  return m;
}

// cof(A) by the definition with inverse and determinant.
glm::dmat3 cofactor(const glm::dmat3& a) {
  return glm::determinant(a) * glm::transpose(glm::inverse(a));
}

void expect_near(const glm::dvec3& value, const glm::dvec3& expected, double tolerance, std::size_t v) {
  EXPECT_LE(glm::distance(value, expected), tolerance) << "vertex " << v;
}

void expect_orthonormal(const Readings& now) {
  for (std::size_t v = 0; v < now.normal.size(); ++v) {
    EXPECT_NEAR(glm::length(now.normal[v]), 1, frame_tolerance) << v;
    EXPECT_NEAR(glm::length(now.tangent[v]), 1, frame_tolerance) << v;
    EXPECT_NEAR(glm::dot(now.normal[v], now.tangent[v]), 0, frame_tolerance) << v;
  }
}

TEST_F(Skin, QuarterTurnAndMove) {
  const Sheet sheet = small_grid();
  Passes passes(sheet);
  // Quarter turn round x takes y to z and z to −y.
  const glm::dmat4 m = glm::translate(glm::dmat4(1), {0.25, -0.5, 1}) *
                       glm::rotate(glm::dmat4(1), std::numbers::pi / 2, glm::dvec3(1, 0, 0));
  passes.pose({m});
  const Readings now = passes.read();
  for (std::size_t v = 0; v < sheet.size(); ++v) {
    const glm::dvec3 x = sheet.surface.rest[v];
    expect_near(now.position[v], {x.x + 0.25, -0.5, x.y + 1}, position_tolerance, v);
    expect_near(now.normal[v], {0, -1, 0}, frame_tolerance, v);
    const glm::dvec3 t = sheet.rest.tangent[v];
    expect_near(now.tangent[v], {t.x, 0, t.y}, frame_tolerance, v);
  }
}

TEST_F(Skin, BlendsEightInfluences) {
  Sheet sheet = small_grid();
  std::mt19937 random(5);
  std::uniform_real_distribution<float> weight(0.05F, 1);
  std::vector<glm::dmat4> palette;
  for (int i = 0; i < 20; ++i) palette.push_back(random_affine(random));
  for (auto& influences : sheet.surface.influences) {
    float sum = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      influences.entry[i] = static_cast<std::uint32_t>(random() % palette.size());
      sum += influences.weight[i] = weight(random);
    }
    for (float& w : influences.weight) w /= sum;
  }
  Passes passes(sheet, palette.size());
  passes.pose(palette);
  const Readings now = passes.read();
  for (std::size_t v = 0; v < sheet.size(); ++v) {
    glm::dvec4 expected(0);
    for (std::size_t i = 0; i < 8; ++i) {
      const auto& influences = sheet.surface.influences[v];
      expected += static_cast<double>(influences.weight[i]) *
                  (palette[influences.entry[i]] * glm::dvec4(sheet.surface.bind[v], 1));
    }
    expect_near(now.position[v], glm::dvec3(expected), 4 * position_tolerance,
                v);  // the palette's entries are up to 2
  }
  expect_orthonormal(now);
}

TEST_F(Skin, AddsMorphTargetsBeforeTheMatrices) {
  Sheet sheet = small_grid();
  const std::size_t count = sheet.size();
  sheet.surface.target_count = 2;
  for (std::size_t v = 0; v < count; ++v) sheet.surface.target_deltas.emplace_back(0.5F, 0, 0);
  for (std::size_t v = 0; v < count; ++v)
    sheet.surface.target_deltas.emplace_back(0, 0, static_cast<float>(v % 3));
  Passes passes(sheet);
  passes.pose({glm::scale(glm::dmat4(1), {1, 2, 3})}, {0.5, -0.25});
  const Readings now = passes.read();
  for (std::size_t v = 0; v < count; ++v) {
    const glm::dvec3 x = sheet.surface.bind[v];
    expect_near(now.position[v], {x.x + 0.25, 2 * x.y, 3 * -0.25 * static_cast<double>(v % 3)},
                position_tolerance, v);
  }
}

// 64 KiB is what most drivers give a uniform block: 1365 matrices. A vertex for every matrix, the last ones
// included.
TEST_F(Skin, PaletteLargerThanAUniformBlock) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &limit);
  const auto fits = static_cast<std::size_t>(limit) / 48;
  ASSERT_GE(fits, 341U);  // 16 KiB: what OpenGL promises
  if (fits > 1000000) GTEST_SKIP() << "uniform blocks have no limit worth the name here";
  for (const std::size_t size : {fits, fits + 1, fits + 1000}) {
    const int columns = 30, rows = static_cast<int>(size / 30) + 1;
    Sheet sheet = test::grid(columns, rows, 0.02, 0.3, 4);
    for (std::size_t v = 0; v < sheet.size(); ++v) {
      sheet.surface.influences[v].entry[0] = static_cast<std::uint32_t>(std::min(v, size - 1));
    }
    std::vector<glm::dmat4> palette;
    for (std::size_t i = 0; i < size; ++i) {
      palette.push_back(glm::translate(glm::dmat4(1), {0, 0, 1e-3 * static_cast<double>(i)}));
    }
    Passes passes(sheet, size);
    passes.pose(palette);
    const Readings now = passes.read();
    for (std::size_t v = 0; v < sheet.size(); ++v) {
      // The last of thousands of heights is some units up.
      EXPECT_NEAR(now.position[v].z, 1e-3 * static_cast<double>(std::min(v, size - 1)),
                  4 * position_tolerance)
          << v;
    }
  }
}

TEST_F(Skin, NormalsOfAnAffineMapAreCofactors) {
  const Sheet sheet = small_grid();
  Passes passes(sheet);
  std::mt19937 random(9);
  for (int i = 0; i < 20; ++i) {
    const glm::dmat4 m = random_affine(random);
    const glm::dvec3 scaled = cofactor(glm::dmat3(m)) * glm::dvec3(0, 0, 1);
    if (glm::length(scaled) < 0.05) continue;  // nearly edge-on: the areas cancel
    passes.pose({m});
    const Readings now = passes.read();
    for (std::size_t v = 0; v < sheet.size(); ++v) {
      expect_near(now.normal[v], glm::normalize(scaled), frame_tolerance / glm::length(scaled), v);
    }
    expect_orthonormal(now);
  }
}

// A vertex without triangles has only the matrix; a flat sheet whose triangles vanish as well.
TEST_F(Skin, NormalsWithoutTriangles) {
  Sheet sheet = test::sheet({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {});
  sheet.surface.bind_normal = {{0, 0, 1}, {0.6, 0, 0.8}, {0, 1, 0}};
  sheet.rest = rest_frames(sheet.surface);
  Passes passes(sheet);
  std::mt19937 random(10);
  for (int i = 0; i < 10; ++i) {
    const glm::dmat4 m = random_affine(random);
    passes.pose({m});
    const Readings now = passes.read();
    for (std::size_t v = 0; v < 3; ++v) {
      expect_near(now.normal[v], glm::normalize(cofactor(glm::dmat3(m)) * sheet.surface.bind_normal[v]),
                  frame_tolerance, v);
    }
    expect_orthonormal(now);
  }
}

TEST_F(Skin, MirroredAndSingularMatricesGiveUnitNormals) {
  const Sheet sheet = small_grid();
  Passes passes(sheet);
  const auto normal_after = [&](const glm::dvec3& scale) {
    passes.pose({glm::scale(glm::dmat4(1), scale)});
    const Readings now = passes.read();
    expect_orthonormal(now);
    for (const auto& n : now.normal) expect_near(n, now.normal[0], frame_tolerance, 0);
    return now.normal[0];
  };
  // A mirror in the sheet turns its triangles over; one across it turns nothing in the plane.
  EXPECT_EQ(normal_after({-1, 1, 1}), glm::dvec3(0, 0, -1));
  EXPECT_EQ(normal_after({1, 1, -1}), glm::dvec3(0, 0, 1));
  EXPECT_EQ(normal_after({-1, -1, 1}), glm::dvec3(0, 0, 1));
  EXPECT_EQ(normal_after({1, 1, 0}), glm::dvec3(0, 0, 1));
  // Collapsed to a line, then to a point: no triangle and no cofactor is left, so the bind normal stands.
  EXPECT_EQ(normal_after({1, 0, 1}), glm::dvec3(0, 0, 1));
  EXPECT_EQ(normal_after({0, 0, 0}), glm::dvec3(0, 0, 1));
  // Collapsed to a sliver whose areas are gone in single precision.
  EXPECT_TRUE(std::isfinite(normal_after({1, 1e-12, 1}).x));
  // Folded onto a line that is not an axis: collapsed, then turned.
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  passes.pose({turned * glm::scale(glm::dmat4(1), {1, 0, 1})});
  expect_orthonormal(passes.read());
}

TEST_F(Skin, ACacheGivesTheFramesThatMatricesGive) {
  const Sheet sheet = small_grid();
  Passes passes(sheet);
  passes.pose({glm::rotate(glm::dmat4(1), 0.4, glm::normalize(glm::dvec3(1, -2, 0.5)))});
  const Readings by_matrix = passes.read();
  Passes cached(sheet);
  cached.pose(by_matrix.position);  // exact in single precision
  const Readings by_cache = cached.read();
  EXPECT_EQ(by_cache.position, by_matrix.position);
  EXPECT_EQ(by_cache.normal, by_matrix.normal);
  EXPECT_EQ(by_cache.tangent, by_matrix.tangent);
}

}  // namespace
}  // namespace plisse::passes
