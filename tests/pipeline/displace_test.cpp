// The wrinkles of a scene as geometry: the square's heights and normals, and how far shading is from them.
#include "pipeline/displace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/scene_file.h"
#include "pipeline/history.h"
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

// Squeezed to 75 and 50 %, waves of .16536 and .21651 W along x (wrinkle-passes.md, "Ground truth").
TEST_F(Displace, TheSquareRisesAsTheClosedFormSays) {
  History run(load_scene(test::asset("square.toml")));
  const double W = run.scene.wavelength() / run.scene.units.metres;
  const Displacement displacement(run.scene, 4);
  for (const auto& [frame, height] : {std::pair(49, 0.16536), std::pair(73, 0.21651)}) {
    run.at(frame);
    const DisplacedSurface surface = displacement.at(run.stepper.surface());
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

TEST_F(Displace, NormalsAreThoseOfTheFineMeshAndConvergeToThem) {
  History run(load_scene(test::asset("square.toml")));
  run.at(49);
  double last = 10;
  for (const int levels : {4, 5, 6}) {
    const Displacement displacement(run.scene, levels);
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
  SceneSettings settings = load_scene(test::asset("square.toml"));
  const int levels = levels_for(LoadedScene(settings));
  for (const int finer : {1, 2}) {
    SceneSettings shorter = settings;
    shorter.wrinkles.wavelength = settings.wrinkles.wavelength / (1 << finer);
    EXPECT_EQ(levels_for(LoadedScene(shorter)), levels + finer);
  }
  settings.wrinkles.strength = 0;
  EXPECT_EQ(levels_for(LoadedScene(settings)), 0);
}

}  // namespace
}  // namespace plisse::pipeline
