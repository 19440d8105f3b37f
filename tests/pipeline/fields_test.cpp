// Scenes that carry solved wrinkle fields: one under an animation, one a frame, and what the waves become as
// geometry beside a body.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "config/scene_file.h"
#include "config/settings.h"
#include "io/wrinkle_field.h"
#include "pipeline/displace.h"
#include "pipeline/history.h"
#include "pipeline/outside.h"
#include "pipeline/render.h"
#include "pipeline/verify.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

constexpr int side = 9;
constexpr double edge = 0.05, length = edge * (side - 1), a = 0.004;

// Every edge of the model halved so often.
pipeline::Displacement halved(const pipeline::LoadedScene& scene, int levels) {
  return {scene, subdivide(scene.surface(), 1 << (levels - scene.smooth_levels()))};
}

// A square sheet in the plane z = 0 that frame n squeezes along x, and fields over it.
class CarriedFields : public test::OpenGlTest {
 protected:
  static double squeeze(int frame) { return 1 - 0.1 * (frame - 1); }
  // Waves along x, `waves` of them over the rest pose's length.
  static double phase(double x, int frame, double waves) {
    return 2 * pi * waves * x / (length * squeeze(frame)) + 0.3;
  }

  io::WrinkleField field(int frame, double amplitude, double waves) const {
    io::WrinkleField result;
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) result.positions.emplace_back(squeeze(frame) * edge * i, edge * j, 0);
    result.amplitude.assign(result.positions.size(), amplitude);
    for (int j = 0; j + 1 < side; ++j) {
      for (int i = 0; i + 1 < side; ++i) {
        const auto v = static_cast<std::uint32_t>(j * side + i);
        result.triangles.push_back({v, v + 1, v + 1 + side});
        result.triangles.push_back({v, v + 1 + side, v + side});
      }
    }
    for (const auto& t : result.triangles) {
      std::array<double, 3> phases{};
      for (std::size_t c = 0; c < 3; ++c) phases[c] = phase(result.positions[t[c]].x, frame, waves);
      result.phase.push_back(phases);
    }
    return result;
  }

  void write_sheets(int frames) const {
    for (int frame = 1; frame <= frames; ++frame) {
      const io::WrinkleField one = field(frame, 0, 1);
      std::string obj;
      for (const glm::dvec3& x : one.positions) obj += fmt::format("v {:.9g} {:.9g} {:.9g}\n", x.x, x.y, x.z);
      for (const auto& t : one.triangles) obj += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
      test::write_text(folder_ / fmt::format("sheet_{}.obj", frame), obj);
    }
  }

  config::SceneSettings scene(const std::string& bias) const {
    return config::parse_scene("[model]\npath = \"sheet_#.obj\"\n[wrinkles]\nwavelength = 0.06\n" + bias,
                               folder_ / "scene.toml");
  }
  std::string complaint(const std::string& bias) const {
    return test::error_of([&] { pipeline::LoadedScene loaded(scene(bias)); });
  }

  test::TemporaryFolder folder_;
};

// Heights of a moment's geometry, metres.
std::vector<double> heights(const pipeline::LoadedScene& scene, const DisplacedSurface& surface) {
  std::vector<double> result;
  for (const glm::dvec4& relief : surface.relief) result.push_back(scene.units.metres * relief.x);
  return result;
}

// Of a wave of amplitude a and ω radians per metre on cloth that is λ times as long: by the rectangle rule,
// which is exact for a whole period.
double length_of_wave(double amplitude, double omega, double lambda) {
  double sum = 0;
  for (int i = 0; i < 1000; ++i)
    sum += std::hypot(lambda, amplitude * omega * std::sin(2 * pi * i / 1000)) / 1000;
  return sum;
}

