// Render on the GPU against closed forms: a plane wave's normals, profiles, fading, blending, light on a flat
// sheet, coverage, transparency, parallax and shadows. Sheets lie in the plane z = 0 and are seen from above,
// +x to the right.
#include "passes/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "base/colour.h"
#include "base/error.h"
#include "gpu/target.h"
#include "support/files.h"
#include "support/opengl.h"
#include "support/sheets.h"

namespace plisse::passes {
namespace {

using std::numbers::pi;
using test::Passes;
using test::Sheet;

class Render : public test::OpenGlTest {};

struct Picture {
  int width = 0, height = 0;
  std::vector<float> rgba;  // floats, or bytes as 0…255
  const float* at(int x, int y) const { return &rgba[4 * static_cast<std::size_t>(y * width + x)]; }
  glm::dvec3 colour(int x, int y) const { return {at(x, y)[0], at(x, y)[1], at(x, y)[2]}; }
  double alpha(int x, int y) const { return static_cast<double>(at(x, y)[3]); }
};

// What a test draws: a sheet, its waves, and how it is looked at.
struct Stage {
  Sheet sheet;
  Look look;
  View view;
  std::vector<DrawPart> parts;
  std::vector<std::vector<TextureLevel>> textures;
  std::string profile = "sinusoid";
  std::vector<glm::dvec3> positions;   // empty: the rest pose
  std::vector<glm::dvec2> wavenumber;  // κ along x and y, turns per unit
  std::vector<double> height, phase;

  explicit Stage(Sheet of) : sheet(std::move(of)) {
    DrawPart part;
    part.triangle_count = static_cast<std::uint32_t>(sheet.surface.triangle_count());
    parts.push_back(part);
    wavenumber.assign(sheet.size(), glm::dvec2(0));
    height.assign(sheet.size(), 0);
    phase.assign(sheet.size(), 0);
    look.sheen = 0;
    look.background = glm::dvec3(0);
    for (auto& light : view.lights) light.colour = glm::dvec3(0);
    view.ambient = glm::dvec3(1);
    view.up = {0, 0, 1};
    window({0, 0}, {1, 1});
  }

  // Looks down on a rectangle of the plane z = 0.
  void window(const glm::dvec2& low, const glm::dvec2& high) {
    view.eye = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y), 1000};  // far: the view is parallel
    view.forward = {0, 0, -1};
    view.view_projection = glm::ortho(low.x, high.x, low.y, high.y, -10.0, 10.0);
  }

  // The same plane wave at all vertices: cos(2π κ·x + φ).
  void plane_wave(const glm::dvec2& kappa, double amplitude, double start) {
    for (std::size_t v = 0; v < sheet.size(); ++v) {
      wavenumber[v] = kappa;
      height[v] = amplitude;
      phase[v] = test::wrap_radians(2 * pi * glm::dot(kappa, glm::dvec2(sheet.surface.rest[v])) + start);
    }
  }
  void random_phases(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-pi, pi);
    for (double& p : phase) p = number(random);
  }

  // The surface with these waves.
  Passes passes() const {
    Passes result(sheet);
    result.pose(positions.empty() ? sheet.surface.rest : positions);
    const auto now = result.read();
    std::vector<glm::vec4> waves;
    std::vector<glm::vec2> phases;
    for (std::size_t v = 0; v < sheet.size(); ++v) {
      const glm::dvec3 kappa(wavenumber[v], 0), t = now.tangent[v], b = glm::cross(now.normal[v], t);
      waves.emplace_back(glm::dot(kappa, t), glm::dot(kappa, b), height[v], 1);
      phases.emplace_back(phase[v], 1);
    }
    result.buffers.waves.write(waves);
    result.buffers.phases.write(phases);
    return result;
  }

  Picture aov(Aov which, int width, int height_in_pixels) const {
    const Passes surface = passes();
    RenderPass pass(look, make_profile(profile), parts, textures, "");
    const gpu::Target target(width, height_in_pixels, 1, gpu::Target::Format::rgba32f);
    pass.draw_aov(surface.buffers, view, target, which);
    return {width, height_in_pixels, target.read_rgba32f()};
  }
  Picture draw(int width, int height_in_pixels, int samples = 1) const {
    const Passes surface = passes();
    RenderPass pass(look, make_profile(profile), parts, textures, "");
    const gpu::Target target(width, height_in_pixels, samples, gpu::Target::Format::srgb8);
    pass.draw_all(surface.buffers, view, target);
    const auto bytes = target.read_rgba8();
    return {width, height_in_pixels, {bytes.begin(), bytes.end()}};
  }
};

Sheet unit_square(int side = 7) {
  return test::grid(side, side, 1.2 / (side - 1), 0, 1);
}

// Point of the plane under the middle of a pixel of the window 0…1.
glm::dvec2 under(const Picture& picture, int x, int y) {
  return {(x + 0.5) / picture.width, 1 - (y + 0.5) / picture.height};
}

// IEC 61966-2-1, in 0…255.
double srgb(double linear) {
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}
double shoulder(double x) {
  return x <= 0.8 ? x : 1 - 0.04 / (x - 0.6);
}

// The table is linear between 1024 entries, good to 5e-6 in f and 2e-3 in where f' steps; single precision
// adds 1e-6.
constexpr double normal_tolerance = 1e-4;

