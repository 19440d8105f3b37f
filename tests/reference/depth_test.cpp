// Depth maps of the reference against planes whose depth is known everywhere.
#include "reference/depth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plates.h"

namespace plisse::reference {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

TEST(ReferenceDepth, AParallelViewHoldsTheSphere) {
  const Vector3d centre(1, -2, 3);
  constexpr double radius = 2.5;
  for (const Vector3d& direction : {Vector3d(0.36, -0.48, 0.8), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
    const Matrix4d view = parallel_view(centre, radius, direction);
    EXPECT_LT((view * centre.homogeneous()).head<3>().norm(), 1e-14);
    // An orthonormal turn over the radius; a rotation's mirror image, since depth grows along the direction.
    const Eigen::Matrix3d turn = radius * view.topLeftCorner<3, 3>();
    EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(turn.determinant(), -1, 1e-14);
    const Vector3d front = centre - radius * direction, back = centre + radius * direction;
    EXPECT_NEAR((view * front.homogeneous()).z(), -1, 1e-14);
    EXPECT_NEAR((view * back.homogeneous()).z(), 1, 1e-14);
  }
  // Level light: up in the world is up in the map.
  EXPECT_GT((parallel_view(centre, radius, Vector3d::UnitX()) * Eigen::Vector4d(0, 1, 0, 0)).y(), 0);
}

TEST(ReferenceDepth, PlanesHaveTheirDepth) {
  // Seen along +z from z = −1 to 1: a slope z = x/2 everywhere, before it a plate at z = −.8.
  auto triangles = test::plate({-2, -2, -1}, {4, 0, 2}, {0, 4, 0});
  for (const Triangle& t : test::plate({-0.3, -0.4, -0.8}, {0.7, 0, 0}, {0, 0.6, 0})) triangles.push_back(t);
  const Matrix4d view = parallel_view(Vector3d::Zero(), 1, Vector3d::UnitZ());
  constexpr int size = 40;
  const DepthMap map = depth_map(triangles, view, size);
  int plate = 0, loose = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const auto texel = static_cast<std::size_t>(row * size + column);
      // right = z × y = −x.
      const double x = -(2 * (column + 0.5) / size - 1), y = 2 * (row + 0.5) / size - 1;
      const bool on_plate = x > -0.3 && x < 0.4 && y > -0.4 && y < 0.2;
      const double expected = 0.5 + 0.5 * (on_plate ? -0.8 : x / 2);
      EXPECT_NEAR(map.depth[texel], expected, 1e-12) << column << " " << row;
      EXPECT_LE(map.nearest[texel], map.depth[texel]);
      EXPECT_GE(map.farthest[texel], map.depth[texel]);
      // An inexact corner moves the slope by at most .01 texel, .0005 units, half of that in z, half in
      // depth. Only middles on an edge, here the plates' diagonals, may be missed by a triangle.
      loose += map.farthest[texel] - map.nearest[texel] > 1e-3 ? 1 : 0;
      plate += on_plate;
    }
  EXPECT_EQ(plate, 14 * 12);
  EXPECT_LE(loose, size + 14);
}

TEST(ReferenceDepth, NothingIsFarthest) {
  const DepthMap map = depth_map(test::plate({0, 0, 0}, {2, 0, 0}, {0, 2, 0}),
                                 parallel_view(Vector3d::Zero(), 1, -Vector3d::UnitZ()), 8);
  EXPECT_EQ(map.depth[0], 1);
  EXPECT_EQ(map.nearest[0], 1);
  EXPECT_NEAR(map.depth[63], 0.5, 1e-12);
}

}  // namespace
}  // namespace plisse::reference