// Pressed along its waves a carried field has all of the cloth that is gathered: the length over the waves is
// that at rest, and crush finds nothing left. Pulled to more than that length it is flat.
TEST_F(CarriedFields, TakesUpWhatIsPressedAlongItsWaves) {
  constexpr double waves = 5;
  const double omega = 2 * pi * waves / length, at_rest = length_of_wave(a, omega, 1);
  for (const double lambda : {1.0, 0.9, 0.6, 1.01, at_rest + 1e-3}) {
    write_sheets(1);
    std::string obj = test::read_text(folder_ / "sheet_1.obj");
    const io::WrinkleField flat = field(1, 0, 1);
    std::string pressed;
    for (const glm::dvec3& x : flat.positions)
      pressed += fmt::format("v {:.9g} {:.9g} 0\n", lambda * x.x, x.y);
    test::write_text(folder_ / "sheet_2.obj", pressed + obj.substr(obj.find("f ")));
    io::write_wrinkle_field(folder_ / "field.ply", field(1, a, waves));
    // On the same mesh: not smooth.
    History run(scene("[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n"), 0);
    const auto now = run.at(2);
    // Single precision; h/W grows with the root of what is left.
    EXPECT_NEAR(*std::ranges::max_element(now.compression), 0, 1e-5) << lambda;
    EXPECT_EQ(*std::ranges::max_element(now.height), 0) << lambda;
    const pipeline::Displacement displacement = halved(run.scene, 4);
    const DisplacedSurface moved = displacement.at(run.stepper.surface());
    const auto own = heights(run.scene, moved);
    const double highest = *std::ranges::max_element(own);
    if (lambda > at_rest) {
      EXPECT_EQ(highest, 0);
      continue;
    }
    EXPECT_NEAR(length_of_wave(highest, omega, lambda) / at_rest, 1, 2e-4) << lambda;  // 64 points a wave
    for (std::size_t i = 0; i < own.size(); ++i) {
      const double x = displacement.metres(moved.base[i]).x / lambda;
      EXPECT_NEAR(own[i], highest * std::cos(phase(x, 1, waves)), 2e-3 * highest) << lambda;
    }
  }
}

// Across its waves the passes' own lie on top, as high as without it.
TEST_F(CarriedFields, TheAnimationsOwnWavesLieOnTopAcrossIt) {
  write_sheets(1);
  std::string obj = test::read_text(folder_ / "sheet_1.obj"), pressed;
  for (const glm::dvec3& x : field(1, 0, 1).positions)
    pressed += fmt::format("v {:.9g} {:.9g} 0\n", x.x, 0.8 * x.y);
  test::write_text(folder_ / "sheet_2.obj", pressed + obj.substr(obj.find("f ")));
  io::write_wrinkle_field(folder_ / "field.ply", field(1, a, 5));
  History bare(scene("")), with(scene("[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n"), 0);
  const auto plain = bare.at(2), carried = with.at(2);
  // 80 % of its length are waves of W/4 √(1 − .64) = .15 W.
  for (std::size_t v = 0; v < plain.height.size(); ++v) {
    EXPECT_NEAR(with.scene.units.metres * plain.height[v], 0.15 * 0.06, 1e-6);
    EXPECT_NEAR(carried.height[v], plain.height[v], 1e-5 * plain.height[v]);
  }
  const pipeline::Displacement without_field = halved(bare.scene, 4), with_field = halved(with.scene, 4);
  const DisplacedSurface moved = with_field.at(with.stepper.surface());
  const auto own = heights(bare.scene, without_field.at(bare.stepper.surface())),
             both = heights(with.scene, moved);
  for (std::size_t i = 0; i < own.size(); ++i)
    EXPECT_NEAR(both[i] - own[i], a * std::cos(phase(with_field.metres(moved.base[i]).x, 1, 5)), 2e-3 * a);
}

