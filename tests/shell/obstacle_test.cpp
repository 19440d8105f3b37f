// Solid bodies: distances in closed form, the barrier round them, ways that lead through, bodies that move.
#include "shell/obstacle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell/carry.h"
#include "shell/meshes.h"
#include "support/errors.h"

namespace plisse::shell {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
using Number = Eigen::Matrix<double, 1, 1>;

Vector3d random_point(std::mt19937& engine, double size) {
  std::normal_distribution<double> normal;
  const double x = normal(engine), y = normal(engine), z = normal(engine);
  return size * Vector3d(x, y, z);
}

Body body_of(const test::Mesh& mesh) {
  return std::make_shared<TriangleBody>(mesh.positions, mesh.faces, "body");
}

double box_distance(const Vector3d& half, const Vector3d& p) {
  const Vector3d q = p.cwiseAbs() - half;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(ShellObstacle, DistancesAndTheirDerivatives) {
  std::mt19937 engine(2);
  const std::vector<Obstacle> bodies = {Sphere{{0.1, 0.2, 0.3}, 0.5}, Plane{{0, 1, 0}, Vector3d(1, 2, 2) / 3},
                                        Capsule{{-1, 0, 0}, {1, 0.5, 0}, 0.2},
                                        Cylinder{{-1, 0, 0}, {1, 0.5, 0}, 0.6}};
  EXPECT_NEAR(distance(bodies[0], {0.1, 0.2, 1.3}).value, 0.5, 1e-15);
  EXPECT_NEAR(distance(bodies[1], {3, 1, 0}).value, 1, 1e-15);
  EXPECT_NEAR(distance(bodies[2], {-2, 0, 0}).value, 0.8, 1e-15);
  const Obstacle upright = Cylinder{{0, 0, 0}, {0, 2, 0}, 1};
  EXPECT_NEAR(distance(upright, {3, 1, 0}).value, 2, 1e-15);
  EXPECT_NEAR(distance(upright, {0.2, 2.5, 0}).value, 0.5, 1e-15);
  EXPECT_NEAR(distance(upright, {4, 6, 0}).value, 5, 1e-15);  // off the rim
  EXPECT_NEAR(distance(upright, {0.2, 0.1, 0}).value, -0.1, 1e-15);
  EXPECT_NEAR(distance(upright, {0.9, 1, 0}).value, -0.1, 1e-15);
  for (const Obstacle& body : bodies)
    for (int trial = 0; trial < 20; ++trial) {
      const Vector3d at = random_point(engine, 2);
      const Distance d = distance(body, at);
      if (std::holds_alternative<Cylinder>(body) && d.value < 0.2) continue;  // it has kinks inside
      test::expect_derivative([&](const Vector3d& x) { return Number(distance(body, x).value); },
                              [&](const Vector3d& way) { return Number(d.first.dot(way)); }, at, 0.02,
                              engine);
      if (d.second.norm() > 0) {
        test::expect_derivative([&](const Vector3d& x) { return distance(body, x).first; },
                                [&](const Vector3d& way) { return Vector3d(d.second * way); }, at, 0.02,
                                engine);
      }
    }
}

// Whatever the list of kinds has, as scene files make it.
TEST(ShellObstacle, EachKindOfTheListKeepsItsPromises) {
  std::mt19937 engine(12);
  const SolidShape shape{{0.1, 0.2, -0.3}, {0.4, 0.8, 0.6}, Vector3d(1, 2, 2) / 3, 0.5};
  int convex = 0;
  for (const ObstacleKind& kind : obstacle_kinds()) {
    if (!kind.make) continue;
    ++convex;
    SCOPED_TRACE(kind.words.name);
    const Obstacle solid = kind.make(shape);
    for (int trial = 0; trial < 40; ++trial) {
      const Vector3d at = shape.at + random_point(engine, 1.5);
      const Distance d = distance(solid, at);
      // Inside there are kinks, and so near to the surface that differences reach them.
      if (d.value > 0.1) {
        EXPECT_NEAR(d.first.norm(), 1, 1e-14);
        // The nearest point of the surface is where the way out leads back to.
        EXPECT_NEAR(distance(solid, at - d.value * d.first).value, 0, 1e-14);
        test::expect_derivative([&](const Vector3d& x) { return Number(distance(solid, x).value); },
                                [&](const Vector3d& way) { return Number(d.first.dot(way)); }, at, 0.002,
                                engine);
        if (d.second.norm() > 0) {
          test::expect_derivative([&](const Vector3d& x) { return distance(solid, x).first; },
                                  [&](const Vector3d& way) { return Vector3d(d.second * way); }, at, 0.002,
                                  engine);
        }
        // Convex: distance is a convex function.
        const Vector3d other = shape.at + random_point(engine, 1.5);
        EXPECT_LE(distance(solid, 0.5 * (at + other)).value,
                  0.5 * (d.value + distance(solid, other).value) + 1e-14);
      }
      // As far as it is off any way is free; straight on, none leads out at the other side.
      const Vector3d way = random_point(engine, 1).normalized();
      if (d.value > 0.1) {
        EXPECT_EQ(free_way(solid, at, at + 0.999 * d.value * way), 1);
        const Vector3d through = -(d.value + 10) * d.first;
        const double share = free_way(solid, at, at + through);
        EXPECT_LE(distance(solid, at + share * through).value, 1e-13);
      }
      // What sticks to it goes along.
      SolidShape there = shape;
      const Vector3d shift(0.3, -0.1, 0.2);
      there.at += shift;
      there.to += shift;
      EXPECT_LT((carried_along(solid, kind.make(there), at) - at - shift).norm(), 1e-14);
    }
  }
  EXPECT_GE(convex, 4);
}

TEST(ShellObstacle, BarrierIsSmoothAndInfinite) {
  const double gap = 0.01;
  EXPECT_TRUE(std::isinf(barrier(0, gap).value));
  EXPECT_TRUE(std::isinf(barrier(-1, gap).value));
  EXPECT_EQ(barrier(gap, gap).second, 0);
  EXPECT_NEAR(barrier(gap * (1 - 1e-9), gap).second, 0, 1e-6);  // 4 · 1e-9 and smaller terms
  for (const double d : {0.001, 0.005, 0.009}) {
    const double step = 1e-7 * gap;
    EXPECT_NEAR((barrier(d + step, gap).value - barrier(d - step, gap).value) / (2 * step),
                barrier(d, gap).first, 1e-6 * std::abs(barrier(d, gap).first));
    EXPECT_NEAR((barrier(d + step, gap).first - barrier(d - step, gap).first) / (2 * step),
                barrier(d, gap).second, 1e-6 * barrier(d, gap).second);
  }
}

// A box's distance is known everywhere, its edges and corners included.
TEST(ShellObstacle, TrianglesOfABox) {
  std::mt19937 engine(3);
  const Vector3d size(1, 2, 0.5);
  test::Mesh mesh = test::box(size);
  const Body outward = body_of(mesh);
  for (Face& face : mesh.faces) std::swap(face[0], face[1]);
  const Body inward = body_of(mesh);  // wound the other way it is the same body
  int inside = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Vector3d p = random_point(engine, 0.7);
    const double expected = box_distance(0.5 * size, p);
    if (expected < 0) ++inside;
    EXPECT_NEAR(outward->distance(p).value, expected, 1e-12);
    EXPECT_NEAR(inward->distance(p).value, expected, 1e-12);
    // Convex: what is summed over faces, edges and vertices is the nearest one's barrier alone.
    const Contact contact = outward->contact(p, 0.4, true);
    if (expected <= 0) {
      EXPECT_TRUE(std::isinf(contact.value));
    } else {
      EXPECT_NEAR(contact.value, barrier(expected, 0.4).value, 1e-12);
    }
  }
  EXPECT_GT(inside, 30);
}

// A thin spike, where the nearest face's own normal has the wrong sign for many points.
TEST(ShellObstacle, SignsAtASpike) {
  test::Mesh mesh;
  mesh.positions.resize(3, 4);
  mesh.positions << 0, 0.1, -0.05, -0.05, 0, 0, 0.08, -0.08, 2, 0, 0, 0;
  mesh.faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const Body body = body_of(mesh);
  std::mt19937 engine(4);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d p = Vector3d(0, 0, 2.0) + random_point(engine, 0.3);
    Eigen::Matrix4d corners;
    corners << mesh.positions, Eigen::RowVector4d::Ones();
    const Eigen::Vector4d weights = corners.fullPivLu().solve(p.homogeneous());
    EXPECT_EQ(body->distance(p).value<0, weights.minCoeff()> 0);
  }
  EXPECT_GT(body->distance({0, 0, 2.01}).value, 0);
  EXPECT_LT(body->distance({0, 0, 1.9}).value, 0);
}

