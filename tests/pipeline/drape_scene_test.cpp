// What scenes of plisse drape become before anything is solved.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipeline/drape_garment.h"
#include "pipeline/drape_setup.h"
#include "pipeline/drape_skirt.h"
#include "support/files.h"

namespace plisse::test {
namespace {

// Two squares, cut apart in the rest mesh, that cur_mesh sews along x = 1: its faces are taken, the start is
// the rest pieces with the seam halfway between its two sides.
TEST(DrapeScene, SetUpsAreSewnAsCurMeshSays) {
  const TemporaryFolder folder;
  write_text(folder / "rest.obj",
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1.2 0 0\nv 2 0 0\nv 2 1 0\nv 1.2 1 0\n"
             "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n");
  write_text(folder / "now.obj",
             "v 9 0 0\nv 9 0 0\nv 9 1 0\nv 9 1 0\nv 9 0 0\nv 9 1 0\n"
             "f 1 2 3\nf 1 3 4\nf 2 5 6\nf 2 6 3\n");
  write_text(folder / "setup.json",
             R"({"youngs_modulus": 1e6, "poisson_ratio": 0.3, "thickness": 1e-3, "rest_mesh": "rest.obj",
                 "cur_mesh": "now.obj"})");
  const DrapeScene scene = load_drape(folder / "setup.json");
  ASSERT_EQ(scene.start.cols(), 6);
  EXPECT_EQ(scene.faces[3], (shell::Face{1, 5, 2}));
  const Eigen::Matrix<double, 1, 6> x = scene.start.row(0);
  EXPECT_TRUE(x.isApprox((Eigen::Matrix<double, 1, 6>() << 0, 1.1, 1.1, 0, 2, 2).finished())) << x;
}

// A body of our own making: closed, of 27,000 triangles, and it moves without going through itself.
TEST(DrapeScene, TheTorsoIsABody) {
  const auto faces = torso_faces();
  EXPECT_EQ(faces.size(), 27000U);
  for (const double t : {0.0, 0.25, 0.75, 1.0}) {
    const shell::Positions points = torso_points(t);
    const shell::TriangleBody body(points, faces, "torso");
    // Turned and sheared level by level it keeps its volume, some .05 m³ for a trunk of 1.1 m.
    EXPECT_NEAR(shell::enclosed_volume(faces, points), shell::enclosed_volume(faces, torso_points(0)), 2e-5);
    EXPECT_NEAR(shell::enclosed_volume(faces, points), 0.05, 0.02);
  }
}

// Panels bent round a cylinder lie on it, at the height they have in the flat.
TEST(DrapeScene, GarmentsAreWrapped) {
  sizing::Garment garment;
  sizing::Panel panel;
  panel.fabric = sizing::fabrics().front();
  panel.outline = {{{-0.3, 0}, {0.3, 0}, {0.3, 0.2}, {-0.3, 0.2}}, true};
  garment.panels = {panel, panel};
  garment.seams = {{"side", {0, {0.3, 0}, {0.3, 0.2}}, {1, {-0.3, 0}, {-0.3, 0.2}}}};
  garment.placements.resize(2);
  garment.placements[1].rotation = sizing::turned_by({0, 180, 0});
  for (auto& placement : garment.placements) placement.translation = {1, 2, 3};
  const SewnGarment sewn = sew_garment(garment, 200, 1);
  EXPECT_NEAR(sewn.count, 200, 10);
  EXPECT_LT(sewn.count, sewn.base_of.size());
  const double radius = 0.6 / std::numbers::pi;  // half of the way round is a panel's width: the seam meets
  const shell::Positions start = placed(sewn, garment, radius);
  for (Eigen::Index v = 0; v < start.cols(); ++v)
    EXPECT_NEAR(std::hypot(start(0, v) - 1, start(2, v) - 3), radius, 1e-6);  // the mesher rounds to 1e-7
  EXPECT_NEAR(start.row(1).minCoeff(), 2, 1e-6);
  EXPECT_NEAR(start.row(1).maxCoeff(), 2.2, 1e-6);
}

}  // namespace
}  // namespace plisse::test