TEST_F(CarriedFields, EveryFrameHasItsOwnAndNoWavesBesides) {
  write_sheets(3);
  for (int frame = 1; frame <= 3; ++frame)
    io::write_wrinkle_field(folder_ / fmt::format("field_{:04}.ply", frame),
                            field(frame, a * frame, 4 + frame));
  const std::string bias = "[bias]\nfield = \"field_####.ply\"\nuse = \"direct\"\n";
  History run(scene(bias));
  // Seven waves on eight edges in the last frame, and eight segments a wave: 2³ on an edge.
  EXPECT_EQ(levels_for(run.scene), 3);
  const pipeline::Displacement displacement = halved(run.scene, 3);
  std::set<std::string> hashes;
  for (int frame = 1; frame <= 3; ++frame) {
    hashes.insert(run.scene.frame_hash(frame, {}));
    const auto now = run.at(frame);
    EXPECT_EQ(*std::max_element(now.height.begin(), now.height.end()), 0);
    const DisplacedSurface moved = displacement.at(run.stepper.surface());
    const auto height = heights(run.scene, moved);
    for (std::size_t i = 0; i < height.size(); ++i) {
      const double x = displacement.metres(moved.base[i]).x;
      EXPECT_NEAR(height[i], a * frame * std::cos(phase(x, frame, 4 + frame)), 1e-4 * a * frame);
    }
  }
  EXPECT_EQ(hashes.size(), 3U);
  // A frame's name tells when its field has changed.
  io::write_wrinkle_field(folder_ / "field_0002.ply", field(2, a, 6));
  History again(scene(bias));
  EXPECT_TRUE(hashes.contains(again.scene.frame_hash(1, {})));
  EXPECT_FALSE(hashes.contains(again.scene.frame_hash(2, {})));
}

TEST_F(CarriedFields, AMissingOrForeignFieldIsNamed) {
  write_sheets(3);
  for (const int frame : {1, 3})
    io::write_wrinkle_field(folder_ / fmt::format("field_{:04}.ply", frame), field(frame, a, 5));
  const std::string direct = "use = \"direct\"\n", bias = "[bias]\nfield = \"field_####.ply\"\n";
  EXPECT_THAT(complaint(bias + direct), HasSubstr("field_0002.ply: missing from the sequence"));
  io::write_wrinkle_field(folder_ / "field_0002.ply", field(2, a, 5));
  EXPECT_EQ(complaint(bias + direct), "");
  EXPECT_THAT(complaint(bias),
              HasSubstr("scene.toml:6:1: key 'field': one field a frame is carried as it is and "
                        "needs use = \"direct\""));
  std::filesystem::remove(folder_ / "field_0003.ply");
  EXPECT_THAT(complaint(bias + direct),
              HasSubstr("there are 2 fields, field_0001.ply to field_0002.ply, but the clip has 3 frames"));
  io::write_wrinkle_field(folder_ / "field_0003.ply", field(1, a, 5));  // of another frame's surface
  History run(scene(bias + direct));
  run.at(2);
  EXPECT_THAT(test::error_of([&] { run.at(3); }),
              HasSubstr("field_0003.ply: its vertex 1 is not on the model"));
  EXPECT_THAT(complaint("[bias]\nfield = \"none/field_####.ply\"\n" + direct),
              HasSubstr("there is no folder"));
  // The texts of Chen et al. may be the frames' fields too.
  EXPECT_THAT(complaint("[bias]\nfield = \"cloth_####_amplitude_rest.txt\"\n" + direct),
              HasSubstr("no file fits this pattern"));
}

TEST_F(CarriedFields, StrengthAndSelectionCountForThemToo) {
  write_sheets(1);
  io::write_wrinkle_field(folder_ / "field.ply", field(1, a, 5));
  config::SceneSettings settings = scene("[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n");
  for (const double strength : {0.0, 0.5, 2.0}) {
    settings.wrinkles.strength = strength;
    History run(settings);
    run.at(1);
    const pipeline::Displacement displacement = halved(run.scene, 5);
    const auto height = heights(run.scene, displacement.at(run.stepper.surface()));
    EXPECT_NEAR(*std::max_element(height.begin(), height.end()), strength * a, 1e-3 * a);
  }
}

