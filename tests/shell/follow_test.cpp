// Base surfaces that follow a pose, against closed forms: what a ripple, a tube and a hem keep, and what
// stays as it is.
#include "shell/follow.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.h"

namespace plisse::shell {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

// columns × rows cells of a rectangle, cut along alternating diagonals; `around`: its left and right side are
// one.
struct Sheet {
  int columns, rows;
  double width, height;
  bool around;
  Topology topology;
  std::vector<RestFace> rest;
  Positions flat;  // of the open rectangle

  Sheet(double w, double h, int across, int up, bool closed = false)
      : columns(across), rows(up), width(w), height(h), around(closed), flat(3, (across + 1) * (up + 1)) {
    for (int j = 0; j <= up; ++j)
      for (int i = 0; i <= across; ++i)
        flat.col(j * (across + 1) + i) = Vector3d(w * i / across, h * j / up, 0);
    std::vector<Face> open, faces;
    for (int j = 0; j < up; ++j)
      for (int i = 0; i < across; ++i) {
        const auto a = static_cast<std::uint32_t>(j * (across + 1) + i), b = a + 1,
                   c = a + static_cast<std::uint32_t>(across) + 1, d = c + 1;
        if ((i + j) % 2 == 0) {
          open.push_back({a, b, d});
          open.push_back({a, d, c});
        } else {
          open.push_back({a, b, c});
          open.push_back({b, d, c});
        }
      }
    rest = rest_faces(flat, open);
    for (Face f : open) {
      for (auto& v : f) v = id(static_cast<int>(v) % (across + 1), static_cast<int>(v) / (across + 1));
      faces.push_back(f);
    }
    topology = build_topology(faces, static_cast<std::size_t>((closed ? across : across + 1) * (up + 1)));
  }
  std::uint32_t id(int i, int j) const {
    return static_cast<std::uint32_t>(around ? j * columns + i % columns : j * (columns + 1) + i);
  }
  Positions places(const std::function<Vector3d(double, double)>& at) const {
    Positions result(3, topology.vertex_count);
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i)
        result.col(id(i, j)) = at(width * (around ? i % columns : i) / columns, height * j / rows);
    return result;
  }
};

FollowSettings settings(double wavelength, int passes = 1) {
  FollowSettings result;
  result.wavelength = wavelength;
  result.passes = passes;
  result.tolerance = 1e-10;
  return result;
}

TEST(Follow, RestStaysAsItIs) {
  const Sheet sheet(1, 1, 16, 16);
  const Eigen::AngleAxisd turn(0.7, Vector3d(1, 2, 3).normalized());
  const Positions pose = (turn.toRotationMatrix() * sheet.flat).colwise() + Vector3d(5, -3, 2);
  const Followed flat = Follower(sheet.topology, sheet.rest, {}, settings(0.25, 2)).follow(pose);
  EXPECT_TRUE(flat.converged);
  EXPECT_LT(flat.moved_most,
            1e-9);  // rounding of places a few metres from the origin, times the stiffness' span

  // A rest shape that is curved keeps its curvature: here that of a cylinder as wide as Λ.
  const Sheet tube(2 * pi * 0.1, 0.5, 16, 10, true);
  const Positions round = tube.places(
      [](double u, double v) { return Vector3d(0.1 * std::cos(u / 0.1), v, 0.1 * std::sin(u / 0.1)); });
  const auto rest = rest_faces(round, tube.topology.faces);
  const Positions moved = (turn.toRotationMatrix() * round).colwise() + Vector3d(1, 1, 1);
  const Followed kept = Follower(tube.topology, rest, round, settings(0.3)).follow(moved);
  EXPECT_TRUE(kept.converged);
  EXPECT_LT(kept.moved_most, 1e-9);
  // Without, it shrinks.
  EXPECT_GT(Follower(tube.topology, rest, {}, settings(0.3)).follow(moved).moved_most, 0.005);
}

