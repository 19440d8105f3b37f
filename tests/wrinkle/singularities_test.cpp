// Indices of direction fields that are given in closed form.
#include "wrinkle/singularities.h"

#include <gtest/gtest.h>

#include <numeric>

#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::Grid;

// Directions at an angle of `turns` times that of the place, seen from a point between the grid's vertices.
std::vector<int> indices(double turns, double offset = 0.3) {
  const Grid grid(1, 1, 11, 11);
  const auto forms = test::prescribed(
      grid,
      [&](const Vector3d& x) {
        const double angle = turns * std::atan2(x.y() - 0.462, x.x() - 0.455) + offset;
        const Vector2d w(std::cos(angle), std::sin(angle)), c(-w.y(), w.x());
        return Eigen::Matrix2d(0.01 * c * c.transpose() - 0.02 * w * w.transpose());
      },
      test::no_form);
  return double_index(forms, shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols())),
                      std::vector<bool>(grid.faces.size(), true));
}

TEST(Singularities, IndexOfKnownFields) {
  for (const double offset : {0.0, 0.3, 1.7, 3.0}) {
    for (const auto& [turns, expected] : {std::pair(0.0, 0), {0.5, 1}, {-0.5, -1}, {1.0, 2}}) {
      const auto index = indices(turns, offset);
      EXPECT_EQ(std::accumulate(index.begin(), index.end(), 0), expected) << turns << " " << offset;
      // In one place, or in two beside each other.
      EXPECT_LE(index.size() - static_cast<std::size_t>(std::count(index.begin(), index.end(), 0)),
                static_cast<std::size_t>(std::abs(expected)))
          << turns << " " << offset;
    }
  }
}

TEST(Singularities, NoneOnARim) {
  const Grid grid(1, 1, 4, 4);
  const auto forms = test::prescribed(
      grid, [](const Vector3d&) { return test::diagonal(-0.02, 0.01); }, test::no_form);
  std::vector<bool> live(grid.faces.size(), true);
  live[12] = false;
  for (const int i : double_index(forms, shell::build_topology(grid.faces, 25), live)) EXPECT_EQ(i, 0);
}

}  // namespace
}  // namespace plisse::wrinkle
