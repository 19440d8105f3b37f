// Waves whose length, height, direction and number are known: on sheets, two at once, and round a tube.
#include "mesh/measure_waves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace plisse {
namespace {

using std::numbers::pi;

struct Mesh {
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> triangles;
};

// columns × rows vertices; `closed`: the last column meets the first.
Mesh grid(int columns, int rows, bool closed, const std::function<glm::dvec3(double, double)>& place) {
  Mesh mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      mesh.positions.push_back(place(static_cast<double>(i) / (closed ? columns : columns - 1),
                                     static_cast<double>(j) / (rows - 1)));
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(j * columns + i % columns); };
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns + (closed ? 1 : 0); ++i) {
      for (const auto v : {id(i, j), id(i + 1, j), id(i + 1, j + 1)}) mesh.triangles.push_back(v);
      for (const auto v : {id(i, j), id(i + 1, j + 1), id(i, j + 1)}) mesh.triangles.push_back(v);
    }
  }
  return mesh;
}

// A square metre with waves a cos(2π x·d/λ + phase) along the unit direction d.
Mesh sheet(double wavelength, double amplitude, double angle, double phase = 0.4) {
  return grid(121, 121, false, [=](double u, double v) {
    const double along = u * std::cos(angle) + v * std::sin(angle);
    return glm::dvec3(u, v, amplitude * std::cos(2 * pi * along / wavelength + phase));
  });
}

HeightField over_plane(const Mesh& mesh) {
  const Mesh plane =
      grid(2, 2, false, [](double u, double v) { return glm::dvec3(3 * u - 1, 3 * v - 1, 0); });
  return height_over_base(mesh.positions, mesh.triangles, plane.positions, plane.triangles);
}

// A rim cuts waves off in the middle: a line gets as wide as 1/waves (tests have eight or more), of which its
// middle keeps 2 %; amplitudes, of which a part ends far from the line, 5 %.
constexpr double wavelength_share = 0.02, amplitude_share = 0.05;

TEST(MeasureWaves, APlaneWaveOverAPlane) {
  for (const double angle : {0.0, 0.5, 1.2}) {
    const MeshSpectrum spectrum = measure_waves(over_plane(sheet(0.125, 0.01, angle)));
    ASSERT_FALSE(spectrum.waves.empty());
    const MeshWave& wave = spectrum.waves.front();
    EXPECT_NEAR(wave.wavelength / 0.125, 1, wavelength_share) << angle;
    EXPECT_NEAR(wave.amplitude / 0.01, 1, amplitude_share) << angle;
    EXPECT_GT(glm::dot(wave.direction, {std::cos(angle), std::sin(angle), 0}), 0.999) << angle;
    // Lines across a square, corner to corner.
    const double span = (std::cos(angle) + std::sin(angle)) / 0.125;
    EXPECT_NEAR(wave.count, span, 1.5) << angle;
  }
}

TEST(MeasureWaves, TheMeshsOwnShapeServesAsBase) {
  const Mesh mesh = sheet(0.1, 0.004, 0.3);
  const MeshSpectrum spectrum = measure_waves(height_over_own_shape(mesh.positions, mesh.triangles));
  ASSERT_FALSE(spectrum.waves.empty());
  EXPECT_NEAR(spectrum.waves[0].wavelength / 0.1, 1, wavelength_share);
  EXPECT_NEAR(spectrum.waves[0].amplitude / 0.004, 1, amplitude_share);
}

TEST(MeasureWaves, TwoWavesAtOnceComeApart) {
  const Mesh mesh = grid(121, 121, false, [](double u, double v) {
    return glm::dvec3(u, v,
                      0.01 * std::cos(2 * pi * u / 0.25 + 1) + 0.004 * std::cos(2 * pi * v / (1.0 / 12)));
  });
  const MeshSpectrum spectrum = measure_waves(over_plane(mesh));
  ASSERT_GE(spectrum.waves.size(), 2U);
  EXPECT_NEAR(spectrum.waves[0].wavelength / 0.25, 1, 2 * wavelength_share);  // four waves only
  EXPECT_NEAR(spectrum.waves[1].wavelength * 12, 1, wavelength_share);
  EXPECT_NEAR(spectrum.waves[1].amplitude / 0.004, 1, amplitude_share);
  EXPECT_GT(spectrum.waves[0].direction.x, 0.99);
  EXPECT_GT(spectrum.waves[1].direction.y, 0.99);
}

// Twelve pleats round a tube: a wave of 2πR/12, whose crests run along the axis and point all ways.
TEST(MeasureWaves, PleatsRoundATube) {
  constexpr double R = 0.1, a = 0.002;
  const Mesh mesh = grid(240, 60, true, [](double u, double v) {
    const double r = R + a * std::cos(12 * 2 * pi * u);
    return glm::dvec3(r * std::sin(2 * pi * u), 0.3 * v, r * std::cos(2 * pi * u));
  });
  const MeshSpectrum spectrum = measure_waves(height_over_own_shape(mesh.positions, mesh.triangles));
  ASSERT_FALSE(spectrum.waves.empty());
  EXPECT_NEAR(spectrum.waves[0].wavelength / (2 * pi * R / 12), 1, wavelength_share);
  EXPECT_NEAR(spectrum.waves[0].amplitude / a, 1, amplitude_share);
  EXPECT_EQ(spectrum.waves[0].count, 12);
  EXPECT_EQ(spectrum.waves[0].direction, glm::dvec3(0));
}

TEST(MeasureWaves, TheSpectrumHoldsAllOfTheHeight) {
  const HeightField field = over_plane(sheet(0.125, 0.01, 0));
  double power = 0;
  for (const auto& bin : measure_waves(field).bins) power += bin.power;
  EXPECT_NEAR(power / (0.5 * 0.01 * 0.01), 1, 0.02);  // ½ a², eight waves on a grid
}

TEST(MeasureWaves, AFlatSheetHasNone) {
  const Mesh flat = sheet(0.1, 0, 0);
  EXPECT_TRUE(measure_waves(over_plane(flat)).waves.empty());
}

}  // namespace
}  // namespace plisse
