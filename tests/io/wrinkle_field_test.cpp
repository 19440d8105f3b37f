// Wrinkle fields from files: the TFW authors' texts by hand and on their disk, our PLY there and back, and
// what is wrong with broken ones.
#include "io/wrinkle_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::io {
namespace {

using ::testing::HasSubstr;
constexpr double turn = 2 * std::numbers::pi;

// Two triangles of a square; edges in lexicographic order are 01 02 03 12 23.
class FieldFiles : public ::testing::Test {
 protected:
  FieldFiles() {
    test::write_text(folder_ / "q.obj",
                     "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2/2 3/3\nf 1 3 4\n");
    test::write_text(folder_ / "q_amplitude_s.txt", "0.1\n0.2\n0.3\n0\n");
    // Vertex 2 stands three turns lower than dphi of edge 02 asks for.
    test::write_text(folder_ / "q_phi_s.txt", "0.5\n1.5\n" + std::to_string(2.25 - 3 * turn) + "\n0\n");
    test::write_text(folder_ / "q_dphi_s.txt", "1\n1.75\n0\n0.75\n-1\n");
  }
  WrinkleField read() const { return read_wrinkle_field(folder_ / "q_amplitude_s.txt", folder_ / "q.obj"); }
  std::string complaint() const {
    return test::error_of([&] { read(); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(FieldFiles, TextsByHand) {
  const WrinkleField field = read();
  EXPECT_EQ(field.amplitude, (std::vector<double>{0.1, 0.2, 0.3, 0}));
  ASSERT_EQ(field.triangles.size(), 2U);
  EXPECT_NEAR(field.phase[0][0], 0.5, 1e-6);
  EXPECT_NEAR(field.phase[0][1], 1.5, 1e-6);
  EXPECT_NEAR(field.phase[0][2], 2.25, 2e-6);  // brought up by three turns; to_string keeps six digits
  EXPECT_NEAR(field.phase[1][1], 2.25, 2e-6);
}

TEST_F(FieldFiles, PlyComesBackAsWritten) {
  const WrinkleField field = read();
  write_wrinkle_field(folder_ / "f.ply", field);
  const WrinkleField back = read_wrinkle_field(folder_ / "f.ply", {});
  EXPECT_EQ(back.positions, field.positions);
  EXPECT_EQ(back.amplitude, field.amplitude);
  EXPECT_EQ(back.triangles, field.triangles);
  EXPECT_EQ(back.phase, field.phase);
}

TEST_F(FieldFiles, SaysWhatIsWrong) {
  test::write_text(folder_ / "q_phi_s.txt", "0.5\n1.5\n2\n");
  EXPECT_THAT(complaint(), HasSubstr("q_phi_s.txt: has 3 numbers, the base surface has 4 vertices"));
  test::write_text(folder_ / "q_phi_s.txt", "0.5\nx\n2\n3\n");
  EXPECT_THAT(complaint(), HasSubstr("q_phi_s.txt:2: 'x' is no finite number"));
  test::write_text(folder_ / "q_phi_s.txt", "0.5\nnan\n2\n3\n");
  EXPECT_THAT(complaint(), HasSubstr("no finite number"));
  test::write_text(folder_ / "q_phi_s.txt", "0.5\n1.5\n2\n3\n");
  test::write_text(folder_ / "q_dphi_s.txt", "1\n");
  EXPECT_THAT(complaint(), HasSubstr("has 1 numbers, the base surface has 5 edges"));
  test::write_text(folder_ / "q_dphi_s.txt", "1\n1.75\n0\n0.75\n-1\n");
  test::write_text(folder_ / "q_amplitude_s.txt", "0.1\n-0.2\n0.3\n0\n");
  EXPECT_THAT(complaint(), HasSubstr("vertex 1: the amplitude is -0.2"));
  test::write_text(folder_ / "q.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
  EXPECT_THAT(complaint(), HasSubstr("q.obj:3: vertex 9 does not exist"));
  test::write_text(folder_ / "q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  EXPECT_THAT(complaint(), HasSubstr("q.obj:5: the faces of this mesh need three corners each, this has 4"));
  test::write_text(folder_ / "q.obj", "v 0 0 0\n");
  EXPECT_THAT(complaint(), HasSubstr("q.obj: has no triangles"));
  std::filesystem::remove(folder_ / "q_dphi_s.txt");
  EXPECT_THAT(complaint(), HasSubstr("q_dphi_s.txt' beside it"));
  EXPECT_THROW(read_wrinkle_field(folder_ / "q.obj", folder_ / "q.obj"), Error);

  test::write_text(
      folder_ / "f.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float amplitude\nelement face 2\nproperty list uchar int vertex_indices\n"
      "property list uchar float phase\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2 3 0 1 2\n"
      "3 0 2 1 3 0.5 2 1\n");
  try {
    read_wrinkle_field(folder_ / "f.ply", {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("face 1: the phase of vertex 0 differs by 0.5"));
  }
}

// tfw-disk/README.md: six edges are cut by jumps of 2πk.
TEST_F(FieldFiles, TheAuthorsDisk) {
  const auto folder = test::shared_data("tfw-disk");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data/tfw-disk";
  const WrinkleField field =
      read_wrinkle_field(folder / "disk_amplitude_simulated.txt", folder / "disk_simulated.obj");
  EXPECT_EQ(field.positions.size(), 273U);
  EXPECT_EQ(field.triangles.size(), 494U);
  EXPECT_NEAR(*std::max_element(field.amplitude.begin(), field.amplitude.end()), 0.00105435, 5e-9);
}

}  // namespace
}  // namespace plisse::io