TEST(Follow, NoWavelengthIsThePoseItself) {
  const Sheet sheet(1, 1, 6, 6);
  const Positions pose =
      sheet.places([](double u, double v) { return Vector3d(u, v, 0.1 * std::sin(9 * u)); });
  const Followed followed = Follower(sheet.topology, sheet.rest, {}, settings(0)).follow(pose);
  EXPECT_TRUE(followed.converged);
  EXPECT_EQ(followed.base, pose);
}

// 1/(1 + (Λ/λ)⁴), where heights are so small that tension has no part in it.
TEST(Follow, RipplesKeepTheirShare) {
  for (const double share : {0.5, 1.0, 2.0}) {
    const double wave = 0.25, follow = share * wave, height = 1e-7;
    const Sheet sheet(2, 0.25, 128, 16);
    const Positions pose = sheet.places(
        [&](double u, double v) { return Vector3d(u, v, height * std::cos(2 * pi * (u - 1) / wave)); });
    const Followed followed = Follower(sheet.topology, sheet.rest, {}, settings(follow)).follow(pose);
    ASSERT_TRUE(followed.converged);
    const double kept = followed.base(2, sheet.id(64, 8)) / height, expected = 1 / (1 + std::pow(share, 4));
    // 16 edges a wave: the discrete Laplacian is 1 % low, its square 3 %.
    EXPECT_NEAR(kept / expected, 1, 0.04) << share;
  }
}

// A sleeve sewn from flat panels: g = 1/(1 + (Λ/circumference)⁴) of its radius in one pass, 1 − (1 − g)² in
// two.
TEST(Follow, TubesKeepTheirRadiusInTwoPasses) {
  for (const int edges : {12, 16, 24}) {
    const double radius = 0.1, circumference = 2 * pi * radius, side = circumference / edges;
    const Sheet tube(circumference, 40 * side, edges, 40, true);
    const Positions pose = tube.places([&](double u, double v) {
      return Vector3d(radius * std::cos(u / radius), v, radius * std::sin(u / radius));
    });
    const double g = 1 / (1 + std::pow(8.0 / edges, 4));
    for (const int passes : {1, 2}) {
      const Followed followed =
          Follower(tube.topology, tube.rest, {}, settings(8 * side, passes)).follow(pose);
      ASSERT_TRUE(followed.converged);
      const Vector3d middle = followed.base.col(tube.id(0, 20));
      const double kept = std::hypot(middle.x(), middle.z()) / radius;
      // The discrete Laplacian of 12 edges round is 2 % low.
      EXPECT_NEAR(kept, passes == 1 ? g : 1 - (1 - g) * (1 - g), 0.03) << edges << ' ' << passes;
      // The free ends as the middle: they do not flare, though their strip bends as a curve does.
      for (Eigen::Index v = 0; v < followed.base.cols(); ++v)
        EXPECT_NEAR(std::hypot(followed.base(0, v), followed.base(2, v)) / radius, kept, 0.03) << edges;
    }
  }
}

// What the mesh cannot carry: every other vertex out of place, inside and along the hem, by a third of an
// edge.
TEST(Follow, ZigzagsGo) {
  const Sheet sheet(1, 1, 20, 20);
  const Positions pose = sheet.places([](double u, double v) {
    const int i = static_cast<int>(std::lround(20 * u)), j = static_cast<int>(std::lround(20 * v));
    return Vector3d(0.9 * u, v, ((i + j) % 2 == 0 ? 1 : -1) * 0.015);
  });
  const Followed followed = Follower(sheet.topology, sheet.rest, {}, settings(0.4)).follow(pose);
  ASSERT_TRUE(followed.converged);
  double inside = 0, hem = 0;
  for (int j = 0; j <= 20; ++j)
    for (int i = 0; i < 20; ++i) {
      const double step = std::abs(followed.base(2, sheet.id(i + 1, j)) - followed.base(2, sheet.id(i, j)));
      (j == 0 || j == 20 ? hem : inside) = std::max(j == 0 || j == 20 ? hem : inside, step);
    }
  EXPECT_LT(inside, 0.05 * 0.03);  // of what it was
  EXPECT_LT(hem, 0.15 * 0.03);
}

