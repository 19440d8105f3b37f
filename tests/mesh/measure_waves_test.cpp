// Waves whose length, height, direction and number are known: on sheets, two at once, and round a tube.
#include "mesh/measure_waves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

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
  return grid(81, 81, false, [=](double u, double v) {
    const double along = u * std::cos(angle) + v * std::sin(angle);
    return glm::dvec3(u, v, amplitude * std::cos(2 * pi * along / wavelength + phase));
  });
}

HeightField over_plane(const Mesh& mesh) {
  const Mesh plane =
      grid(2, 2, false, [](double u, double v) { return glm::dvec3(3 * u - 1, 3 * v - 1, 0); });
  return height_over_base(mesh.positions, mesh.triangles, plane.positions, plane.triangles);
}

// The least and the most crests that may be counted on that sheet: bands between two zeros of the cosine,
// each in one piece on a square. measure_waves leaves out those below a sixteenth of a square wave; a band
// that rims cut down to within a third of that may fall on either side.
std::pair<int, int> crests_of_sheet(double wavelength, double angle, double phase) {
  constexpr int samples = 1000;
  struct Band {
    double area = 0, top = 0;
  };
  std::map<long, Band> bands;
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const double along = ((i + 0.5) * std::cos(angle) + (j + 0.5) * std::sin(angle)) / samples;
      const double turns = along / wavelength + phase / (2 * pi);
      const double height = std::cos(2 * pi * turns);
      if (!(height > 0)) continue;
      Band& band = bands[std::lround(turns)];
      band.area += 1.0 / samples / samples;
      band.top = std::max(band.top, height);
    }
  }
  const auto above = [&](double share) {
    return static_cast<int>(std::count_if(bands.begin(), bands.end(), [&](const auto& band) {
      return band.second.area > share * wavelength * wavelength / 16 && band.second.top > share * 0.1;
    }));
  };
  return {above(4.0 / 3), above(2.0 / 3)};
}

// Rims cut waves off, so that the heights near them, a fifth of all and more, count for less: 1 % in the
// wavelength, whatever the phase; amplitudes, of which a part ends far from the line, 5 %.
constexpr double wavelength_share = 0.01, amplitude_share = 0.05;

TEST(MeasureWaves, APlaneWaveOverAPlane) {
  for (const double angle : {0.0, 0.5, 1.2}) {
    const MeshSpectrum spectrum = measure_waves(over_plane(sheet(0.125, 0.01, angle)));
    ASSERT_FALSE(spectrum.waves.empty());
    const MeshWave& wave = spectrum.waves.front();
    EXPECT_NEAR(wave.wavelength / 0.125, 1, wavelength_share) << angle;
    EXPECT_NEAR(wave.amplitude / 0.01, 1, amplitude_share) << angle;
    EXPECT_GT(glm::dot(wave.direction, {std::cos(angle), std::sin(angle), 0}), 0.999) << angle;
  }
}

// A wave that ends on a rim in a crest, in a zero or between them is one wave all the same, as long and as
// high.
TEST(MeasureWaves, WhateverThePhaseAtTheRimsSlow) {
  int exact = 0, tried = 0;
  for (const double wavelength : {0.1, 0.17}) {
    for (const double angle : {0.0, 0.3, 0.785}) {
      for (const double phase : {0.4, pi / 2, 3.5, 5.1}) {
        SCOPED_TRACE(testing::Message()
                     << wavelength << " m at " << angle << " rad, from " << phase << " rad");
        const MeshSpectrum spectrum = measure_waves(over_plane(sheet(wavelength, 0.01, angle, phase)));
        ASSERT_EQ(spectrum.waves.size(), 1U);
        const MeshWave& wave = spectrum.waves.front();
        EXPECT_NEAR(wave.wavelength / wavelength, 1, wavelength_share);
        EXPECT_NEAR(wave.amplitude / 0.01, 1, amplitude_share);
        const auto [least, most] = crests_of_sheet(wavelength, angle, phase);
        EXPECT_GE(wave.count, least);
        EXPECT_LE(wave.count, most);
        exact += least == most ? 1 : 0;
        ++tried;
      }
    }
  }
  EXPECT_GT(exact, tried * 3 / 4);  // or the bounds above would say little
}

