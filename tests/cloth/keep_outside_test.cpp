// Base surfaces that stay outside bodies.
#include "cloth/keep_outside.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plisse::cloth {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr int cells = 16;
constexpr double side = 0.4;

// A square sheet in right-angled triangles.
struct Sheet {
  Sheet() : rest(3, (cells + 1) * (cells + 1)) {
    std::vector<shell::Face> faces;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i)
        rest.col(j * (cells + 1) + i) =
            Vector3d(side * (double(i) / cells - 0.5), 0, side * (0.5 - double(j) / cells));
    for (std::uint32_t j = 0; j < cells; ++j)
      for (std::uint32_t i = 0; i < cells; ++i) {
        const std::uint32_t a = j * (cells + 1) + i, up = a + cells + 1;
        faces.push_back({a, a + 1, up + 1});
        faces.push_back({a, up + 1, up});
      }
    topology = shell::build_topology(std::move(faces), static_cast<std::size_t>(rest.cols()));
    flat = shell::rest_faces(rest, topology.faces);
  }
  // Each vertex at a height.
  template <typename Height>
  shell::Positions raised(const Height& height) const {
    shell::Positions pose = rest;
    for (Index v = 0; v < pose.cols(); ++v) pose(1, v) = height(pose(0, v), pose(2, v), v);
    return pose;
  }
  shell::Positions rest;
  shell::Topology topology;
  std::vector<shell::RestFace> flat;
};

