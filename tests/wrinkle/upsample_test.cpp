// Up-sampled fields against waves whose shape is known: what is linear stays exact, whatever jumps and holes;
// what is displaced lies where (19) says, and is as long as its rest shape.
#include "wrinkle/upsample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/measure_waves.h"
#include "support/errors.h"
#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;
using test::Grid;
constexpr double pi = std::numbers::pi, turn = 2 * pi;

// Inner vertices of a grid of cells moved at random by up to a fifth of a cell.
Grid irregular(double width, double height, int columns, int rows) {
  Grid grid(width, height, columns, rows);
  std::mt19937 random(7);
  const auto share = [&] { return 0.4 * (static_cast<double>(random()) / 4294967295 - 0.5); };
  for (int j = 1; j < rows; ++j) {
    for (int i = 1; i < columns; ++i)
      grid.rest.col(j * (columns + 1) + i) += Vector3d(share() * width / columns, share() * height / rows, 0);
  }
  return grid;
}

Vector3d stay(const Vector3d& x) {
  return x;
}

// Amplitude a and φ = k·x, with a whole number of turns added to each face.
CoarseField plane_wave(const BaseSurface& surface, double a, const Vector3d& k, bool jumps = true) {
  CoarseField field;
  field.amplitude = Eigen::VectorXd::Constant(surface.positions.cols(), a);
  std::mt19937 random(3);
  for (const shell::Face& t : surface.topology.faces) {
    const double offset = jumps ? turn * (static_cast<int>(random() % 7) - 3) : 0;
    auto& phase = field.phase.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) phase[c] = k.dot(surface.positions.col(t[c])) + offset;
  }
  return field;
}

TEST(Upsample, PlaneWaveIsExactWhateverItsJumps) {
  const BaseSurface surface = test::moved(irregular(1, 0.6, 7, 5), stay);
  const Vector3d k(23, -9, 0);
  const double a = 2e-3;
  for (const int levels : {0, 1, 3}) {
    const FineField fine = upsample(surface, plane_wave(surface, a, k), levels);
    ASSERT_EQ(fine.faces.size(), surface.topology.faces.size() << (2 * levels));
    const shell::Positions moved = displaced(fine);
    for (Index v = 0; v < moved.cols(); ++v) {
      const Vector3d x = fine.positions.col(v);
      const double phase = k.dot(x);
      // Rounding of phases up to 1e2.
      EXPECT_NEAR(std::remainder(fine.phase[v] - phase, turn), 0, 1e-11);
      EXPECT_NEAR((fine.gradient.col(v) - k).norm(), 0, 1e-9);
      EXPECT_NEAR((fine.normals.col(v) - Vector3d::UnitZ()).norm(), 0, 1e-12);
      const Vector3d expected = x + a * std::cos(phase) * Vector3d::UnitZ() +
                                tangential_shift(a * k.norm()) * a * a * std::sin(2 * phase) * k;
      EXPECT_NEAR((moved.col(v) - expected).norm(), 0, 1e-12);
    }
  }
  // The rectangle keeps its corners.
  const FineField fine = upsample(surface, plane_wave(surface, a, k), 2);
  for (const double x : {0.0, 1.0}) {
    for (const double y : {0.0, 0.6})
      EXPECT_LT((fine.positions.colwise() - Vector3d(x, y, 0)).colwise().norm().minCoeff(), 1e-12);
  }
}

// The mesh's triangles approach the wave that its vertices lie on: a quarter of the distance a level.
TEST(Upsample, TrianglesConvergeToTheWaveAtSecondOrder) {
  const BaseSurface surface = test::moved(irregular(1, 0.6, 7, 5), stay);
  const Vector3d k(31, 12, 0);
  const double a = 2e-3;
  double before = 0;
  for (const int levels : {2, 3, 4, 5}) {
    const FineField fine = upsample(surface, plane_wave(surface, a, k), levels);
    const shell::Positions moved = displaced(fine, false);  // so that the wave is a graph over the plane
    double squares = 0;
    for (const shell::Face& t : fine.faces) {
      const Vector3d middle = (moved.col(t[0]) + moved.col(t[1]) + moved.col(t[2])) / 3;
      squares += std::pow(middle.z() - a * std::cos(k.dot(Vector3d(middle.x(), middle.y(), 0))), 2);
    }
    const double error = std::sqrt(squares / static_cast<double>(fine.faces.size()));
    if (levels > 3) {
      EXPECT_NEAR(std::log2(before / error), 2, 0.1) << levels;
    }
    before = error;
  }
}

