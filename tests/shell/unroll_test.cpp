// Rest shapes laid flat keep their shape, in one piece where they are one.
#include "shell/unroll.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plisse::shell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A strip of 2n triangles along x, n cells of 1 × 1.
std::vector<Face> strip(std::uint32_t cells, std::uint32_t columns) {
  std::vector<Face> faces;
  for (std::uint32_t i = 0; i < cells; ++i) {
    const std::uint32_t a = i, b = (i + 1) % columns, c = a + columns, d = b + columns;
    faces.push_back({a, b, d});
    faces.push_back({a, d, c});
  }
  return faces;
}

// The lengths of the sides of a triangle.
std::array<double, 3> sides(const std::array<Vector2d, 3>& x) {
  return {(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm()};
}

TEST(Unroll, KeepsShapesAndRunsOnAcrossSides) {
  // A strip that is bent in space: eight cells on a cylinder, open; and closed to a ring.
  for (const bool closed : {false, true}) {
    const std::uint32_t columns = closed ? 8 : 9;
    Positions x(3, 2 * columns);
    const double angle = closed ? 2 * std::numbers::pi / 8 : 0.3, radius = 0.5 / std::sin(angle / 2);
    for (std::uint32_t i = 0; i < columns; ++i) {
      for (std::uint32_t j = 0; j < 2; ++j)
        x.col(i + j * columns) << radius * std::sin(angle * i), j, radius * std::cos(angle * i);
    }
    const auto faces = strip(8, columns);
    const auto rest = rest_faces(x, faces);
    const Topology topology = build_topology(faces, 2 * columns);
    const auto uv = unrolled(topology, rest);
    ASSERT_EQ(uv.size(), 16U);
    double low = 1, high = 0;
    for (std::size_t f = 0; f < uv.size(); ++f) {
      const auto is = sides(uv[f]),
                 was = sides({Vector2d::Zero(), rest[f].edges.col(0), rest[f].edges.col(1)});
      for (std::size_t s = 0; s < 3; ++s) EXPECT_NEAR(is[s], was[s] / 8, 1e-12);  // 8 long, to 1
      for (const Vector2d& p : uv[f]) {
        low = std::min(low, p.minCoeff());
        high = std::max(high, p.maxCoeff());
      }
    }
    EXPECT_NEAR(low, 0, 1e-12);
    EXPECT_NEAR(high, 1, 1e-12);
    int cuts = 0;
    for (const Edge& edge : topology.edges) {
      if (edge.boundary()) continue;
      for (const std::uint32_t v : edge.vertex) {
        const auto place = [&](std::uint32_t f) {
          std::size_t c = 0;
          while (faces[f][c] != v) ++c;
          return uv[f][c];
        };
        if ((place(edge.face[0]) - place(edge.face[1])).norm() > 1e-12) ++cuts;
      }
    }
    EXPECT_EQ(cuts, closed ? 2 : 0);  // both ends of the one edge where the ring is cut
  }
}

TEST(Unroll, PiecesStandSideBySide) {
  Positions x(3, 8);
  x << 0, 1, 0, 1, 5, 6, 5, 6, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0;
  const std::vector<Face> faces{{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}};
  const auto uv = unrolled(build_topology(faces, 8), rest_faces(x, faces));
  double first = 0, second = 1;
  for (std::size_t f = 0; f < 4; ++f) {
    for (const Vector2d& p : uv[f])
      (f < 2 ? first = std::max(first, p.x()) : second = std::min(second, p.x()));
  }
  EXPECT_LT(first, second);
  EXPECT_GT(second, 0.5);
}

}  // namespace
}  // namespace plisse::shell
