// What scenes of plisse drape become before anything is solved.
#include <gtest/gtest.h>

#include "pipeline/drape_setup.h"
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

}  // namespace
}  // namespace plisse::test