TEST_F(Render, APlaneWavesNormalsAreAnalytic) {
  for (const bool smooth : {false, true}) {
    for (const bool full : {false, true}) {
      Stage stage(test::grid(8, 8, 0.18, 0.3, 4));
      stage.look.smooth_blend = smooth;
      stage.look.full_gradient = full;
      const glm::dvec2 kappa(3, 1.5);
      constexpr double amplitude = 0.04, start = 0.7;
      stage.plane_wave(kappa, amplitude, start);
      stage.window({0.1, 0.1}, {1.1, 1.1});
      const Picture normals = stage.aov(Aov::normal, 128, 128), heights = stage.aov(Aov::height, 128, 128);
      for (int y = 0; y < 128; y += 3) {
        for (int x = 0; x < 128; x += 3) {
          const double phase = 2 * pi * glm::dot(kappa, under(normals, x, y) + 0.1) + start;
          const glm::dvec2 slope = -2 * pi * amplitude * std::sin(phase) * kappa;
          // All three waves agree, so neither weights nor their gradients show.
          EXPECT_LT(glm::distance(normals.colour(x, y), glm::normalize(glm::dvec3(-slope, 1))),
                    normal_tolerance);
          EXPECT_NEAR(heights.colour(x, y).x, amplitude * std::cos(phase), 1e-4 * amplitude);
        }
      }
    }
  }
}

TEST_F(Render, AccordionHasStraightFlanks) {
  // Squeezed to one half: h = .21651 W, κ = 2/W, slope 60° (wrinkle-passes.md, "Ground truth").
  constexpr double W = 0.25;
  Stage stage(unit_square());
  stage.plane_wave({2 / W, 0}, 0.2165064 * W, 0);
  stage.profile = "accordion";
  const Picture normals = stage.aov(Aov::normal, 256, 8);
  int steep = 0;
  for (int x = 0; x < 256; ++x) {
    const double along = std::fmod(under(normals, x, 0).x * 2 / W, 0.5);
    if (along < 0.01 || along > 0.49) continue;  // the table's steps at crest and valley
    EXPECT_NEAR(glm::degrees(std::acos(normals.colour(x, 4).z)), 60, 0.01) << x;
    ++steep;
  }
  EXPECT_GT(steep, 200);
}

TEST_F(Render, ProfilesAreEvenAndKeepTheirPromises) {
  for (const std::string name : {"sinusoid", "accordion", "pencil"}) {
    const Profile profile = make_profile(name);
    ASSERT_EQ(profile.f.size(), static_cast<std::size_t>(Profile::size));
    const auto [low, high] = std::minmax_element(profile.f.begin(), profile.f.end());
    EXPECT_NEAR(*low, -1, 1e-12) << name;
    EXPECT_NEAR(*high, 1, 1e-12) << name;
    EXPECT_NEAR(profile.f[0], 1, 1e-12) << name;  // the crest
    double power = 0;
    for (std::size_t i = 1; i < Profile::size; ++i) {
      EXPECT_NEAR(profile.f[i], profile.f[Profile::size - i], 1e-12);
      EXPECT_NEAR(profile.derivative[i], -profile.derivative[Profile::size - i], 1e-12);
      power += profile.derivative[i] * profile.derivative[i] / Profile::size;
      if (i < 2 || i > Profile::size - 2 || (i > 510 && i < 514)) continue;  // the corners
      const double slope = (profile.f[i + 1] - profile.f[i - 1]) * Profile::size / (4 * pi);
      EXPECT_NEAR(profile.derivative[i], slope, 1e-4) << name << " " << i;
    }
    EXPECT_NEAR(profile.slope_variance, power / 0.5, 1e-9) << name;
  }
  EXPECT_NEAR(make_profile("sinusoid").slope_variance, 1, 1e-12);
  EXPECT_NEAR(make_profile("accordion").slope_variance, 8 / (pi * pi),
              5e-3);  // (2/π)²/½; two entries of 1024 are 0
}

