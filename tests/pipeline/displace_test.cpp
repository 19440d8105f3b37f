// The wrinkles of a scene as geometry: the square's heights and normals, and how far shading is from them.
#include "pipeline/displace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/scene_file.h"
#include "passes/displacement.h"
#include "pipeline/history.h"
#include "pipeline/look.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

class Displace : public test::OpenGlTest {};

// The normals that the small triangles themselves have, summed by area round each position.
std::vector<glm::dvec3> geometric_normals(const Subdivision& mesh, const DisplacedSurface& surface) {
  std::vector<glm::dvec3> normals(mesh.position_count, glm::dvec3(0));
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::uint32_t id[3];
    for (std::size_t c = 0; c < 3; ++c) id[c] = mesh.vertices[mesh.triangles[3 * t + c]].position;
    const auto& x = surface.positions;
    const glm::dvec3 area = glm::cross(x[id[1]] - x[id[0]], x[id[2]] - x[id[0]]);
    for (const std::uint32_t v : id) normals[v] += area;
  }
  for (auto& n : normals) n = glm::normalize(n);
  return normals;
}

// The same by the pass: what it wrote is read back.
DisplacedSurface moved_by_the_pass(History& run, const Subdivision& mesh) {
  passes::SurfaceBuffers buffers(run.scene.surface(), mesh);
  const passes::Look look = pipeline::look_of(run.scene);
  passes::DisplacementPass pass(mesh, run.scene.profile, look.smooth_blend, look.field, look.cavity, "");
  pass.run(run.stepper.surface(), buffers);
  DisplacedSurface result;
  for (const glm::vec4& x : buffers.positions.read<glm::vec4>()) result.positions.emplace_back(x);
  for (const glm::vec4& r : buffers.relief.read<glm::vec4>()) result.relief.emplace_back(r);
  result.normals.resize(mesh.normal_count);
  const auto vertices = buffers.render_vertices.read<glm::vec4>();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    result.normals[mesh.vertices[v].normal] = glm::dvec3(vertices[2 * v]);
  return result;
}

// Squeezed to 75 and 50 %, waves of .16536 and .21651 W along x (wrinkle-passes.md, "Ground truth").
TEST_F(Displace, TheSquareRisesAsTheClosedFormSays) {
  History run(config::load_scene(test::asset("square.toml")));
  const double W = run.scene.wavelength() / run.scene.units.metres;
  const pipeline::Displacement displacement(run.scene, subdivide(run.scene.surface(), 16));
  for (const auto& [frame, height] : {std::pair(49, 0.16536), std::pair(73, 0.21651)}) {
    run.at(frame);
    for (const bool by_the_pass : {false, true}) {
      const DisplacedSurface surface =
          by_the_pass ? moved_by_the_pass(run, displacement.mesh()) : displacement.at(run.stepper.surface());
      double highest = 0, squares = 0;
      for (const glm::dvec4& relief : surface.relief) {
        highest = std::max(highest, std::abs(relief.x));
        squares += relief.x * relief.x / static_cast<double>(surface.relief.size());
        EXPECT_NEAR(relief.y, height * W, 1e-5 * W);
      }
      EXPECT_LE(highest, height * W * (1 + 1e-5));
      EXPECT_GT(highest, 0.99 * height * W);
      // A sine has the mean square ½; the rim cuts waves short (3 %), and phases that differ by up to a
      // fifteenth of a turn take some height between vertices.
      EXPECT_NEAR(squares / (height * height * W * W), 0.5, 0.05) << frame;
      // Flat, so each point moved straight up.
      for (std::size_t i = 0; i < surface.positions.size(); ++i)
        EXPECT_NEAR(std::abs(surface.positions[i].z - surface.positions[0].z),
                    std::abs(surface.relief[i].x - surface.relief[0].x), 1e-6 * W);
    }
  }
}

