// Fields that are drawn directly against the geometry that plisse wrinkle --mesh makes of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/eigen_glm.h"
#include "config/scene_file.h"
#include "io/wrinkle_field.h"
#include "mesh/triangle_tree.h"
#include "pipeline/displace.h"
#include "pipeline/history.h"
#include "pipeline/verify.h"
#include "support/files.h"
#include "support/opengl.h"
#include "wrinkle/upsample.h"

namespace plisse::pipeline {
namespace {

using std::numbers::pi;

// A quarter of a tube in 10 × 8 cells, with waves of four edges whose height swells toward the middle: longer
// than triangles, so that a drawing that is linear in them shows the mesh.
class SmoothFields : public test::OpenGlTest {
 protected:
  SmoothFields() {
    constexpr int columns = 10, rows = 8;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) {
        const double angle = pi / 2 * i / columns, along = 0.04 * j;
        field_.positions.emplace_back(0.25 * std::cos(angle), along, 0.25 * std::sin(angle));
        field_.amplitude.push_back(0.008 * std::sin(pi * (j + 1) / (rows + 2)) *
                                   std::sin(pi * (i + 1) / (columns + 2)));
      }
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const auto v = static_cast<std::uint32_t>(j * (columns + 1) + i), up = v + columns + 1;
        field_.triangles.push_back({v, up + 1, v + 1});
        field_.triangles.push_back({v, up, up + 1});
      }
    for (const auto& t : field_.triangles) {
      auto& own = field_.phase.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const double i = t[c] % (columns + 1), j = t[c] / (columns + 1);
        own[c] = pi / 2 * i + 0.3 * std::sin(0.5 * j);
      }
    }
    io::write_wrinkle_field(folder_ / "field.ply", field_);
    std::string obj;
    for (const glm::dvec3& x : field_.positions)
      obj += fmt::format("v {:.9g} {:.9g} {:.9g}\n", x.x, x.y, x.z);
    for (const auto& t : field_.triangles) obj += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    test::write_text(folder_ / "base.obj", obj);
  }
  config::SceneSettings scene() const {
    return config::parse_scene(
        "[model]\npath = \"base.obj\"\n[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n[output]\nsize = "
        "\"96x80\"\n",
        folder_ / "scene.toml");
  }
  // Degrees in the mean between the normals of the scene's geometry and those of the mesh where it is
  // nearest; `away`: the largest distance, m.
  double angle(int smooth, double& away) const {
    wrinkle::BaseSurface base;
    base.positions = points_to_eigen(field_.positions);
    base.topology =
        shell::build_topology({field_.triangles.begin(), field_.triangles.end()}, field_.positions.size());
    base.rest = shell::rest_faces(base.positions, base.topology.faces);
    const wrinkle::CoarseField coarse{
        Eigen::Map<const Eigen::VectorXd>(field_.amplitude.data(),
                                          static_cast<Eigen::Index>(field_.amplitude.size())),
        {field_.phase.begin(), field_.phase.end()}};
    const wrinkle::FineField fine = wrinkle::upsample(base, coarse, 4);
    const shell::Positions moved = wrinkle::displaced(fine);
    const Eigen::Matrix3Xd normals = wrinkle::vertex_normals(fine.faces, moved);
    const TriangleTree tree(moved, {fine.faces.begin(), fine.faces.end()});

    History run(scene(), smooth);
    run.at(1);
    const Displacement drawn(run.scene, subdivide(run.scene.surface(), 1 << (4 - run.scene.smooth_levels())));
    const DisplacedSurface surface = drawn.at(run.stepper.surface());
    std::vector<std::uint32_t> normal_of(surface.positions.size(), 0);
    for (const FineVertex& v : drawn.mesh().vertices) normal_of[v.position] = v.normal;
    double sum = 0;
    away = 0;
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
      const auto near = tree.nearest(to_eigen(drawn.metres(surface.positions[i])));
      const auto& t = tree.triangles()[near.triangle];
      Eigen::Vector3d n = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) n += near.weights[k] * normals.col(t[static_cast<std::size_t>(k)]);
      sum += std::acos(
          std::clamp(std::abs(n.normalized().dot(to_eigen(surface.normals[normal_of[i]]))), 0.0, 1.0));
      away = std::max(away, near.distance);
    }
    return sum / static_cast<double>(surface.positions.size()) * 180 / pi;
  }
  io::WrinkleField field_;
  test::TemporaryFolder folder_;
};

TEST_F(SmoothFields, AreTheMeshThatWrinkleWrites) {
  double away = 0, faceted_away = 0;
  const double smooth = angle(LoadedScene::most_smooth, away), faceted = angle(0, faceted_away);
  // What a quarter of an edge leaves: sagittas of (κ edge)²/8 of a sixteenth of an edge of both meshes, and
  // linear amplitudes.
  EXPECT_LT(smooth, 1);
  EXPECT_LT(away, 3e-4);  // waves are 16 mm high
  EXPECT_GT(faceted, 2 * smooth);
  EXPECT_GT(faceted_away, 2 * away);
}

TEST_F(SmoothFields, ShadersAndReferenceAgree) {
  RenderRequest request;
  request.scene = scene();
  const VerifyReport report = verify(request, {});
  EXPECT_TRUE(report.ok);
}

// `--levels` counts the levels that make a surface smooth: none is the model's own mesh.
TEST_F(SmoothFields, LevelsAreThoseOfTheModel) {
  EXPECT_EQ(LoadedScene(scene(), {}, smooth_levels_within(0)).surface().vertex_count(),
            field_.positions.size());
  EXPECT_EQ(LoadedScene(scene(), {}, smooth_levels_within(1)).surface().triangle_count(),
            4 * field_.triangles.size());
  EXPECT_EQ(LoadedScene(scene()).surface().triangle_count(), 16 * field_.triangles.size());
}

}  // namespace
}  // namespace plisse::pipeline
