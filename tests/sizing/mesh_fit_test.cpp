// A given mesh against a fabric's resolution: grids whose edges are known.
#include "sizing/mesh_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sizing/mesh_panel.h"

namespace plisse::sizing {
namespace {

TEST(MeshFit, TellsFinerAndCoarserParts) {
  // Two squares of 1 m, apart: one of 2 triangles, one of 2 · 100².
  std::vector<glm::dvec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  constexpr std::uint32_t n = 100;
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= n; ++x) positions.emplace_back(2 + x / double{n}, y / double{n}, 0);
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t i = 4 + y * (n + 1) + x;
      triangles.push_back({i, i + 1, i + n + 2});
      triangles.push_back({i, i + n + 2, i + n + 1});
    }
  }
  const double r = 0.1;  // mean edges: 1.138 m and 11.38 mm
  const MeshFit fit = fit_of(positions, triangles, r);
  EXPECT_NEAR(fit.coarser, 0.5, 1e-9);
  EXPECT_NEAR(fit.finer, 0.5, 1e-9);
  EXPECT_NEAR(fit.median_edge, 0.01, 1e-9);
  EXPECT_NEAR(fit.coarse_high.x, 1, 1e-12);  // the box holds the coarse one only
  EXPECT_NEAR(fit.vertices_needed, 2 / std::sqrt(3) * 2 / (r * r) + 8 / r / 2, 1e-6);
}

TEST(MeshFit, APanelMeshedForAFabricFitsIt) {
  Panel panel;
  panel.fabric = *find_fabric("khaki");
  panel.outline = {{{0, 0}, {0.4, 0}, {0.4, 0.3}, {0, 0.3}}, true};
  const auto sized = mesh_panel(panel, {});
  std::vector<glm::dvec3> positions;
  for (const auto& v : sized->mesh.vertices) positions.emplace_back(v, 0);
  const MeshFit fit = fit_of(positions, sized->mesh.triangles, sized->domain.resolution.x);
  EXPECT_EQ(fit.finer, 0);
  EXPECT_EQ(fit.coarser, 0);
  EXPECT_NEAR(fit.median_edge, fit.resolution, 0.05 * fit.resolution);
  EXPECT_NEAR(fit.vertices_needed, static_cast<double>(positions.size()), 0.05 * fit.vertices_needed);
}

TEST(MeshFit, NothingIsNothing) {
  EXPECT_EQ(fit_of({}, {}, 1).vertices_needed, 0);
  EXPECT_EQ(fit_of({{0, 0, 0}, {1, 0, 0}}, std::vector<std::array<std::uint32_t, 3>>{{0, 1, 1}}, 1).finer, 0);
}

}  // namespace
}  // namespace plisse::sizing