// Every way in which the shader is compiled: tables, finer waves, both blends, several materials; on a bent
// surface.
TEST_F(Displace, ThePassAgreesWithTheReferenceSlow) {
  for (const char* variant : {"plain", "accordion", "fine", "linear"}) {
    config::SceneSettings settings = config::load_scene(test::asset("sleeve.toml"));
    const std::string name = variant;
    if (name == "accordion") settings.wrinkles.profile = "accordion";
    if (name == "fine") settings.wrinkles.fine = 3;
    if (name == "linear") settings.shading.blend = config::Blend::linear;
    History run(settings);
    run.at(37);
    const Subdivision mesh = pipeline::split_as_needed(run.scene);
    const DisplacedSurface expected = pipeline::Displacement(run.scene, mesh).at(run.stepper.surface()),
                           surface = moved_by_the_pass(run, mesh);
    const double W = run.scene.wavelength() / run.scene.units.metres;
    double place = 0, relief = 0, normal = 0;
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
      place = std::max(place, glm::distance(surface.positions[i], expected.positions[i]));
      relief = std::max({relief, std::abs(surface.relief[i].x - expected.relief[i].x) / W,
                         std::abs(surface.relief[i].y - expected.relief[i].y) / W});
    }
    for (std::size_t i = 0; i < surface.normals.size(); ++i)
      normal += glm::distance(surface.normals[i], expected.normals[i]) /
                static_cast<double>(surface.normals.size());
    // Single precision of positions up to one unit, waves of a few turns over an edge: 1e-6 turns are 6e-6 of
    // a height, ten times as much of a slope; tables are interpolated by the driver in eight bits of a step,
    // 1/256 of 1/1024.
    EXPECT_LT(place, 2e-5) << variant;
    EXPECT_LT(relief, 1e-4) << variant;
    EXPECT_LT(normal, 1e-4) << variant;
  }
}

TEST_F(Displace, OnlyClothThatWavesIsSplit) {
  config::SceneSettings settings = config::load_scene(test::asset("sleeve.toml"));
  settings.wrinkles.irregularity = 0;
  const pipeline::LoadedScene everywhere(settings);
  const Subdivision needed = pipeline::split_as_needed(everywhere);
  const std::size_t evenly = everywhere.surface().triangle_count() << 2 * levels_for(everywhere);
  EXPECT_LT(needed.triangle_count(), evenly);
  // No edge of a wave has fewer than eight segments.
  const Surface& surface = everywhere.surface();
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = [&](std::size_t k) {
        return surface.render_vertices[surface.triangles[3 * t + k % 3]].welded;
      };
      if (everywhere.waves.mask[at(c)] > 0 || everywhere.waves.mask[at(c + 1)] > 0)
        longest = std::max(longest, glm::distance(surface.rest[at(c)], surface.rest[at(c + 1)]));
    }
    const int segments = needed.points[needed.first_point[t]].segments;
    EXPECT_GE(segments, std::min(8 * longest / everywhere.wavelength(), 128.0)) << t;
    EXPECT_LT(segments, std::max(16 * longest / everywhere.wavelength() * (1 + 1e-9), 1.1)) << t;
  }
  // A part that is left out stays as it is; pictures of a few pixels need little.
  settings.wrinkles.strength = 0;
  EXPECT_EQ(pipeline::split_as_needed(pipeline::LoadedScene(settings)).triangle_count(),
            surface.triangle_count());
  settings.wrinkles.strength = 1;
  settings.output.width = 32;
  settings.output.height = 24;
  EXPECT_LT(pipeline::split_as_needed(pipeline::LoadedScene(settings)).triangle_count(),
            needed.triangle_count() / 8);
}

TEST_F(Displace, NormalsAreThoseOfTheFineMeshAndConvergeToThem) {
  History run(config::load_scene(test::asset("square.toml")));
  run.at(49);
  double last = 10;
  for (const int levels : {4, 5, 6}) {
    const pipeline::Displacement displacement(run.scene, subdivide(run.scene.surface(), 1 << levels));
    const DisplacedSurface surface = displacement.at(run.stepper.surface());
    const auto geometric = geometric_normals(displacement.mesh(), surface);
    double sum = 0;
    for (const FineVertex& vertex : displacement.mesh().vertices)
      sum += std::acos(std::min(1.0, glm::dot(surface.normals[vertex.normal], geometric[vertex.position])));
    const double mean = glm::degrees(sum / static_cast<double>(displacement.mesh().vertices.size()));
    EXPECT_LT(mean, 0.6 * last) << levels;  // first order at the rim, second inside: better than halved
    last = mean;
  }
  EXPECT_LT(last, 0.5);  // degrees, at 64 segments an edge
}

TEST_F(Displace, LevelsFollowTheWaves) {
  config::SceneSettings settings = config::load_scene(test::asset("square.toml"));
  const int levels = levels_for(pipeline::LoadedScene(settings));
  for (const int finer : {1, 2}) {
    config::SceneSettings shorter = settings;
    shorter.wrinkles.wavelength = settings.wrinkles.wavelength / (1 << finer);
    EXPECT_EQ(levels_for(pipeline::LoadedScene(shorter)), levels + finer);
  }
  settings.wrinkles.strength = 0;
  EXPECT_EQ(levels_for(pipeline::LoadedScene(settings)), 0);
}

}  // namespace
}  // namespace plisse::pipeline