// Two boxes that make an L: in its hollow distance has a kink, the barrier has none.
TEST(ShellObstacle, BarrierAboveAHollow) {
  test::Mesh mesh;
  mesh.positions.resize(3, 12);
  const double outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (int v = 0; v < 12; ++v)
    mesh.positions.col(v) << outline[v % 6][0], outline[v % 6][1], v < 6 ? 0.0 : 1.0;
  for (std::uint32_t k = 0; k < 6; ++k) {
    const std::uint32_t next = (k + 1) % 6;
    mesh.faces.push_back({k, next, next + 6});
    mesh.faces.push_back({k, next + 6, k + 6});
  }
  const Face tops[4] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  for (const Face& top : tops) {
    mesh.faces.push_back({top[0] + 6, top[1] + 6, top[2] + 6});
    mesh.faces.push_back({top[0], top[2], top[1]});
  }
  const Body body = body_of(mesh);
  const double gap = 0.5;
  std::mt19937 engine(5);
  for (const Vector3d& at : {Vector3d(1.3, 1.3, 0.5), Vector3d(1.3, 1.31, 0.4), Vector3d(1.2, 1.4, 1.1),
                             Vector3d(2.2, 1.1, 0.3), Vector3d(0.9, 2.2, -0.1), Vector3d(1.7, 1.3, 0.6)}) {
    const Contact contact = body->contact(at, gap, true);
    EXPECT_GT(contact.value, 0);
    test::expect_derivative([&](const Vector3d& x) { return Number(body->contact(x, gap, false).value); },
                            [&](const Vector3d& way) { return Number(contact.first.dot(way)); }, at, 0.02,
                            engine);
    test::expect_derivative([&](const Vector3d& x) { return body->contact(x, gap, false).first; },
                            [&](const Vector3d& way) { return Vector3d(contact.second * way); }, at, 0.02,
                            engine);
  }
  // Both sides push where both are near.
  EXPECT_NEAR(body->contact({1.3, 1.3, 0.5}, gap, false).value,
              2 * barrier(0.3, gap).value - barrier(0.3 * std::sqrt(2), gap).value, 1e-12);
}