TEST_F(Render, ProfilesFromAFile) {
  const test::TemporaryFolder folder;
  const auto file = folder / "triangle.txt";
  test::write_text(file, "# crest, flank, valley, flank\n3, 2\n1 2\n");
  const Profile profile = make_profile(file.string());
  EXPECT_NEAR(profile.f[0], 1, 1e-12);
  EXPECT_NEAR(profile.f[256], 0, 1e-12);
  EXPECT_NEAR(profile.f[512], -1, 1e-12);
  EXPECT_NEAR(profile.derivative[128], -2 / pi, 1e-6);
  const auto refused = [&](const std::string& text, const std::string& why) {
    test::write_text(file, text);
    try {
      make_profile(file.string());
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused("1 2 3", "3 numbers");
  refused("1 2\n3 nonsense", ":2:3:");
  refused("1 2 nan 2", ":1:5:");
  refused("1 1 1 1", "equal");
  refused("3 2 1 1.5", "not even");
  EXPECT_THROW(make_profile((folder / "absent.txt").string()), Error);
}

// Whole from four pixels a wave, gone at two.
TEST_F(Render, WavesFadeBetweenFourAndTwoPixels) {
  Stage stage(unit_square());
  constexpr int size = 64;
  constexpr double amplitude = 1e-3;
  const auto steepest = [&](double pixels_a_wave) {
    const double kappa = size / pixels_a_wave;
    stage.plane_wave({kappa, 0}, amplitude, pi / 4);
    const Picture normals = stage.aov(Aov::normal, size, 4);
    double steepest_seen = 0;
    for (int x = 0; x < size; ++x) {
      const glm::dvec3 n = normals.colour(x, 2);
      const double expected =
          2 * pi * kappa * amplitude * std::sin(2 * pi * kappa * under(normals, x, 0).x + pi / 4);
      const double tolerance = pixels_a_wave >= 4 ? 2e-3 : 1.0;
      EXPECT_NEAR(n.x / n.z, expected, tolerance) << pixels_a_wave << " " << x;
      steepest_seen = std::max(steepest_seen, std::abs(n.x / n.z) / (2 * pi * kappa * amplitude));
    }
    return steepest_seen;
  };
  EXPECT_GT(steepest(16), 0.9);
  EXPECT_GT(steepest(4.01), 0.65);  // sampled at four phases
  EXPECT_LT(steepest(3), steepest(4.01));
  EXPECT_EQ(steepest(2), 0.0);
  EXPECT_EQ(steepest(1.5), 0.0);
  // smoothstep(¼, ½) at ⅓ turn a pixel is 1/3²·(3 − 2/3) = .2593.
  const Picture amplitudes =
      (stage.plane_wave({size / 3.0, 0}, amplitude, 0), stage.aov(Aov::amplitude, size, 4));
  EXPECT_NEAR(amplitudes.colour(20, 2).x / amplitude, 1 - 0.259259, 1e-3);
}

TEST_F(Render, LostSlopeWidensTheHighlight) {
  // A wave at two pixels leaves a flat normal; its slopes' variance ½(2πh|κ|)² adds to roughness⁴ instead.
  Stage stage(unit_square());
  stage.look.roughness = 0.3;
  stage.look.cavity = 0;
  stage.parts[0].base_colour = {0, 0, 0, 1};
  stage.view.ambient = glm::dvec3(0);
  for (const double tilt : {0.0, 0.3, 0.6}) {
    for (const double amplitude : {0.0, 1e-3, 2e-3}) {
      const double light = tilt == 0 ? 0.1 : 2.0;
      stage.view.lights[1].colour = glm::dvec3(light);
      stage.view.lights[1].direction = {std::sin(tilt), 0, std::cos(tilt)};
      stage.plane_wave({32, 0}, amplitude, 0);
      const double a2 = std::pow(0.3, 4) + 0.5 * std::pow(2 * pi * amplitude * 32, 2);
      const double H = std::cos(tilt / 2), q = H * H * (a2 - 1) + 1, d = (std::cos(tilt) + 0.15) / 1.15;
      const double shine = a2 / (pi * q * q) * (0.04 + 0.96 * std::pow(1 - H, 5)) / (4 * H * H) * d;
      EXPECT_NEAR(stage.draw(64, 64).colour(32, 32).x, srgb(shoulder(light * shine)), 1.5)
          << tilt << " " << amplitude;
    }
  }
}

TEST_F(Render, FullGradientIsTheSlopeOfTheDrawnHeights) {
  // Waves that do not agree: the weights' own gradients count. Heights and normals are two outputs;
  // differences of the one must give the other. 8e-4: a central difference over two pixels of 1/512 errs by
  // (2π/λ)³h·(1/512)²/6, λ = ½; where the blend of three waves bends more, twice and three times that.
  for (const bool smooth : {false, true}) {
    Stage stage(test::sheet({{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}}, {0, 1, 2}));
    stage.look.smooth_blend = smooth;
    stage.plane_wave({2, 0.5}, 0.02, 0);
    stage.random_phases(3);
    const auto largest_error = [&](bool full) {
      stage.look.full_gradient = full;
      const Picture normals = stage.aov(Aov::normal, 512, 512), heights = stage.aov(Aov::height, 512, 512);
      double largest = 0;
      int looked_at = 0;
      for (int y = 1; y < 511; y += 2) {
        for (int x = 1; x < 511; x += 2) {
          // Inside, and away from the corners, where the smooth weights turn quickly.
          const glm::dvec2 p = under(heights, x, y);
          const double gamma = p.y, beta = p.x - 0.2 * gamma, alpha = 1 - beta - gamma;
          if (std::min({alpha, beta, gamma}) < 0.02 || std::max({alpha, beta, gamma}) > 0.8) continue;
          const double dx = 256.0 * (heights.colour(x + 1, y).x - heights.colour(x - 1, y).x);
          const double dy = 256.0 * (heights.colour(x, y - 1).x - heights.colour(x, y + 1).x);
          largest =
              std::max(largest, glm::distance(normals.colour(x, y), glm::normalize(glm::dvec3(-dx, -dy, 1))));
          ++looked_at;
        }
      }
      EXPECT_GT(looked_at, 10000);
      return largest;
    };
    const double full = largest_error(true), paper = largest_error(false);
    EXPECT_LT(full, 3e-3) << smooth;
    EXPECT_GT(paper, 20 * full) << smooth;  // eq. 8 as printed drops a share of W/(2πℓ)
  }
}

// Jump of the normal across the diagonal of a square of two triangles, from one pixel's diagonal neighbours:
// what is smooth shrinks with the pixels, what breaks does not.
TEST_F(Render, SmoothBlendTakesTheCreasesAway) {
  Stage stage(test::sheet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}));
  for (const unsigned seed : {1U, 2U, 3U}) {
    stage.plane_wave({2, 0.7}, 0.03, 0);
    stage.random_phases(seed);
    const auto jump = [&](bool smooth, int size) {
      stage.look.smooth_blend = smooth;
      const Picture normals = stage.aov(Aov::normal, size, size);
      double largest = 0;
      for (int i = size / 10; i < size - size / 10;
           ++i) {  // the diagonal runs through pixels (i, size − 1 − i)
        const int x = i, y = size - 1 - i;
        largest =
            std::max(largest, glm::distance(normals.colour(x + 1, y + 1), normals.colour(x - 1, y - 1)));
      }
      return largest;
    };
    const double linear = jump(false, 1024), smooth = jump(true, 1024);
    EXPECT_GT(linear, 0.5 * jump(false, 256)) << seed;  // a crease: stays
    EXPECT_LT(smooth, 0.35 * jump(true, 256)) << seed;  // none: a quarter
    EXPECT_LT(smooth, linear / 3) << seed;
    RecordProperty("jump_linear_" + std::to_string(seed), std::to_string(linear));
    RecordProperty("jump_smooth_" + std::to_string(seed), std::to_string(smooth));
  }
}