// v₂ of Chen et al. 2021: along a wave the cloth keeps its length everywhere alike. Moved straight up alone,
// its flanks would be stretched by ½ (aω)², the crests not at all.
TEST_F(CarriedFields, AlongAWaveClothIsStretchedEvenly) {
  write_sheets(1);
  io::write_wrinkle_field(folder_ / "field.ply", field(1, a, 5));
  History run(scene("[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n"));
  run.at(1);
  const pipeline::Displacement displacement = halved(run.scene, 6);
  const DisplacedSurface moved = displacement.at(run.stepper.surface());
  const double steepness = a * 2 * pi * 5 / length;  // aω = .314
  double least = 10, most = 0;
  const auto& mesh = displacement.mesh();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto at = [&](std::size_t k) { return mesh.vertices[mesh.triangles[k]].position; };
    const std::uint32_t p = at(i), q = at(i % 3 == 2 ? i - 2 : i + 1);
    if (std::abs(moved.base[p].y - moved.base[q].y) > 1e-9) continue;  // along x
    const double stretch =
        glm::distance(moved.positions[p], moved.positions[q]) / glm::distance(moved.base[p], moved.base[q]);
    least = std::min(least, stretch);
    most = std::max(most, stretch);
  }
  // 1 + (aω)²/4, and what is left of it is of fourth order: (aω)⁴/32 and less.
  EXPECT_NEAR(0.5 * (least + most), 1 + steepness * steepness / 4, std::pow(steepness, 4) / 16);
  EXPECT_LT(most - least, std::pow(steepness, 4) / 8);
  EXPECT_LT(most - least, 0.05 * steepness * steepness / 2);
}

// Steeper than a slope of 2 they would fold over themselves: along a wave cloth stays in order, and the
// shader moves it as the reference does.
TEST_F(CarriedFields, SteepWavesKeepClothInOrder) {
  write_sheets(1);
  for (const double steepness : {1.5, 3.0, 30.0}) {
    const double high = steepness * length / (2 * pi * 5);
    io::write_wrinkle_field(folder_ / "field.ply", field(1, high, 5));
    History run(scene("[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n"));
    run.at(1);
    const pipeline::Displacement displacement = halved(run.scene, 6);
    const DisplacedSurface moved = displacement.at(run.stepper.surface());
    const auto& mesh = displacement.mesh();
    double backward = 0, forward = 0;  // of steps along x, in their length
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto at = [&](std::size_t k) { return mesh.vertices[mesh.triangles[k]].position; };
      const std::uint32_t p = at(i), q = at(i % 3 == 2 ? i - 2 : i + 1);
      const double step = moved.base[q].x - moved.base[p].x;
      if (std::abs(moved.base[p].y - moved.base[q].y) > 1e-9) continue;
      const double share = (moved.positions[q].x - moved.positions[p].x) / step;
      backward = std::min(backward, share);
      forward = std::max(forward, share);
    }
    // 1 + 2 c s² cos 2φ, c s² = min(s²/8, ½); chords of an eightieth of a wave see less of it.
    const double bulge = std::min(steepness * steepness / 4, 1.0);
    EXPECT_NEAR(forward, 1 + bulge, 0.01) << steepness;
    EXPECT_GE(backward, -1e-6) << steepness;  // rounding of places
  }
}

TEST_F(CarriedFields, TheShaderMovesSteepWavesAsTheReferenceDoes) {
  write_sheets(1);
  for (const double steepness : {1.5, 3.0, 30.0}) {
    io::write_wrinkle_field(folder_ / "field.ply", field(1, steepness * length / (2 * pi * 5), 5));
    pipeline::RenderRequest request;
    request.scene = scene("[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n");
    request.scene.output.width = request.scene.output.height = 64;
    const pipeline::VerifyReport report = pipeline::verify(request, {});
    for (const char* part : {"displacement", "displacement.relief", "displacement.normal"}) {
      ASSERT_TRUE(report.passes.contains(part)) << part;
      EXPECT_TRUE(report.passes.at(part).ok) << part << " " << steepness;
    }
  }
}