// Vertices are on the limit surface at once: more levels add vertices and move none.
TEST(Upsample, MoreLevelsMoveNothing) {
  const Grid grid = irregular(1, 0.6, 7, 5);
  const BaseSurface surface =
      test::moved(grid, [](const Vector3d& x) { return Vector3d(std::sin(x.x()), x.y(), std::cos(x.x())); });
  const CoarseField field = plane_wave(surface, 5e-3, {4, 20, 3});
  const FineField one = upsample(surface, field, 1), three = upsample(surface, field, 3);
  const shell::Positions first = displaced(one), last = displaced(three);
  for (Index v = 0; v < first.cols(); ++v) {
    // On outlines OpenSubdiv's tangents are only near the limit's where a vertex has not three faces.
    const double x = one.positions(0, v), y = one.positions(1, v);
    if (std::min({x, std::sin(1) - x, y, 0.6 - y}) < 1e-9) continue;
    EXPECT_LT((last.colwise() - first.col(v)).colwise().norm().minCoeff(), 1e-12) << v;
  }
}

// A tube of radius r along y, closed across a line where phases jump by all the waves that go round. Every
// inner vertex has six faces: at others Loop's curvature is not the tube's.
struct Tube {
  BaseSurface surface;
  std::vector<std::array<double, 3>> angle;  // of corners, radians, without the jump inside a face

  Tube(double radius, double length, int around, int along) {
    const Grid grid(turn * radius, length, around, along);
    const auto columns = static_cast<std::uint32_t>(around), rows = static_cast<std::uint32_t>(along);
    std::vector<shell::Face> flat, faces;
    for (std::uint32_t a = 0; a < (columns + 1) * rows; ++a) {
      if (a % (columns + 1) == columns) continue;
      flat.push_back({a, a + 1, a + columns + 2});
      flat.push_back({a, a + columns + 2, a + columns + 1});
    }
    for (const shell::Face& t : flat) {
      shell::Face face{};
      auto& angles = angle.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t i = t[c] % (columns + 1), j = t[c] / (columns + 1);
        face[c] = j * columns + i % columns;
        angles[c] = turn * i / around;
      }
      faces.push_back(face);
    }
    surface = {shell::build_topology(faces, static_cast<std::size_t>(around * (along + 1))),
               shell::rest_faces(grid.rest, flat), shell::Positions(3, around * (along + 1))};
    // Outward normals: angles run from z to x about y.
    for (int j = 0; j <= along; ++j) {
      for (int i = 0; i < around; ++i) {
        const double t = turn * i / around;
        surface.positions.col(j * around + i) << radius * std::sin(t), length * j / along,
            radius * std::cos(t);
      }
    }
  }
  CoarseField waves(double amplitude, int count) const {
    CoarseField field{Eigen::VectorXd::Constant(surface.positions.cols(), amplitude), angle};
    for (auto& phase : field.phase)
      for (double& p : phase) p *= count;
    return field;
  }
};

TEST(Upsample, TubeHasItsWavesAndConvergesWithTheBaseMesh) {
  const double radius = 0.4, a = 4e-3;
  const int count = 17;
  double before = 0;
  for (const int around : {16, 32, 64}) {
    const Tube tube(radius, 0.5, around, around / 4);
    const FineField fine = upsample(tube.surface, tube.waves(a, count), 2);
    const shell::Positions moved = displaced(fine);
    double worst = 0;
    for (Index v = 0; v < moved.cols(); ++v) {
      const Vector3d x = fine.positions.col(v);
      const double t = std::atan2(x.x(), x.z()), phase = count * t;
      // φ jumps by 17 turns across the line t = 0 and is right on both sides of it. The mask is a spline's:
      // third order in a coarse edge's angle, times the count.
      EXPECT_NEAR(std::remainder(fine.phase[v] - phase, turn), 0, 0.3 * count * std::pow(turn / around, 3))
          << around;
      const Vector3d out(std::sin(t), 0, std::cos(t)), round(std::cos(t), 0, -std::sin(t));
      const Vector3d expected =
          Vector3d(0, x.y(), 0) + (radius + a * std::cos(phase)) * out +
          tangential_shift(a * count / radius) * a * a * std::sin(2 * phase) * count / radius * round;
      worst = std::max(worst, (moved.col(v) - expected).norm());
    }
    // Loop's surface lies inside the one that its vertices were taken from, by a sixth of the sagitta's
    // order.
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / worst), 2, 0.25) << around;
    }
    before = worst;
  }
  EXPECT_LT(before, 0.01 * radius);

  // Counted on the mesh alone, by its spectrum.
  const Tube tube(radius, 0.5, 40, 5);
  const FineField fine = upsample(tube.surface, tube.waves(a, count), 2);
  std::vector<glm::dvec3> base, points;
  std::vector<std::uint32_t> triangles;
  const shell::Positions moved = displaced(fine);
  for (Index v = 0; v < moved.cols(); ++v) {
    points.emplace_back(moved(0, v), moved(1, v), moved(2, v));
    base.emplace_back(fine.positions(0, v), fine.positions(1, v), fine.positions(2, v));
  }
  for (const shell::Face& t : fine.faces) triangles.insert(triangles.end(), t.begin(), t.end());
  const MeshSpectrum spectrum = measure_waves(height_over_base(points, triangles, base, triangles));
  ASSERT_FALSE(spectrum.waves.empty());
  EXPECT_EQ(spectrum.waves.front().count, count);
}