TEST_F(Render, OtherOutputs) {
  Stage stage(unit_square());
  const glm::dvec2 kappa(3, 4);
  stage.plane_wave(kappa, 0.01, 0.4);
  stage.view.view_projection = glm::ortho(0.0, 1.0, 0.0, 1.0, -10.0, 10.0);
  const Picture amplitude = stage.aov(Aov::amplitude, 64, 64), phase = stage.aov(Aov::phase, 64, 64),
                direction = stage.aov(Aov::direction, 64, 64), depth = stage.aov(Aov::depth, 64, 64);
  for (int y = 1; y < 64; y += 7) {
    for (int x = 1; x < 64; x += 7) {
      const glm::dvec2 p = under(phase, x, y);
      EXPECT_NEAR(amplitude.colour(x, y).x, 0.01, 1e-7);
      EXPECT_NEAR(test::wrap_radians(phase.colour(x, y).x - (2 * pi * glm::dot(kappa, p) + 0.4)), 0, 1e-4);
      EXPECT_LT(glm::distance(direction.colour(x, y), glm::dvec3(0.6, 0.8, 0)), 1e-5);
      EXPECT_NEAR(depth.colour(x, y).x, 1000, 1e-3);  // along the view, from the eye
    }
  }
}

// --- light
// ------------------------------------------------------------------------------------------------------------------

TEST_F(Render, FlatColoursAreLinearLightStoredAsSrgb) {
  Stage stage(unit_square());
  for (const double albedo : {0.0, 0.001, 0.02, 0.18, 0.35, 0.7}) {
    stage.parts[0].base_colour = glm::vec4(glm::vec3(static_cast<float>(albedo)), 1);
    stage.view.ambient = {1, 0.5, 0.25};
    const glm::dvec3 colour = stage.draw(8, 8).colour(4, 4);
    // N·up = 1: ambient A(.6 + .4). One level of 255 for the driver's own conversion.
    EXPECT_NEAR(colour.x, srgb(albedo), 1.01) << albedo;
    EXPECT_NEAR(colour.y, srgb(0.5 * albedo), 1.01) << albedo;
    EXPECT_NEAR(colour.z, srgb(0.25 * albedo), 1.01) << albedo;
  }
  stage.parts[0].base_colour = {0.5F, 0.5F, 0.5F, 1};
  stage.view.ambient = glm::dvec3(1);
  stage.view.up = {0, 1, 0};  // N·up = 0
  EXPECT_NEAR(stage.draw(8, 8).colour(4, 4).x, srgb(0.3), 1.01);
  stage.view.ambient = glm::dvec3(4);  // 1.2: past the shoulder
  EXPECT_NEAR(stage.draw(8, 8).colour(4, 4).x, srgb(shoulder(1.2)), 1.01);
  stage.view.ambient = glm::dvec3(1e6);
  EXPECT_EQ(stage.draw(8, 8).colour(4, 4).x, 255);
}

TEST_F(Render, ALambertianTerminatorIsSoft) {
  Stage stage(unit_square());
  stage.look.roughness = 1;
  stage.view.ambient = glm::dvec3(0);
  stage.view.lights[1].colour = glm::dvec3(0.7);
  const auto at = [&](double degrees, float albedo) {
    const double angle = glm::radians(degrees);
    stage.parts[0].base_colour = glm::vec4(glm::vec3(albedo), 1);
    stage.view.lights[1].direction = {std::sin(angle), 0, std::cos(angle)};
    return stage.draw(4, 4).colour(2, 2).x;
  };
  const auto diffuse = [](double cosine) {
    const double x = std::clamp((cosine + 0.15) / 0.4, 0.0, 1.0);
    return std::max(0.0, (cosine + 0.15) / 1.15) * x * x * (3 - 2 * x);
  };
  // Fully rough: a₂ = 1, specular 1/π·(.04 + .96(1 − L·H)⁵)/(4 max((L·H)², .1))·d.
  for (const double degrees : {0.0, 30.0, 60.0, 80.0, 90.0, 95.0}) {
    const double angle = glm::radians(degrees), d = diffuse(std::cos(angle)), LH = std::cos(angle / 2);
    const double shine = (0.04 + 0.96 * std::pow(1 - LH, 5)) / (pi * 4 * std::max(LH * LH, 0.1)) * d;
    EXPECT_NEAR(at(degrees, 0.5F), srgb(0.7 * (0.5 * d + shine)), 1.5) << degrees;
  }
  EXPECT_EQ(at(100, 0.5F), 0);  // cos 100° < −.15
}

