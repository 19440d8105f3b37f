// Texels and the points of the surface they belong to.
#include "mesh/uv_raster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/errors.h"

namespace plisse {
namespace {

using ::testing::HasSubstr;

// One triangle, uv as given.
Surface triangle(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  Surface surface;
  surface.rest = surface.bind = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const glm::vec2& uv : {a, b, c})
    surface.render_vertices.push_back({static_cast<std::uint32_t>(surface.render_vertices.size()), uv});
  surface.triangles = {0, 1, 2};
  surface.parts.resize(1);
  surface.parts[0].mesh = "cloth";
  surface.parts[0].triangle_count = 1;
  surface.parts[0].has_uv = true;
  return surface;
}

void add_copy(Surface& surface) {
  surface.triangles.insert(surface.triangles.end(), {0, 1, 2});
  surface.parts[0].triangle_count = 2;
}

TEST(UvRaster, TexelsKnowTheirPlace) {
  const Surface surface = triangle({0.1F, 0.1F}, {0.9F, 0.2F}, {0.3F, 0.8F});
  const UvRaster raster = uv_raster(surface, 200, 0);
  std::size_t covered = 0;
  for (std::size_t i = 0; i < raster.triangle.size(); ++i) {
    if (raster.triangle[i] == UvRaster::none) continue;
    ++covered;
    glm::dvec2 uv(0);
    for (int c = 0; c < 3; ++c) uv += raster.barycentric[i][c] * glm::dvec2(surface.render_vertices[c].uv);
    // Row 0 is at the top.
    EXPECT_NEAR(uv.x, (static_cast<double>(i % 200) + 0.5) / 200, 1e-12);
    EXPECT_NEAR(uv.y, 1 - (static_cast<double>(i / 200) + 0.5) / 200, 1e-12);
  }
  EXPECT_EQ(raster.covered, covered);
  // ½ (.8·.7 − .1·.2) = .27 of all texels, give or take those on the rim (2.2 sides long, a texel wide).
  EXPECT_NEAR(static_cast<double>(covered) / (200 * 200), 0.27, 0.5 * 2.2 / 200);
  EXPECT_EQ(raster.overlapping, 0U);
}

TEST(UvRaster, IslandsAreWidenedAndNoFurther) {
  const UvRaster raster = uv_raster(triangle({0, 0}, {0.5F, 0}, {0, 0.5F}), 64, 4);
  const auto at = [](std::size_t x, std::size_t y) { return (63 - y) * 64 + x; };
  ASSERT_NE(raster.triangle[at(10, 10)], UvRaster::none);
  EXPECT_EQ(raster.source[at(10, 10)], static_cast<std::int64_t>(at(10, 10)));
  EXPECT_EQ(raster.triangle[at(34, 0)], UvRaster::none);
  const std::int64_t from = raster.source[at(34, 0)];
  ASSERT_NE(from, UvRaster::none);
  EXPECT_NE(raster.triangle[static_cast<std::size_t>(from)], UvRaster::none);
  EXPECT_EQ(raster.source[at(37, 0)], UvRaster::none);
}

TEST(UvRaster, OverlapsAreCountedAndSharedEdgesAreNone) {
  Surface surface = triangle({0, 0}, {1, 0}, {0, 1});
  surface.render_vertices.push_back({1, {1, 1}});
  surface.triangles.insert(surface.triangles.end(), {1, 3, 2});
  surface.parts[0].triangle_count = 2;
  EXPECT_EQ(uv_raster(surface, 64, 0).overlapping, 0U);  // texels' middles lie on the diagonal
  Surface twice = triangle({0, 0}, {1, 0}, {0, 1});
  add_copy(twice);
  const UvRaster raster = uv_raster(twice, 64, 0);
  EXPECT_EQ(raster.overlapping, 63U * 64 / 2);  // all but those on the diagonal
  EXPECT_EQ(raster.covered, 64U * 65 / 2);
}

// The uv of cloth whose pattern repeats: what lies inside 0…1 after fitting is what a raster of that would
// be. (The numbers have no rounding, or texels whose middles lie on an edge might go either way.)
TEST(UvRaster, RepeatingUvIsFittedByWholeTiles) {
  const UvRaster tiled = uv_raster(triangle({-0.5F, 1.25F}, {2.75F, 1.5F}, {0.25F, 3.875F}), 100, 2);
  EXPECT_EQ(tiled.corner, glm::dvec2(-1, 1));
  EXPECT_EQ(tiled.side, 4);
  const UvRaster fitted =
      uv_raster(triangle({0.5F / 4, 0.25F / 4}, {3.75F / 4, 0.5F / 4}, {1.25F / 4, 2.875F / 4}), 100, 2);
  EXPECT_EQ(fitted.corner, glm::dvec2(0));
  EXPECT_EQ(fitted.side, 1);
  EXPECT_EQ(tiled.triangle, fitted.triangle);
  EXPECT_EQ(tiled.source, fitted.source);
  // Up to the rim and a rounding over it are still one tile.
  EXPECT_EQ(uv_raster(triangle({-1e-7F, 0}, {1, 0}, {0, 1.0000001F}), 16, 0).side, 1);
}

TEST(UvRaster, SaysWhatIsMissing) {
  Surface surface = triangle({0, 0}, {1, 0}, {0, 1});
  surface.parts[0].has_uv = false;
  EXPECT_THAT(test::error_of([&] { uv_raster(surface, 64, 0); }), HasSubstr("mesh 'cloth' has no uv"));
  surface.parts[0].wrinkles = false;
  EXPECT_THAT(test::error_of([&] { uv_raster(surface, 64, 0); }), HasSubstr("nothing of the model wrinkles"));
  EXPECT_THAT(test::error_of([&] {
                uv_raster(triangle({0, 0}, {65.5F, 0}, {0, 1}), 64, 0);
              }),
              HasSubstr("uv reaches from (0, 0) to (65.5, 1); a texture covers at most 64 tiles a side"));
}

}  // namespace
}  // namespace plisse