// The modes across a strip are further apart than those of a square of its area.
TEST(MeasureWaves, AcrossAStrip) {
  const Mesh mesh = grid(61, 181, false, [](double u, double v) {
    return glm::dvec3(u, 3 * v, 0.01 * std::cos(2 * pi * u / 0.15 + 2));
  });
  const MeshSpectrum spectrum = measure_waves(over_plane(mesh));
  ASSERT_EQ(spectrum.waves.size(), 1U);
  EXPECT_NEAR(spectrum.waves[0].wavelength / 0.15, 1, wavelength_share);
  EXPECT_EQ(spectrum.waves[0].count, 7);  // from .32 to 6.98 turns: crests at 1 … 7
}

// A ribbon is narrower than its waves are long: nothing of it is a wavelength away from rims, and the modes
// across it are far apart. Two waves along it are still two, and a quarter of a wave at each end bends a
// length by 2 % at most.
TEST(MeasureWaves, AlongARibbon) {
  for (const double width : {0.1, 0.02}) {
    HeightField field;
    const Mesh flat =
        grid(201, 5, false, [width](double u, double v) { return glm::dvec3(u, width * v, 0); });
    field.base = flat.positions;
    field.triangles = flat.triangles;
    for (const auto& x : flat.positions)
      field.height.push_back(0.003 * std::cos(2 * pi * x.x / 0.1 + 1.6) +
                             0.002 * std::cos(2 * pi * x.x / 0.04));
    const MeshSpectrum spectrum = measure_waves(field);
    ASSERT_EQ(spectrum.waves.size(), 2U) << width;
    EXPECT_NEAR(spectrum.waves[0].wavelength / 0.1, 1, 0.02) << width;
    EXPECT_NEAR(spectrum.waves[1].wavelength / 0.04, 1, 0.02) << width;
    EXPECT_NEAR(spectrum.waves[0].amplitude / 0.003, 1, amplitude_share) << width;
    EXPECT_EQ(spectrum.waves[0].count, 10) << width;
  }
}

// Zones round a globe, as on a balloon; a hole in it is a rim that holds nothing.
TEST(MeasureWaves, AHoleInAClosedSurfaceChangesNothing) {
  constexpr double R = 0.3;
  Mesh globe = grid(120, 60, true, [](double u, double v) {
    const double polar = pi * (0.01 + 0.98 * v), around = 2 * pi * u;
    return R * glm::dvec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                          std::cos(polar));
  });
  globe.triangles.erase(globe.triangles.begin() + 3 * 7000, globe.triangles.begin() + 3 * 7001);
  HeightField field{globe.positions, {}, globe.triangles, 0};
  for (const auto& x : globe.positions)
    field.height.push_back(0.002 * std::cos(2 * pi * R * std::acos(x.z / R) / 0.12));
  const MeshSpectrum spectrum = measure_waves(field);
  ASSERT_FALSE(spectrum.waves.empty());
  EXPECT_NEAR(spectrum.waves[0].wavelength / 0.12, 1, wavelength_share);
}

TEST(MeasureWaves, TheMeshsOwnShapeServesAsBase) {
  const Mesh mesh = sheet(0.1, 0.004, 0.3);
  const MeshSpectrum spectrum = measure_waves(height_over_own_shape(mesh.positions, mesh.triangles));
  ASSERT_FALSE(spectrum.waves.empty());
  EXPECT_NEAR(spectrum.waves[0].wavelength / 0.1, 1,
              2 * wavelength_share);  // smoothing bends the base at its rims
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