TEST_F(Render, BothSidesAreLitUnlessTheMaterialHasOne) {
  Stage stage(unit_square());
  const auto from_below = [&] {
    stage.view.eye = {0.5, 0.5, -1000};
    stage.view.forward = {0, 0, 1};
    stage.view.view_projection =
        glm::scale(glm::dmat4(1), {1, 1, -1}) * glm::ortho(1.0, 0.0, 0.0, 1.0, -10.0, 10.0);
  };
  EXPECT_LT(glm::distance(stage.aov(Aov::normal, 8, 8).colour(4, 4), glm::dvec3(0, 0, 1)), 1e-6);
  from_below();
  const Picture behind = stage.aov(Aov::normal, 8, 8);
  EXPECT_EQ(behind.alpha(4, 4), 1);
  EXPECT_LT(glm::distance(behind.colour(4, 4), glm::dvec3(0, 0, -1)), 1e-6);
  // A crest seen from behind is a valley: the slope keeps its place in the world and turns with the normal.
  stage.plane_wave({1, 0}, 0.05, pi / 2);
  const glm::dvec3 n = stage.aov(Aov::normal, 9, 9).colour(4, 4);
  const double slope = -2 * pi * 0.05 * std::sin(2 * pi * 0.5 + pi / 2);
  EXPECT_LT(glm::distance(n, -glm::normalize(glm::dvec3(-slope, 0, 1))), 1e-3);
  stage.parts[0].two_sided = false;
  EXPECT_EQ(stage.aov(Aov::normal, 8, 8).alpha(4, 4), 0);
}

TEST_F(Render, ValleysSeeLessOfTheSky) {
  Stage stage(unit_square());
  stage.parts[0].base_colour = {0.5F, 0.5F, 0.5F, 1};
  stage.look.cavity = 1;
  stage.view.up = {0, 1, 0};  // waves run along x: N·up = 0 everywhere
  constexpr double kappa = 4, amplitude = 0.04;
  stage.plane_wave({kappa, 0}, amplitude, 0);
  const Picture picture = stage.draw(256, 4);
  // On the valley's floor 1 − (1 − cos ψ), ψ the walls' angle; on the crest everything.
  const double q = 2 * pi * amplitude * kappa;
  EXPECT_NEAR(picture.colour(64, 2).x, srgb(0.3), 1.5);                         // x = ¼: crest
  EXPECT_NEAR(picture.colour(32, 2).x, srgb(0.3 / std::sqrt(1 + q * q)), 1.5);  // x = ⅛: valley
  stage.look.cavity = 0;
  EXPECT_NEAR(stage.draw(256, 4).colour(32, 2).x, srgb(0.3), 1.01);
}

// --- coverage and transparency
// ------------------------------------------------------------------------------------------------

TEST_F(Render, FourSamplesAverageLightAtAnEdge) {
  // The sheet ends in the middle of pixel column 10 of 32. OpenGL's four samples stand at eighths with two on
  // either side.
  Stage stage(
      test::sheet({{-1, -1, 0}, {10.5 / 32, -1, 0}, {10.5 / 32, 2, 0}, {-1, 2, 0}}, {0, 1, 2, 0, 2, 3}));
  stage.parts[0].base_colour = {0.8F, 0.8F, 0.8F, 1};
  const Picture four = stage.draw(32, 8, 4);
  for (int y = 0; y < 8; ++y) {
    EXPECT_NEAR(four.colour(9, y).x, srgb(0.8), 1.01);
    EXPECT_NEAR(four.colour(10, y).x, srgb(0.4),
                1.5);  // averaging stored values would give half of srgb(.8), 116
    EXPECT_EQ(four.colour(11, y).x, 0);
  }
}

TEST_F(Render, CoverageOfATriangleIsItsArea) {
  Stage stage(test::sheet({{0.1, 0.13, 0}, {0.91, 0.2, 0}, {0.37, 0.88, 0}}, {0, 1, 2}));
  stage.parts[0].base_colour = {0.7F, 0.7F, 0.7F, 1};
  stage.look.transparent = true;
  const double area = 0.5 * ((0.91 - 0.1) * (0.88 - 0.13) - (0.37 - 0.1) * (0.2 - 0.13));
  for (const int samples : {1, 4}) {
    const Picture picture = stage.draw(100, 100, samples);
    double covered = 0;
    int between = 0;
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 100; ++x) {
        covered += picture.alpha(x, y) / 255 / 10000;
        between += picture.alpha(x, y) > 0 && picture.alpha(x, y) < 255 ? 1 : 0;
      }
    }
    // About 250 pixels on the outline, each off by up to ½ with random sign: √250/4 of 10,000.
    EXPECT_NEAR(covered, area, 1e-3) << samples;
    EXPECT_EQ(between > 100, samples == 4) << between;
  }
}

