// Numbers of waves of fields that are given in closed form, on surfaces of every topology.
#include "wrinkle/wave_count.h"

#include <gtest/gtest.h>

#include <numbers>

#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::Grid;
constexpr double turn = 2 * std::numbers::pi;

// A flat rectangle without the faces whose centre lies in a hole; ω by its integral along each edge.
struct Sheet {
  Grid grid{1.2, 0.8, 36, 24};
  shell::Topology topology = shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols()));
  std::vector<FaceForms> forms = test::prescribed(grid, test::no_form, test::no_form);
  std::vector<bool> live = std::vector<bool>(grid.faces.size(), true);
  VectorXd amplitude = VectorXd::Constant(grid.rest.cols(), 1e-3);

  void hole(const Vector3d& centre, double radius) {
    for (std::size_t f = 0; f < live.size(); ++f)
      if ((grid.centre(grid.faces[f]) - centre).norm() < radius) live[f] = false;
  }
  WaveCount count(const std::function<double(const Vector3d&, const Vector3d&)>& difference) const {
    VectorXd form(static_cast<Eigen::Index>(topology.edges.size()));
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
      const auto& v = topology.edges[e].vertex;
      form[static_cast<Eigen::Index>(e)] = difference(grid.rest.col(v[0]), grid.rest.col(v[1]));
    }
    return count_waves(topology, forms, live, amplitude, form);
  }
};

const Vector3d left(0.3, 0.4, 0), right(0.9, 0.42, 0);
// The angle from one point to another as a centre sees it, radians.
double angle(const Vector3d& centre, const Vector3d& from, const Vector3d& to) {
  const Vector3d a = from - centre, b = to - centre;
  return std::atan2(a.cross(b).z(), a.dot(b));
}
// Seven and a half waves across the longer side.
double plane(const Vector3d& from, const Vector3d& to) {
  return turn * 7.5 / 1.2 * (to - from).x();
}

TEST(WaveCount, PlaneWavesWhateverTheHoles) {
  Sheet sheet;
  for (int holes = 0; holes <= 2; ++holes) {
    if (holes == 1) sheet.hole(left, 0.15);
    if (holes == 2) sheet.hole(right, 0.2);
    const WaveCount count = sheet.count(plane);
    EXPECT_NEAR(count.waves, 7.5, 1e-9) << holes;  // sums of a hundred numbers
    EXPECT_FALSE(count.round) << holes;
    EXPECT_GE(count.length, 1.2 * (1 - 1e-12)) << holes;
  }
}

TEST(WaveCount, WavesRoundHoles) {
  Sheet one;
  one.hole(left, 0.1);
  const WaveCount round =
      one.count([](const Vector3d& a, const Vector3d& b) { return 12 * angle(left, a, b); });
  EXPECT_NEAR(round.waves, 12, 1e-9);
  EXPECT_TRUE(round.round);
  // The shortest loop that meets them all is the hole's own rim, longer than its circle and shorter than a
  // square round that.
  EXPECT_GT(round.length, turn * 0.1);
  EXPECT_LT(round.length, 1.5 * 8 * 0.1);

  Sheet two = one;
  two.hole(right, 0.1);
  const auto both = [&](double n, double m) {
    return two.count(
        [&](const Vector3d& a, const Vector3d& b) { return n * angle(left, a, b) + m * angle(right, a, b); });
  };
  EXPECT_NEAR(both(12, 5).waves, 17, 1e-9);   // round both
  EXPECT_NEAR(both(12, -5).waves, 12, 1e-9);  // round one
  EXPECT_NEAR(both(0, 5).waves, 5, 1e-9);
}

// Phases that drift by a wave over the sheet besides.
TEST(WaveCount, WavesThatWindAndDrift) {
  Sheet sheet;
  sheet.hole(left, 0.1);
  EXPECT_NEAR(sheet
                  .count([](const Vector3d& a, const Vector3d& b) {
                    return 12 * angle(left, a, b) + turn * (b - a).y();
                  })
                  .waves,
              12, 1e-9);
}

