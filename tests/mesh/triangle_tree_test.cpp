// The tree of boxes against going through all triangles one by one.
#include "mesh/triangle_tree.h"

#include <gtest/gtest.h>

#include <random>

namespace plisse {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

TriangleTree scattered(std::mt19937& engine, int count) {
  std::normal_distribution<double> normal;
  Matrix3Xd points(3, 3 * count);
  std::vector<TriangleTree::Triangle> triangles;
  for (int t = 0; t < count; ++t) {
    const Vector3d middle(normal(engine), normal(engine), normal(engine));
    for (int k = 0; k < 3; ++k)
      points.col(3 * t + k) = middle + 0.2 * Vector3d(normal(engine), normal(engine), normal(engine));
    const auto first = static_cast<std::uint32_t>(3 * t);
    triangles.push_back({first, first + 1, first + 2});
  }
  return {points, triangles};
}

// The least of |p − q| over points q of a triangle, by ever finer steps of its weights.
double searched_distance(const Matrix3d& corners, const Vector3d& p) {
  Vector3d best(1.0 / 3, 1.0 / 3, 1.0 / 3);
  for (double step = 0.5; step > 1e-9; step *= 0.7)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) {
        Vector3d weights = best;
        const double moved = std::min(step, weights[k]);
        weights[k] -= moved;
        weights[l] += moved;
        if ((corners * weights - p).norm() < (corners * best - p).norm()) best = weights;
      }
  return (corners * best - p).norm();
}

TEST(TriangleTree, NearestWeights) {
  std::mt19937 engine(1);
  const TriangleTree tree = scattered(engine, 200);
  const Vector3d p(0.1, -0.2, 0.3);
  for (std::uint32_t t = 0; t < 200; ++t) {
    const Vector3d weights = nearest_weights(tree.corners(t), p);
    EXPECT_GE(weights.minCoeff(), 0);
    EXPECT_NEAR(weights.sum(), 1, 1e-14);
    // The search's last steps are 1e-9 of edges of some .4; narrow triangles make it slow to turn.
    EXPECT_NEAR((tree.corners(t) * weights - p).norm(), searched_distance(tree.corners(t), p), 1e-5);
  }
}

TEST(TriangleTree, NearestIsNearestOfAll) {
  std::mt19937 engine(2);
  std::normal_distribution<double> normal;
  const TriangleTree tree = scattered(engine, 500);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d p = 1.5 * Vector3d(normal(engine), normal(engine), normal(engine));
    double least = std::numeric_limits<double>::infinity();
    std::size_t close = 0;
    for (std::uint32_t t = 0; t < 500; ++t) {
      const double distance = (tree.corners(t) * nearest_weights(tree.corners(t), p) - p).norm();
      least = std::min(least, distance);
      if (distance < 0.5) ++close;
    }
    const auto nearest = tree.nearest(p);
    EXPECT_EQ(nearest.distance, least);
    EXPECT_EQ((nearest.point - p).norm(), least);
    EXPECT_EQ(tree.nearest(p, 0.5).triangle != TriangleTree::Nearest::nothing, least < 0.5);
    std::size_t seen = 0;  // boxes are wider than triangles, so that more may be seen than are close
    tree.each_near(p, 0.5, [&](std::uint32_t t) {
      if ((tree.corners(t) * nearest_weights(tree.corners(t), p) - p).norm() < 0.5) ++seen;
    });
    EXPECT_EQ(seen, close);
  }
}

TEST(TriangleTree, FirstHitIsFirstOfAll) {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  const TriangleTree tree = scattered(engine, 300);
  int hits = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d from = 2 * Vector3d(normal(engine), normal(engine), normal(engine)),
                   to = 2 * Vector3d(normal(engine), normal(engine), normal(engine));
    double first = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < 300; ++t) {
      // a + v ab + w ac = from + s (to − from), solved as it stands.
      const Matrix3d at = tree.corners(t);
      Matrix3d system;
      system << at.col(1) - at.col(0), at.col(2) - at.col(0), from - to;
      const Vector3d vws = system.fullPivLu().solve(from - at.col(0));
      if (vws[0] >= 0 && vws[1] >= 0 && vws[0] + vws[1] <= 1 && vws[2] >= 0 && vws[2] <= 1)
        first = std::min(first, vws[2]);
    }
    const double found = tree.first_hit(from, to);
    ASSERT_EQ(std::isinf(found), std::isinf(first));
    if (std::isinf(first)) continue;
    ++hits;
    EXPECT_NEAR(found, first, 1e-9);
  }
  EXPECT_GT(hits, 20);
}

}  // namespace
}  // namespace plisse