TEST_F(Render, BackgroundsAreColourOrNothing) {
  Stage stage(test::sheet({{2, 2, 0}, {3, 2, 0}, {2, 3, 0}}, {0, 1, 2}));  // out of view
  stage.look.background = {0.5, 0.25, 0.05};
  const Picture filled = stage.draw(4, 4, 4);
  EXPECT_NEAR(filled.colour(1, 1).x, srgb(0.5), 1.01);
  EXPECT_NEAR(filled.colour(1, 1).y, srgb(0.25), 1.01);
  EXPECT_NEAR(filled.colour(1, 1).z, srgb(0.05), 1.01);
  EXPECT_EQ(filled.alpha(1, 1), 255);
  stage.look.transparent = true;
  EXPECT_EQ(stage.draw(4, 4, 4).alpha(1, 1), 0);
}

TEST_F(Render, AlphaBlendsOverWhatIsBehind) {
  // A half-clear sheet over a dark background: linear light, half of each.
  Stage stage(unit_square());
  stage.parts[0].base_colour = {0.6F, 0.6F, 0.6F, 0.5F};
  stage.parts[0].has_alpha = true;
  stage.look.background = glm::dvec3(0.2);
  EXPECT_NEAR(stage.draw(4, 4).colour(2, 2).x, srgb(0.5 * 0.6 + 0.5 * 0.2), 1.01);
  // Opaque materials ignore their alpha.
  stage.parts[0].has_alpha = false;
  EXPECT_NEAR(stage.draw(4, 4).colour(2, 2).x, srgb(0.6), 1.01);
  // On nothing: premultiplied colour and the alpha itself.
  stage.parts[0].has_alpha = true;
  stage.look.transparent = true;
  stage.look.background = glm::dvec3(0);
  const Picture clear = stage.draw(4, 4);
  EXPECT_NEAR(clear.alpha(2, 2), 127.5, 1.01);
  EXPECT_NEAR(clear.colour(2, 2).x, srgb(0.3), 1.01);
}

// A dark veil that lets hardly anything of the ground through: that little is still the ground's, to a step
// of 255.
TEST_F(Render, ADarkVeilOverTheGround) {
  for (const int samples : {1, 4}) {
    Stage stage(unit_square());
    stage.look.ground = true;
    stage.look.background = glm::dvec3(0.6);
    stage.view.up = {0, 1, 0};
    stage.parts[0].has_alpha = true;
    stage.view.ambient = glm::dvec3(0);
    stage.look.sheen = 0;
    stage.parts[0].base_colour = {0, 0, 0, 0};
    const Picture bare = stage.draw(16, 16, samples);
    for (const float alpha : {0.5F, 0.9745F, 0.99F}) {
      stage.parts[0].base_colour.a = alpha;
      const Picture veiled = stage.draw(16, 16, samples);
      const double behind = srgb_to_linear(bare.colour(8, 8).x / 255);
      EXPECT_NEAR(veiled.colour(8, 8).x, srgb((1 - static_cast<double>(alpha)) * behind), 1.01) << alpha;
    }
  }
}

TEST_F(Render, TheFarWallOfAVeilIsBlendedFirst) {
  // The near wall, which is listed first, is seen from in front, the far one from behind, as of a tube.
  Stage stage(
      test::sheet({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                  {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6}));
  auto& vertices = stage.sheet.surface.render_vertices;
  for (auto& vertex : vertices) vertex.colour = glm::vec4(glm::vec3(vertex.welded < 4 ? 0.8F : 0.2F), 1);
  stage.sheet.surface.parts.resize(1);
  stage.sheet.surface.parts[0].has_colours = true;
  stage.parts[0].has_colours = true;
  stage.parts[0].has_alpha = true;
  stage.parts[0].base_colour = {1, 1, 1, 0.5F};
  EXPECT_NEAR(stage.draw(4, 4).colour(2, 2).x, srgb(0.5 * 0.8 + 0.5 * 0.5 * 0.2), 1.01);
  // Of a part with one side the far wall is not drawn at all.
  stage.parts[0].two_sided = false;
  EXPECT_NEAR(stage.draw(4, 4).colour(2, 2).x, srgb(0.5 * 0.8), 1.01);
}

// --- textures
// ----------------------------------------------------------------------------------------------------------------

// Left half dark, right half light, 64 texels wide.
std::vector<TextureLevel> two_halves(std::uint8_t alpha_left = 255) {
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::uint8_t value = x < 32 ? 60 : 200;
      rgba.insert(rgba.end(), {value, value, value, x < 32 ? alpha_left : std::uint8_t{255}});
    }
  }
  return mip_levels(64, 64, rgba);
}

TEST_F(Render, TexturesStandUpright) {
  // Four quarters of their own colour, the file's first row on top; uv (0, 1) is the picture's upper left
  // corner.
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const bool right = x >= 8, below = y >= 8;
      const auto on = [](bool value) { return static_cast<std::uint8_t>(value ? 255 : 0); };
      rgba.insert(rgba.end(), {on(right == below), on(right), on(below && !right), 255});
    }
  }
  Stage stage(test::sheet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}));
  stage.textures = {mip_levels(16, 16, rgba)};
  stage.parts[0].texture = 0;
  stage.view.ambient = glm::dvec3(0.7);  // below the shoulder
  const Picture picture = stage.draw(64, 64);
  const double full = srgb(0.7);
  const auto expect = [&](int x, int y, const glm::dvec3& colour) {
    EXPECT_LT(glm::distance(picture.colour(x, y), colour * full), 3) << x << "," << y;
  };
  expect(16, 16, {1, 0, 0});
  expect(47, 16, {0, 1, 0});
  expect(16, 47, {0, 0, 1});
  expect(47, 47, {1, 1, 0});
}