// A ball of many facets, all corners on the sphere.
shell::TriangleBody ball(double radius, const Vector3d& middle) {
  constexpr int round = 64, up = 32;
  std::vector<Vector3d> points{middle + Vector3d(0, radius, 0)};
  for (int j = 1; j < up; ++j)
    for (int i = 0; i < round; ++i) {
      const double a = pi * j / up, b = 2 * pi * i / round;
      points.push_back(middle +
                       radius * Vector3d(std::sin(a) * std::cos(b), std::cos(a), -std::sin(a) * std::sin(b)));
    }
  points.push_back(middle - Vector3d(0, radius, 0));
  std::vector<TriangleTree::Triangle> triangles;
  const auto id = [](int j, int i) { return static_cast<std::uint32_t>(1 + (j - 1) * round + i % round); };
  const auto last = static_cast<std::uint32_t>(points.size() - 1);
  for (int i = 0; i < round; ++i) {
    triangles.push_back({0, id(1, i), id(1, i + 1)});
    triangles.push_back({id(up - 1, i), last, id(up - 1, i + 1)});
    for (int j = 1; j + 1 < up; ++j) {
      triangles.push_back({id(j, i), id(j + 1, i), id(j + 1, i + 1)});
      triangles.push_back({id(j, i), id(j + 1, i + 1), id(j, i + 1)});
    }
  }
  Eigen::Matrix3Xd columns(3, static_cast<Index>(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) columns.col(static_cast<Index>(p)) = points[p];
  return {std::move(columns), std::move(triangles), "ball"};
}

shell::FollowSettings settings() {
  shell::FollowSettings result;
  result.wavelength = 0.2;
  return result;
}

// A sheet in zigzags that lies on a ball, and falls off beside it: smoothed it would cut through.
TEST(KeepOutside, TheWholeSurfaceStaysOutside) {
  const Sheet sheet;
  constexpr double radius = 0.1, gap = 1e-3;
  const shell::TriangleBody body = ball(radius, Vector3d(0, -radius, 0));
  const shell::Positions pose = sheet.raised([&](double x, double z, Index v) {
    const double from = std::hypot(x, z), zigzag = (v % 2 == 0 ? 1 : -1) * 2e-3;
    const double on =
        from < 0.07 ? std::sqrt(radius * radius - from * from) - radius : -0.029 - (from - 0.07);
    return on + 4e-3 + zigzag;
  });
  const shell::Follower follower(sheet.topology, sheet.flat, {}, settings());
  const ShellPoints points(sheet.topology, sheet.flat);
  const Bodies bodies{&body};
  const Clearance clearance(points, pose, bodies);
  const auto nearest = [&](const shell::Positions& base) {
    double least = INFINITY;
    const Eigen::Matrix3Xd all = points.at(base);
    for (Index k = 0; k < all.cols(); ++k) least = std::min(least, body.distance(all.col(k)).value);
    return least;
  };
  EXPECT_LT(nearest(follower.follow(pose).base), -2e-3);  // it would
  const KeptOutside kept = follow_outside(follower, points, pose, clearance, bodies, gap, {});
  EXPECT_TRUE(kept.followed.converged);
  EXPECT_TRUE(kept.outside);
  EXPECT_GT(nearest(kept.followed.base), 0.7 * gap);
  // Not more than has to be: somewhere it lies at the gap.
  EXPECT_LT(nearest(kept.followed.base), 1.3 * gap);
  // Lifted by what waves want, here 5 mm: its vertices are that much further away.
  const KeptOutside lifted = follow_outside(follower, points, pose, clearance, bodies, gap,
                                            Eigen::VectorXd::Constant(pose.cols(), 5e-3));
  EXPECT_TRUE(lifted.followed.converged);
  for (Index v = 0; v < pose.cols(); ++v)
    EXPECT_GT(body.distance(lifted.followed.base.col(v)).value, 5e-3 + 0.7 * gap);
}

// A body that rises out of a plane: the minimum, whatever the search, presses with the half-spaces of the
// pose alone; a sheet beside a flat body keeps its own shape where it does not touch.
TEST(KeepOutside, WhatIsFarIsAsWithoutABody) {
  const Sheet sheet;
  const shell::TriangleBody body = ball(0.1, Vector3d(0, -0.5, 0));
  const shell::Positions pose = sheet.raised(
      [](double x, double, Index v) { return 0.02 * std::sin(20 * x) + (v % 2 == 0 ? 1e-3 : -1e-3); });
  const shell::Follower follower(sheet.topology, sheet.flat, {}, settings());
  const ShellPoints points(sheet.topology, sheet.flat);
  const Bodies bodies{&body};
  const Clearance clearance(points, pose, bodies);
  const KeptOutside kept = follow_outside(follower, points, pose, clearance, bodies, 1e-3, {});
  EXPECT_EQ(kept.followed.base, follower.follow(pose).base);
  double nearest = 0.05;
  for (const double room : room_of(points, clearance, kept.followed.base, bodies, 0.05, nearest))
    EXPECT_EQ(room, INFINITY);
  EXPECT_EQ(nearest, 0.05);
}

// A sheet half in a body is brought out, and the room over it is what lies between.
TEST(KeepOutside, RoomIsTheDistance) {
  const Sheet sheet;
  const shell::TriangleBody body = ball(0.3, Vector3d(0, -0.3, 0));
  const shell::Positions pose = sheet.raised([](double x, double z, Index) {
    return std::sqrt(0.3 * 0.3 - x * x - z * z) - 0.3 - 2e-3;  // 2 mm inside everywhere
  });
  const shell::Follower follower(sheet.topology, sheet.flat, {}, settings());
  const ShellPoints points(sheet.topology, sheet.flat);
  const Bodies bodies{&body};
  const Clearance clearance(points, pose, bodies);
  EXPECT_LT(clearance.distance[0], 0);
  const KeptOutside kept = follow_outside(follower, points, pose, clearance, bodies, 1e-3, {});
  EXPECT_TRUE(kept.followed.converged && kept.outside);
  double nearest = 1;
  const std::vector<double> room = room_of(points, clearance, kept.followed.base, bodies, 1, nearest);
  EXPECT_GT(nearest, 0.7e-3);
  for (Index v = 0; v < pose.cols(); ++v) {
    const double away = body.distance(kept.followed.base.col(v)).value;
    EXPECT_LE(room[static_cast<std::size_t>(v)], away);
    EXPECT_GE(room[static_cast<std::size_t>(v)], nearest);
  }
}

}  // namespace
}  // namespace plisse::cloth
