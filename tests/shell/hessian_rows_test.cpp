// Second derivatives of vertex values against those of polynomials.
#include "shell/hessian_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shell/bending_quadratic.h"

namespace plisse::shell {
namespace {

constexpr int cells = 8;

// A flat sheet of 1 m in right-angled triangles, inner vertices moved by up to `uneven` of an edge.
struct Flat {
  explicit Flat(double uneven) : places(3, (cells + 1) * (cells + 1)) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-uneven / cells, uneven / cells);
    std::vector<Face> faces;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        const bool inner = i > 0 && j > 0 && i < cells && j < cells;
        places.col(j * (cells + 1) + i) = Eigen::Vector3d(double(i) / cells + (inner ? any(random) : 0),
                                                          double(j) / cells + (inner ? any(random) : 0), 0);
      }
    for (std::uint32_t j = 0; j < cells; ++j)
      for (std::uint32_t i = 0; i < cells; ++i) {
        const std::uint32_t a = j * (cells + 1) + i, up = a + cells + 1;
        faces.push_back({a, a + 1, up + 1});
        faces.push_back({a, up + 1, up});
      }
    topology = build_topology(std::move(faces), static_cast<std::size_t>(places.cols()));
    rest = rest_faces(places, topology.faces);
  }
  // uu, vv and √2 uv of a function of x and y, times the area of the cell.
  template <typename Function>
  std::vector<Eigen::Vector3d> of(const Function& function) const {
    std::vector<Eigen::Vector3d> result;
    for (const HessianRows& rows : hessian_rows(topology, rest)) {
      Eigen::Vector3d& sum = result.emplace_back(0, 0, 0);
      for (int r = 0; r < 3; ++r)
        for (const auto& [v, weight] : rows.integral[static_cast<std::size_t>(r)])
          sum[r] += weight * function(places(0, v), places(1, v));
    }
    return result;
  }
  Positions places;
  Topology topology;
  std::vector<RestFace> rest;
};

TEST(HessianRows, LinearFunctionsHaveNone) {
  const Flat sheet(0.3);
  const auto found = sheet.of([](double x, double y) { return 3 + 2 * x - 5 * y; });
  EXPECT_EQ(found.size(), static_cast<std::size_t>((cells - 1) * (cells - 1)));  // of inner vertices
  for (const Eigen::Vector3d& h : found) EXPECT_LT(h.norm(), 1e-13);  // sums of some twenty terms of 1
}

// On a regular mesh exact for quadratic functions, whatever the directions in which a ring is laid flat: by
// trace, determinant and square.
TEST(HessianRows, QuadraticFunctionsAreExact) {
  const Flat sheet(0);
  const Eigen::VectorXd areas = cell_laplacian(sheet.topology, sheet.rest).areas;
  const double uu = 0.7, vv = -1.1, uv = 0.4, cell = 1.0 / (cells * cells);
  const auto found =
      sheet.of([&](double x, double y) { return uu * x * x / 2 + vv * y * y / 2 + uv * x * y; });
  for (const Eigen::Vector3d& h : found) {
    EXPECT_NEAR((h[0] + h[1]) / cell, uu + vv, 1e-10);
    EXPECT_NEAR(h.squaredNorm() / (cell * cell), uu * uu + vv * vv + 2 * uv * uv, 1e-10);
    EXPECT_NEAR((h[0] * h[1] - h[2] * h[2] / 2) / (cell * cell), uu * vv - uv * uv, 1e-10);
  }
  EXPECT_NEAR(areas[cells + 2], cell, 1e-15);
}

// Their sum of squares is what bending is: a saddle, whose Laplacian is 0, has some.
TEST(HessianRows, SaddlesBend) {
  const Flat sheet(0);
  for (const Eigen::Vector3d& h : sheet.of([](double x, double y) { return x * x - y * y; })) {
    EXPECT_NEAR(h[0] + h[1], 0, 1e-12);
    EXPECT_NEAR(h.squaredNorm() * std::pow(cells, 4), 8, 1e-9);
  }
}

}  // namespace
}  // namespace plisse::shell
