// The floor's shadows against closed forms: under a plate, and across its edges.
#include "reference/ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plates.h"
#include "reference/backdrop.h"
#include "reference/functions.h"

namespace plisse::reference {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A square plate of half side .6 hangs above the floor at y = .5 inside the sphere (centre, R = 2), lit from
// `light`.
struct Stage {
  Vector3d centre{1, 2.5, -1};
  double radius = 2, height;
  Ground ground = ground_under(centre, radius, Vector3d::UnitY(), 0.5);
  GroundMap map;
  explicit Stage(double above, const Vector3d& light) : height(above) {
    const auto triangles =
        test::plate({centre.x() - 0.6, 0.5 + above, centre.z() - 0.6}, {1.2, 0, 0}, {0, 0, 1.2});
    const double margin = 1.02 * radius;
    map = ground_map(ground, test::stored(triangles, parallel_view(centre, margin, -light), 1024, margin),
                     test::stored(triangles, view_from_below(ground, centre), 512, margin));
  }
  // At a place of the floor, from the middle of the map.
  Vector2d taken(double x, double z) const {
    const Vector3d from = Vector3d(centre.x() + x, 0.5, centre.z() + z) - ground.origin;
    return sample(map, Vector2d(from.dot(ground.across), from.dot(ground.along)) / ground.side);
  }
};

TEST(ReferenceGround, LiesUnderTheModel) {
  for (const Vector3d& up : {Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(0.6, 0.64, 0.48)}) {
    const Ground ground = ground_under({1, 2, 3}, 0.5, up, -0.7);
    EXPECT_NEAR(ground.origin.dot(up), -0.7, 1e-14);
    EXPECT_NEAR(ground.side, 3.2, 1e-14);
    const Vector3d middle = ground.origin + 0.5 * ground.side * (ground.across + ground.along);
    EXPECT_LT((middle - Vector3d(1, 2, 3)).cross(up).norm(), 1e-14);  // straight below the centre
    EXPECT_LT((ground.along.cross(ground.across) + up).norm(), 1e-14);
  }
}

TEST(ReferenceGround, TheDarknessUnderAPlateFallsWithItsHeight) {
  for (const double height : {0.01, 0.05, 0.1, 0.2, 0.4}) {
    const Stage stage(height, Vector3d::UnitY());
    // e^(−height/.05 R); softening changes nothing so far from the edges.
    EXPECT_NEAR(stage.taken(0, 0).y(), std::exp(-height / 0.1), 1e-6) << height;  // depths are floats
    EXPECT_EQ(stage.taken(1.5, 0).y(), 0);
  }
}

TEST(ReferenceGround, TheShadowFallsAwayFromTheLight) {
  // 45° from +x: the shadow of what hangs .4 high lies .4 to −x.
  const Stage stage(0.4, Vector3d(1, 1, 0).normalized());
  EXPECT_NEAR(stage.taken(-0.4, 0).x(), 1, 1e-12);
  EXPECT_EQ(stage.taken(0.6, 0).x(), 0);
  EXPECT_EQ(stage.taken(0, 1.1).x(), 0);
  // Half of it on the edge, and across it the normal distribution with .035 R = 1.4 texels. .03: the sums
  // over texels, an edge that falls between two, and the cut at 2.5 of the wider one.
  const double width = 0.035 * 2;
  for (const double z : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
    const double expected = 0.5 * std::erfc(z / std::sqrt(2.0));
    EXPECT_NEAR(stage.taken(-0.4, 0.6 + z * width).x(), expected, 0.03) << z;
    EXPECT_NEAR(stage.taken(-0.4, -0.6 - z * width).x(), expected, 0.03) << z;
    EXPECT_NEAR(stage.taken(0.2 + z * width, 0).x(), expected, 0.03) << z;
    EXPECT_NEAR(stage.taken(-1 - z * width, 0).x(), expected, 0.03) << z;
  }
}

// --- the backdrop

// Straight down onto a floor at y = 0: the pixel's middle is the place on the floor.
Eigen::Matrix4d from_above(double half) {
  Eigen::Matrix4d view = Eigen::Matrix4d::Zero();
  view.row(0) = Eigen::RowVector4d(1 / half, 0, 0, 0);
  view.row(1) = Eigen::RowVector4d(0, 0, -1 / half, 0);
  view.row(2) = Eigen::RowVector4d(0, -0.1, 0, 0);  // near at y = 10
  view(3, 3) = 1;
  return view;
}

TEST(ReferenceBackdrop, IsTheBackgroundWithAVignetteAndHalfAStepOfNoise) {
  const Ground ground = ground_under(Vector3d::Zero(), 1, Vector3d::UnitY(), 0);
  const GroundMap empty{1, {Vector2d::Zero()}};
  constexpr int size = 64;
  const auto colours = backdrop({0.6, 0.5, 0.4}, from_above(3), ground, empty, size, size);
  double noise = 0;
  for (int line = 0; line < size; ++line)
    for (int column = 0; column < size; ++column) {
      const Vector2d u(((column + 0.5) / size) - 0.5, ((line + 0.5) / size) - 0.5);
      const Vector3d plain = Vector3d(0.6, 0.5, 0.4) * (1.06 - 0.45 * u.squaredNorm());
      const Vector3d own = colours[static_cast<std::size_t>(line * size + column)];
      EXPECT_LE(std::abs(own.x() / plain.x() - 1), 1.5 / 255 + 1e-12);
      EXPECT_NEAR(own.z() / plain.z(), own.x() / plain.x(), 1e-12);
      noise += own.x() / plain.x() - 1;
    }
  EXPECT_NEAR(noise / (size * size), 0, 1e-4);  // its mean over so many pixels
}

TEST(ReferenceBackdrop, TheFloorKeepsWhatTheMapTakes) {
  const Ground ground = ground_under(Vector3d::Zero(), 1, Vector3d::UnitY(), 0);
  const GroundMap empty{1, {Vector2d::Zero()}}, full{1, {Vector2d(0.8, 0.4)}};
  constexpr int size = 200;
  constexpr double half = 4;  // beyond the map's 3.2
  const auto ratio = [&](const Eigen::Matrix4d& view, int column, int line) {
    const auto i = static_cast<std::size_t>(line * size + column);
    return backdrop({1, 1, 1}, view, ground, full, size, size)[i].x() /
           backdrop({1, 1, 1}, view, ground, empty, size, size)[i].x();
  };
  EXPECT_NEAR(ratio(from_above(half), 100, 100), (1 - 0.4) * (1 - 0.22), 1e-12);
  EXPECT_EQ(ratio(from_above(half), 5, 100), 1);  // x = −3.78: outside of the map
  EXPECT_EQ(ratio(from_above(half), 100, 196), 1);
  // Half way in the fading rim, smoothstep's middle: .075 of 6.4 from the edge, x = −2.72.
  const double x = 2 * half * 32.5 / size - half, s = (x + 3.2) / 6.4 / 0.15;
  const double share = s * s * (3 - 2 * s);
  EXPECT_NEAR(ratio(from_above(half), 32, 100), (1 - 0.4 * share) * (1 - 0.22 * share), 1e-12);
  // From below there is no floor.
  Eigen::Matrix4d below = from_above(half);
  below.row(2) *= -1;
  EXPECT_EQ(ratio(below, 100, 100), 1);
}

}  // namespace
}  // namespace plisse::reference