TEST_F(Render, MipLevelsAverageLight) {
  const auto levels = mip_levels(2, 1, {255, 255, 255, 255, 0, 0, 0, 255});
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[1].width, 1);
  EXPECT_NEAR(static_cast<int>(levels[1].rgba[0]), srgb(0.5), 0.51);  // 188, not 128
  // Clear texels lend no colour.
  const auto clear = mip_levels(2, 1, {255, 0, 0, 255, 0, 255, 0, 0});
  EXPECT_EQ(static_cast<int>(clear[1].rgba[0]), 255);
  EXPECT_EQ(static_cast<int>(clear[1].rgba[1]), 0);
  EXPECT_NEAR(static_cast<int>(clear[1].rgba[3]), 127.5, 0.51);
  // Odd sizes come down to one texel.
  const auto odd = mip_levels(5, 3, std::vector<std::uint8_t>(60, 100));
  EXPECT_EQ(odd.back().width * odd.back().height, 1);
  EXPECT_EQ(static_cast<int>(odd.back().rgba[0]), 100);
}

TEST_F(Render, MipLevelsOfNormalsAreLinear) {
  // Two slopes that cancel: 0 and 255 average to 127.5 in each channel, not to the 188 of light.
  const auto levels = mip_levels(2, 1, {255, 0, 200, 255, 0, 255, 200, 255}, false);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_FALSE(levels[1].srgb);
  EXPECT_NEAR(static_cast<int>(levels[1].rgba[0]), 127.5, 0.51);
  EXPECT_NEAR(static_cast<int>(levels[1].rgba[1]), 127.5, 0.51);
  EXPECT_EQ(static_cast<int>(levels[1].rgba[2]), 200);
}

TEST_F(Render, MasksCut) {
  Stage stage(test::sheet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}));
  stage.textures = {two_halves(100)};
  stage.parts[0].texture = 0;
  stage.parts[0].alpha_cutoff = 0.5F;
  const Picture picture = stage.draw(64, 64);
  EXPECT_EQ(picture.colour(10, 32).x, 0);  // 100/255 is below ½
  EXPECT_GT(picture.colour(50, 32).x, 100);
  stage.parts[0].alpha_cutoff = 0.3F;
  EXPECT_GT(stage.draw(64, 64).colour(10, 32).x, 30);
}

// Eq. 10: a point raised by h and seen at 45° shows the texture of a place .8333 h nearer to the viewer
// (wrinkle-passes.md, "Render": .8333 of eq. 9, whose shift there is h).
TEST_F(Render, ParallaxShiftsTowardTheViewer) {
  Stage stage(test::sheet({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}));
  stage.textures = {two_halves()};
  stage.parts[0].texture = 0;
  stage.look.cavity = 0;
  constexpr int width = 1000;
  const auto edge_at = [&](double height, double eye_side, double parallax) {
    stage.look.parallax = parallax;
    // From the side `eye_side`·x, at 45°; across the picture runs x, as seen from above: the projection drops
    // z.
    stage.view.eye = glm::dvec3(0.5 + eye_side * 1e4, 0.5, 1e4);
    stage.view.forward = glm::normalize(glm::dvec3(-eye_side, 0, -1));
    // A wave a thousand units long, on its crest or in its valley everywhere.
    stage.plane_wave({1e-3, 0}, std::abs(height), height < 0 ? pi : 0);
    stage.view.view_projection = glm::ortho(0.0, 1.0, 0.4985, 0.5015, -10.0, 10.0);  // square pixels
    const Picture picture = stage.draw(width, 3);
    // Half way between the halves in linear light, where the texture is filtered.
    const auto linear = [](double byte) { return std::pow((byte / 255 + 0.055) / 1.055, 2.4); };
    const double threshold = srgb(0.5 * (linear(60) + linear(200)));
    int x = 100;
    while (x < 900 && picture.colour(x, 1).x < threshold) ++x;
    return (x + 0.5) / width;  // where the texture's edge at u = ½ is seen
  };
  EXPECT_NEAR(edge_at(0, 1, 1), 0.5, 2e-3);
  // The texture seen at x is that of x + .8333 h·side, so the edge moves the other way. Two pixels for the
  // texture's own filtering (a texel is 16 pixels wide, its middle known to a few).
  for (const double side : {1.0, -1.0}) {
    for (const double height : {0.06, -0.06}) {
      EXPECT_NEAR(edge_at(height, side, 1), 0.5 - side * 0.8333 * height, 4e-3) << side << " " << height;
    }
    EXPECT_NEAR(edge_at(0.06, side, 0), 0.5, 2e-3);
    EXPECT_NEAR(edge_at(0.06, side, 0.5), 0.5 - side * 0.5 * 0.8333 * 0.06, 4e-3);
  }
}