TEST(ShellObstacle, NoWayLeadsThrough) {
  std::mt19937 engine(6);
  const test::Mesh mesh = test::ball(0.5, 12);
  const std::vector<Obstacle> bodies = {Sphere{{0, 0, 0}, 0.5}, Cylinder{{0, 0, -0.4}, {0, 0, 0.4}, 0.4},
                                        Capsule{{0, 0, -0.3}, {0, 0, 0.3}, 0.2}, body_of(mesh)};
  for (const Obstacle& body : bodies)
    for (int trial = 0; trial < 200; ++trial) {
      const Vector3d from = random_point(engine, 1), to = random_point(engine, 1);
      if (distance(body, from).value <= 0) continue;
      const double share = free_way(body, from, to);
      ASSERT_GT(share, 0);
      ASSERT_LE(share, 1);
      // As far as it may go it is outside, or has come in and shows it: it is not out at the other side.
      bool been_inside = false;
      for (int k = 1; k <= 200; ++k) {
        const bool inside = distance(body, from + share * k / 200.0 * (to - from)).value < -1e-3;
        EXPECT_FALSE(been_inside && !inside && distance(body, from + share * (to - from)).value > 0);
        been_inside |= inside;
      }
    }
}

TEST(ShellObstacle, BodiesMustBeClosed) {
  test::Mesh mesh = test::box({1, 1, 1});
  mesh.faces.pop_back();
  EXPECT_THAT(plisse::test::error_of([&] { body_of(mesh); }),
              testing::AllOf(HasSubstr("body: is open at the edge between vertices 3 and 5")));
  mesh = test::box({1, 1, 0});
  EXPECT_THAT(plisse::test::error_of([&] { body_of(mesh); }), HasSubstr("has no inside"));
  mesh = test::box({1, 1, 1});
  std::swap(mesh.faces[3][0], mesh.faces[3][1]);
  EXPECT_NE(plisse::test::error_of([&] { body_of(mesh); }), "");
}

// Cloth beside a moving body: vertices in contact stay in contact, and the body overtakes no near ones.
TEST(ShellObstacle, ClothGoesWithABodyThatMoves) {
  test::Mesh cloth = test::grid(20, 20, 1, 1);
  cloth.positions.colwise() -= Vector3d(0.5, 0.5, 0);
  const Conditions conditions(static_cast<std::size_t>(cloth.positions.cols()));
  const test::Mesh ball = test::ball(0.2, 20);
  const auto at = [&](double z) {
    test::Mesh moved = ball;
    moved.positions.row(2).array() += z;
    return std::vector<Obstacle>{body_of(moved), Sphere{{0.3, 0.3, z}, 0.1}};
  };
  const auto nearest = [](const std::vector<Obstacle>& bodies, const Positions& x) {
    double least = 1;
    for (const Obstacle& body : bodies)
      for (Eigen::Index v = 0; v < x.cols(); ++v) least = std::min(least, distance(body, x.col(v)).value);
    return least;
  };
  const auto before = at(-0.201), after = at(-0.15);
  ASSERT_NEAR(nearest(before, cloth.positions), 1e-3, 1e-9);
  const auto moved = followed(before, after, conditions, cloth.positions);
  ASSERT_TRUE(moved);
  EXPECT_GE(nearest(after, *moved), 0.2e-3);  // what is promised of 1e-3; two bodies push at some
  EXPECT_LT(nearest(after, *moved), 1.5e-3);
  EXPECT_LT((*moved - cloth.positions).cwiseAbs().maxCoeff(), 0.0511);  // no farther than the bodies
  EXPECT_FALSE(
      followed(before, at(0.3), conditions, cloth.positions));  // through it at once: it would be lost
}

}  // namespace
}  // namespace plisse::shell