// --- beside a body

// A box from z = −1 up to `top`, wider than the sheet; faces outward.
std::string box(double top) {
  std::string obj;
  for (const double z : {-1.0, top})
    for (const double y : {-0.2, 0.7})
      for (const double x : {-0.2, 0.7}) obj += fmt::format("v {} {} {}\n", x, y, z);
  return obj + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n";
}

TEST_F(CarriedFields, ClothStaysOutOfABody) {
  write_sheets(1);
  io::write_wrinkle_field(folder_ / "field.ply", field(1, a, 5));
  const double top = -0.25 * a;
  test::write_text(folder_ / "body.obj", box(top));
  History run(scene("[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n"));
  run.at(1);
  const pipeline::Displacement displacement = halved(run.scene, 5);
  const DisplacedSurface free = displacement.at(run.stepper.surface());
  DisplacedSurface held = free;
  pipeline::Outside outside(run.scene, folder_ / "body.obj");
  outside.hold(1, displacement.mesh(), held);
  const double unit = run.scene.units.metres;
  std::size_t cut = 0;
  for (std::size_t i = 0; i < held.positions.size(); ++i) {
    const double before = displacement.metres(free.positions[i]).z,
                 now = displacement.metres(held.positions[i]).z;
    EXPECT_GE(now, top);
    if (before > top) {
      EXPECT_EQ(held.positions[i], free.positions[i]);
    } else {
      ++cut;
      EXPECT_NEAR(now, top, 3e-6 * unit);  // the gap
      EXPECT_NEAR(unit * held.relief[i].x, top, 3e-6 * unit);
    }
  }
  // cos φ < −1/4 on 42 % of a wave.
  EXPECT_NEAR(static_cast<double>(cut) / static_cast<double>(held.positions.size()), 0.42, 0.03);
  for (const FineVertex& v : displacement.mesh().vertices) {
    if (displacement.metres(free.positions[v.position]).z < top - 0.2 * a) {
      EXPECT_GT(held.normals[v.normal].z, 0.98);  // it lies on the box, level
    }
  }
}

TEST_F(CarriedFields, WhatLiesInABodyIsNotCarriedDeeper) {
  write_sheets(1);
  io::write_wrinkle_field(folder_ / "field.ply", field(1, a, 5));
  test::write_text(folder_ / "body.obj", box(0.1 * a));  // the sheet lies in it
  History run(scene("[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n"));
  run.at(1);
  const pipeline::Displacement displacement = halved(run.scene, 4);
  const DisplacedSurface free = displacement.at(run.stepper.surface());
  DisplacedSurface held = free;
  pipeline::Outside(run.scene, folder_ / "body.obj").hold(1, displacement.mesh(), held);
  for (std::size_t i = 0; i < held.positions.size(); ++i) {
    const bool upward = free.positions[i].z >= free.base[i].z;
    EXPECT_EQ(held.positions[i], upward ? free.positions[i] : free.base[i]);
  }
}

TEST_F(CarriedFields, ABodyIsAFileOrAPartOfTheModel) {
  write_sheets(2);
  pipeline::LoadedScene loaded(scene(""));
  const std::string unknown = test::error_of([&] { pipeline::Outside(loaded, "shet"); });
  EXPECT_THAT(unknown, HasSubstr("--outside shet: there is no such file, and the model has no such mesh"));
  for (int frame = 1; frame <= 3; ++frame)
    test::write_text(folder_ / fmt::format("body_{}.obj", frame), box(-0.1));
  write_sheets(4);
  pipeline::LoadedScene longer(scene(""));
  EXPECT_THAT(test::error_of([&] { pipeline::Outside(longer, folder_ / "body_#.obj"); }),
              HasSubstr("has 3 frames, the clip has 4"));
}

}  // namespace
}  // namespace plisse::pipeline