TEST_F(Render, ShadowsTakeTheKeyLightAlone) {
  // A plate .3 above a floor, the key light at 45° from +x: the shadow falls .3 to −x of the plate.
  const auto quad = [](double low, double high, double z) {
    return std::vector<glm::dvec3>{{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}};
  };
  auto points = quad(-1, 1, 0);
  for (const auto& x : quad(-0.2, 0.2, 0.3)) points.push_back(x);
  Stage stage(test::sheet(points, {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}));
  stage.window({-1, -1}, {1, 1});
  stage.look.shadows = true;
  stage.look.roughness = 1;
  stage.parts[0].base_colour = {0.5F, 0.5F, 0.5F, 1};
  stage.view.ambient = glm::dvec3(0.2);
  stage.view.lights[0].colour = glm::dvec3(1);
  stage.view.lights[0].direction = glm::normalize(glm::dvec3(1, 0, 1));
  stage.view.bounds_centre = {0, 0, 0.15};
  stage.view.bounds_radius = 1.5;
  const Picture picture = stage.draw(200, 200);
  const auto at = [&](double x, double y) {
    return picture.colour(static_cast<int>(100 + 100 * x), static_cast<int>(100 - 100 * y)).x;
  };
  const double shaded = srgb(0.1), lit = at(0.8, 0.8);
  EXPECT_GT(lit, shaded + 60);
  // On the floor the shadow covers x = −.5 … −.1; the plate hides −.2 … .2. A texel of the map is .003 wide.
  for (const double y : {-0.15, 0.0, 0.15}) {
    EXPECT_NEAR(at(-0.3, y), shaded, 1.5) << y;
    EXPECT_NEAR(at(-0.48, y), shaded, 1.5) << y;
    EXPECT_NEAR(at(-0.54, y), lit, 1.5) << y;
    EXPECT_NEAR(at(0.25, y), lit, 1.5) << y;
    EXPECT_NEAR(at(0, y), lit, 1.5) << y;  // the plate itself
  }
  EXPECT_NEAR(at(-0.3, 0.25), lit, 1.5);
  stage.look.shadows = false;
  const Picture without = stage.draw(200, 200);
  EXPECT_NEAR(without.colour(70, 100).x, lit, 1.5);
}

TEST_F(Render, PlainDrawsTheSameSurfaceWithoutWaves) {
  Stage stage(unit_square());
  stage.view.lights[0].colour = glm::dvec3(0.6);
  stage.view.lights[0].direction = glm::normalize(glm::dvec3(1, 0, 1));
  const Picture flat = stage.draw(32, 32);
  stage.plane_wave({4, 0}, 0.03, 0);
  const Picture waves = stage.draw(32, 32);
  stage.look.plain = true;
  const Picture plain = stage.draw(32, 32);
  EXPECT_NE(waves.rgba, flat.rgba);
  for (std::size_t i = 0; i < plain.rgba.size(); ++i) EXPECT_NEAR(plain.rgba[i], flat.rgba[i], 1);
}

TEST_F(Render, GroundAndWireframeOnlyAdd) {
  Stage stage(test::sheet({{-0.5, 0.5, -0.5}, {0.5, 0.5, -0.5}, {0.5, 0.5, 0.5}, {-0.5, 0.5, 0.5}},
                          {0, 2, 1, 0, 3, 2}));
  stage.look.background = glm::dvec3(0.5);
  stage.look.ground = true;
  stage.parts[0].base_colour = {0.3F, 0.3F, 0.3F, 1};
  stage.view.up = {0, 1, 0};
  stage.view.eye = {0, 2, 4};
  stage.view.forward = glm::normalize(glm::dvec3(0, -1.75, -4));
  stage.view.bounds_centre = {0, 0.25, 0};
  stage.view.bounds_radius = 0.8;
  stage.view.floor = 0.45;  // the plate hangs .05 above the floor
  stage.view.lights[0].direction = {0, 1, 0};
  stage.view.lights[0].colour = glm::dvec3(0.5);
  stage.view.view_projection =
      glm::perspective(0.6, 1.0, 0.1, 50.0) * glm::lookAt(stage.view.eye, {0, 0.25, 0}, {0, 1, 0});
  const Picture with = stage.draw(128, 128);
  // Far from the plate: the background, a little brighter in the middle and darker in the corners, without
  // hard edges.
  const double plain = srgb(0.5);
  EXPECT_NEAR(with.colour(2, 2).x, plain, 0.2 * plain);
  EXPECT_NEAR(with.colour(64, 2).x, plain, 0.2 * plain);
  for (int x = 1; x < 128; ++x) EXPECT_NEAR(with.colour(x, 1).x, with.colour(x - 1, 1).x, 4) << x;
  for (const float value : with.rgba) EXPECT_TRUE(value >= 0 && value <= 255);
  // Under the plate's near edge, which is seen, the floor is darker than without the plate.
  const glm::dvec4 under_plate = stage.view.view_projection * glm::dvec4(0, 0.45, 0.45, 1);
  const int px = static_cast<int>((under_plate.x / under_plate.w * 0.5 + 0.5) * 128);
  const int py = static_cast<int>((0.5 - under_plate.y / under_plate.w * 0.5) * 128);
  Stage empty = stage;
  for (const auto& x : stage.sheet.surface.rest) empty.positions.push_back(x + glm::dvec3(0, 100, 0));
  const Picture without = empty.draw(128, 128);
  EXPECT_LT(with.colour(px, py).x, without.colour(px, py).x - 15);
  EXPECT_NEAR(with.colour(2, 2).x, without.colour(2, 2).x, 1);
  stage.look.wireframe = true;
  const Picture lines = stage.draw(128, 128);
  int darker = 0;
  for (std::size_t i = 0; i < lines.rgba.size(); i += 4) darker += lines.rgba[i] < with.rgba[i] - 20 ? 1 : 0;
  EXPECT_GT(darker, 60);
  EXPECT_LT(darker, 1500);
}

}  // namespace
}  // namespace plisse::passes