TEST(WaveCount, OnlyWhatCanBeSeen) {
  Sheet sheet;
  for (Eigen::Index v = 0; v < sheet.amplitude.size(); ++v)
    if (sheet.grid.rest(0, v) > 0.6 + 1e-9) sheet.amplitude[v] = 1e-6;
  EXPECT_NEAR(sheet.count(plane).waves, 7.5 / 2, 1e-9);
  sheet.amplitude.setZero();
  EXPECT_EQ(sheet.count(plane).waves, 0);
}

// Above a tenth of the highest: waves that fade out toward a side are counted where they are worth it.
TEST(WaveCount, WhatIsAboveAShare) {
  Sheet sheet;
  for (Eigen::Index v = 0; v < sheet.amplitude.size(); ++v)
    sheet.amplitude[v] = 1e-3 * (sheet.grid.rest(0, v) > 0.6 + 1e-9 ? 0.05 : 1);
  VectorXd form(static_cast<Eigen::Index>(sheet.topology.edges.size()));
  for (std::size_t e = 0; e < sheet.topology.edges.size(); ++e) {
    const auto& v = sheet.topology.edges[e].vertex;
    form[static_cast<Eigen::Index>(e)] = plane(sheet.grid.rest.col(v[0]), sheet.grid.rest.col(v[1]));
  }
  const auto above = [&](double share) {
    return count_waves(sheet.topology, sheet.forms, sheet.live, sheet.amplitude, form, share).waves;
  };
  EXPECT_NEAR(above(0.01), 7.5, 1e-9);
  EXPECT_NEAR(above(0.1), 7.5 / 2, 1e-9);
  EXPECT_NEAR(wavelength_at_highest(sheet.topology, sheet.forms, sheet.live, sheet.amplitude, form),
              1.2 / 7.5, 1e-12);
}

// A torus, closed both ways: n waves round the long way, m round the short one.
TEST(WaveCount, ClosedSurfaces) {
  constexpr int around = 24, across = 12;
  const Grid grid(1.2, 0.4, around, across);
  std::vector<shell::Face> faces;
  for (shell::Face f : grid.faces) {
    for (auto& v : f) {
      const auto i = v % (around + 1) % around, j = v / (around + 1) % across;
      v = j * around + i;
    }
    faces.push_back(f);
  }
  const shell::Topology topology = shell::build_topology(faces, around * across);
  const auto forms = test::prescribed(grid, test::no_form, test::no_form);
  const std::vector<bool> live(faces.size(), true);
  const VectorXd amplitude = VectorXd::Constant(around * across, 1e-3);
  const auto count = [&](int n, int m) {
    VectorXd form(static_cast<Eigen::Index>(topology.edges.size()));
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
      const auto v = topology.edges[e].vertex;
      const auto step = [](std::uint32_t a, std::uint32_t b, int size) {
        return std::remainder(static_cast<double>(b) - static_cast<double>(a), size) / size;
      };
      form[static_cast<Eigen::Index>(e)] = turn * (n * step(v[0] % around, v[1] % around, around) +
                                                   m * step(v[0] / around, v[1] / around, across));
    }
    return count_waves(topology, forms, live, amplitude, form);
  };
  EXPECT_NEAR(count(101, 0).waves, 101, 1e-9);
  EXPECT_NEAR(count(101, 0).length, 1.2, 1e-9);
  EXPECT_NEAR(count(0, 31).waves, 31, 1e-9);
  EXPECT_NEAR(count(0, 31).length, 0.4, 1e-9);
  EXPECT_TRUE(count(101, 1).round);
  EXPECT_NEAR(count(101, 1).waves, 101, 1.001);  // one spiral crest; the loop may take the one wave along
}

}  // namespace
}  // namespace plisse::wrinkle