// A rig's stretch: 40 % over the middle third, which cloth would not do. A base that takes it for tension
// pulls the rest of the sheet in; with the limit it stays where the rig has it.
TEST(Follow, RigsThatStretchHardlyMove) {
  const Sheet sheet(1, 1, 24, 24);
  const Positions pose = sheet.places(
      [](double u, double v) { return Vector3d(u + 0.4 * std::clamp(u - 1.0 / 3, 0.0, 1.0 / 3), v, 0); });
  FollowSettings free = settings(0.3), limited = free;
  free.tension_limit = 0;
  const Followed far = Follower(sheet.topology, sheet.rest, {}, free).follow(pose),
                 near = Follower(sheet.topology, sheet.rest, {}, limited).follow(pose);
  ASSERT_TRUE(far.converged && near.converged);
  EXPECT_LT(near.moved_rms, 0.2 * far.moved_rms);  // the limit is an eighth or less of the strain .96
}

// E is convex: the same base from the pose, from far off and from a crumpled heap.
TEST(Follow, OneBaseWhateverTheStart) {
  const Sheet sheet(1, 1, 20, 20);
  const Positions pose = sheet.places([](double u, double v) {
    return Vector3d(0.8 * u + 0.05 * std::sin(9 * v), v, 0.05 * std::sin(20 * u) * std::cos(7 * v));
  });
  std::vector<bool> held(sheet.topology.vertex_count, false);
  held[sheet.id(0, 0)] = held[sheet.id(20, 20)] = true;
  FollowSettings own = settings(0.3, 2);
  own.tolerance = FollowSettings().tolerance;
  const Follower follower(sheet.topology, sheet.rest, {}, own, held);
  const Followed smoothed = follower.follow(pose);
  const Positions away = sheet.places([](double u, double v) { return Vector3d(3 * v, 2 - u, 1); }),
                  heap = sheet.places([](double u, double v) {
                    return Vector3d(std::sin(400 * u + 90 * v), std::sin(300 * v), std::cos(777 * u * v));
                  });
  ASSERT_TRUE(smoothed.converged);
  EXPECT_EQ(smoothed.base.col(sheet.id(20, 20)), pose.col(sheet.id(20, 20)));  // held
  EXPECT_GT(smoothed.moved_most, 0.01);
  for (const Positions* start : {&pose, &away, &heap}) {
    const Followed other = follower.follow(pose, start);
    ASSERT_TRUE(other.converged);
    EXPECT_LT((other.base - smoothed.base).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// The membrane is the stiffer, the finer the mesh: steps hardly depend on it, since the metric knows it.
TEST(Follow, StepsDoNotGrowWithTheMesh) {
  int few = 0;
  for (const int cells : {12, 24, 48}) {
    const Sheet sheet(1, 1, cells, cells);
    const Positions pose = sheet.places([](double u, double v) {
      return Vector3d(0.85 * u + 0.1 * v * v, v, 0.05 * std::sin(12 * u) * std::cos(5 * v));
    });
    const Followed followed = Follower(sheet.topology, sheet.rest, {}, settings(0.3, 2)).follow(pose);
    ASSERT_TRUE(followed.converged);
    if (cells == 12) few = followed.iterations;
    EXPECT_LE(followed.iterations, few + 5);  // some more or less of thirty
  }
}

TEST(Follow, SaysWhatDoesNotFit) {
  const Sheet sheet(1, 1, 4, 4);
  const Follower follower(sheet.topology, sheet.rest, {}, settings(0.3));
  EXPECT_THROW(follower.follow(Positions::Zero(3, 7)), Error);
  Positions pose = sheet.flat;
  pose(1, 3) = std::nan("");
  EXPECT_THROW(follower.follow(pose), Error);
  EXPECT_THROW(Follower(sheet.topology, {}, {}, settings(0.3)), Error);
}

}  // namespace
}  // namespace plisse::shell