// An annulus of .04 to .1 m: 79 waves round the hole, whose phases a cut through it closes; faces of the
// inner rings have no waves, and no phases.
TEST(Upsample, AnnulusWithSeventyNineWavesAndAFlatInside) {
  constexpr int around = 48, along = 10, count = 79, flat = 3;
  const Tube tube(1, 1, around, along);
  BaseSurface surface = tube.surface;
  for (Index v = 0; v < surface.positions.cols(); ++v) {
    const Vector3d x = surface.positions.col(v);
    const double r = 0.04 + 0.06 * x.y();
    surface.positions.col(v) << r * x.x(), r * x.z(), 0;
  }
  surface.rest = shell::rest_faces(surface.positions, surface.topology.faces);
  CoarseField field = tube.waves(1e-3, count);
  for (Index v = 0; v < field.amplitude.size(); ++v) {
    if (v < (flat + 1) * around) field.amplitude[v] = 0;
  }
  for (std::size_t f = 0; f < field.phase.size(); ++f) {
    if (f < 2 * flat * around) field.phase[f] = {0, 0, 0};
  }
  const FineField fine = upsample(surface, field, 3);
  const shell::Positions moved = displaced(fine);
  double flattest = 0, worst = 0;
  std::size_t inside = 0;
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    for (const std::uint32_t v : fine.faces[f]) {
      if (fine.base_face[f] < 2 * flat * around) {
        ++inside;
        flattest = std::max(flattest, std::abs(moved(2, v)));
      } else if (fine.amplitude[v] > 0) {
        const double t = std::atan2(fine.positions(0, v), fine.positions(1, v));
        worst = std::max(worst, std::abs(std::remainder(fine.phase[v] - count * t, turn)));
      }
    }
  }
  EXPECT_GT(inside, 0U);
  EXPECT_EQ(flattest, 0);
  // Continued linearly into the missing faces, an angle's turning over one face is left out: ⅛ (2π/48)² of a
  // radian there, times 79, is a sixth of a radian.
  EXPECT_LT(worst, 0.2);
}

// A plane that is compressed by s₀ and wrinkled by ½a²k² = s₀: its rest shape has no strain left, up to s₀²,
// but only with v₂; without it sheets are stretched on slopes and squeezed on crests by s₀.
TEST(Upsample, TangentialTermMakesWavesAsLongAsTheirRestShape) {
  const double s0 = 0.02, k = 60, a = std::sqrt(2 * s0) / k;
  const Grid grid = irregular(1, 0.4, 10, 4);
  const BaseSurface surface =
      test::moved(grid, [&](const Vector3d& x) { return Vector3d(std::sqrt(1 - s0) * x.x(), x.y(), 0); });
  const FineField fine =
      upsample(surface, plane_wave(surface, a, {k / std::sqrt(1 - s0), 0, 0}), 5);  // k by the rest shape
  const auto worst = [&](const shell::Positions& moved) {
    double strain = 0;
    for (const shell::Face& t : fine.faces) {
      Eigen::Matrix2d rest, first;
      Eigen::Matrix<double, 3, 2> edges;
      for (Index i = 0; i < 2; ++i) {
        const std::uint32_t v = t[static_cast<std::size_t>(i + 1)];
        const Vector3d flat = fine.positions.col(v) - fine.positions.col(t[0]);
        rest.col(i) << flat.x() / std::sqrt(1 - s0), flat.y();
        edges.col(i) = moved.col(v) - moved.col(t[0]);
      }
      const Eigen::Matrix<double, 3, 2> stretch = edges * rest.inverse();
      first = stretch.transpose() * stretch - Eigen::Matrix2d::Identity();
      strain = std::max(strain, first.norm());
    }
    return strain;
  };
  const double with = worst(displaced(fine)), without = worst(displaced(fine, false));
  EXPECT_NEAR(without, s0, 0.1 * s0);  // 2s₀ sin² − s₀
  EXPECT_LT(with, 2 * s0 * s0);        // ¼s₀² and what a chord of 1/29 of a wave leaves
}

// Where the base surface is all but collapsed, phases turn within nothing and ∇φ has no bounds: a shift
// a²|∇φ|/8 would throw cloth metres away. Up to a slope of 2 it keeps stretch even; from there on cloth stays
// in order.
TEST(Upsample, SteepWavesKeepClothInOrder) {
  FineField wave;
  const int count = 2000;
  const double a = 0.02;
  wave.positions.resize(3, count);
  wave.normals = Vector3d(0, 1, 0).replicate(1, count);
  wave.amplitude = Eigen::VectorXd::Constant(count, a);
  wave.phase = Eigen::VectorXd::LinSpaced(count, 0, 2 * pi);
  for (const double slope : {1e-3, 0.5, 1.0, 1.99, 2.01, 3.0, 10.0, 1e3, 1e9}) {
    const double k = slope / a;
    wave.positions.setZero();
    wave.positions.row(0) = wave.phase.transpose() / k;
    wave.gradient = Vector3d(k, 0, 0).replicate(1, count);
    const shell::Positions moved = displaced(wave);
    double least = 1e9, most = 0;
    for (Index v = 1; v < count; ++v) {
      const double step = wave.positions(0, v) - wave.positions(0, v - 1);
      // As two neighbouring samples of 1 + 2 c s² cos 2φ >= 0 see it, to rounding.
      EXPECT_GE(moved(0, v) - moved(0, v - 1), -1e-9 * step) << slope;
      const double stretch = (moved.col(v) - moved.col(v - 1)).norm() / step;
      least = std::min(least, stretch);
      most = std::max(most, stretch);
    }
    // (1 + s²/4 cos 2φ)² + s² sin² φ = 1 + s²/2 + s⁴/16 cos² 2φ
    if (slope < 2) {
      EXPECT_NEAR(least, std::sqrt(1 + slope * slope / 2), 1e-5) << slope;
      EXPECT_NEAR(most, 1 + slope * slope / 4, 1e-5) << slope;
    }
    EXPECT_LE((moved - wave.positions).cwiseAbs().maxCoeff(), a * (1 + 1e-12)) << slope;
  }
}

// A ring that keeps its length to first order: radial a cos nθ with a sin nθ/n along it.
TEST(Upsample, LeaningKeepsARingsLength) {
  const double radius = 0.4, a = 1e-4;
  const int count = 12;
  const Tube tube(radius, 0.5, 96, 12);
  const CoarseField field = tube.waves(a, count);
  Extras extras;
  extras.lean = leaning(tube.surface, face_forms(tube.surface), 0.3, field);
  const FineField fine = upsample(tube.surface, field, 1, extras), bare = upsample(tube.surface, field, 1);
  const auto stretch = [&](const FineField& from) {
    const shell::Positions moved = displaced(from);
    double most = 0;
    for (const shell::Face& t : from.faces) {
      for (std::size_t s = 0; s < 3; ++s) {
        const std::uint32_t v = t[s], u = t[(s + 1) % 3];
        const Vector3d before = from.positions.col(u) - from.positions.col(v);
        if (std::abs(before.y()) > 1e-9) continue;  // along the ring only
        // On outlines normals are only near the limit's.
        if (from.positions(1, v) < 1e-9 || from.positions(1, v) > 0.5 - 1e-9) continue;
        const Vector3d after = moved.col(u) - moved.col(v);
        most = std::max(most, std::abs(after.norm() / before.norm() - 1));
      }
    }
    return most;
  };
  EXPECT_NEAR(stretch(bare), a / radius, 0.1 * a / radius);  // radial alone
  // What is left: (½ + ¼) a²k² of v₂'s order, fitted curvature 2 % off.
  EXPECT_LT(stretch(fine), 0.05 * a / radius);
}

TEST(Upsample, SaysWhatIsWrong) {
  const Grid grid(1, 1, 2, 2);
  BaseSurface surface = test::moved(grid, stay);
  CoarseField field = plane_wave(surface, 1, {1, 0, 0});
  field.phase.pop_back();
  EXPECT_NE(test::error_of([&] { upsample(surface, field, 1); }).find("a field of 9 vertices and 7 faces"),
            std::string::npos);
  field = plane_wave(surface, 1, {1, 0, 0});
  field.phase[3][1] = NAN;
  EXPECT_NE(test::error_of([&] { upsample(surface, field, 1); }).find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace plisse::wrinkle
