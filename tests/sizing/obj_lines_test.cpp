// Curves from OBJ files: chains of lines, boundaries of flat meshes, planes, and what is refused.
#include "sizing/obj_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;
using testing::HasSubstr;

class ObjLines : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) const {
    test::write_text(folder_ / "c.obj", text);
    return folder_ / "c.obj";
  }
  test::TemporaryFolder folder_;
};

TEST_F(ObjLines, ChainsAreJoinedWhicheverWayTheirPiecesRun) {
  const auto chains = read_obj_lines(file("v 0 0 0\nv 3 0 0\nv 3 1 0\nv 0 1 0\nv 1 0.5 0\nv 2 0.5 0\n"
                                          "g cut\nl 2 1\nl 3 4 1\nl 3/1 2/1\ng dart\nl 5 6\n"),
                                     "");
  ASSERT_EQ(chains.size(), 2U);  // the longest first
  EXPECT_TRUE(chains[0].closed);
  EXPECT_DOUBLE_EQ(std::abs(signed_area(chains[0])), 3);
  EXPECT_FALSE(chains[1].closed);
  EXPECT_DOUBLE_EQ(chains[1].length(), 1);
}

TEST_F(ObjLines, ANameChoosesAGroup) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\no two words\nl 2 3\n";
  EXPECT_EQ(read_obj_lines(file(text), "")[0].points.size(), 3U);
  EXPECT_EQ(read_obj_lines(file(text), "two words")[0].points, (std::vector<dvec2>{{1, 0}, {1, 1}}));
  EXPECT_THAT(test::error_of([&] { read_obj_lines(file(text), "three"); }),
              HasSubstr("has no group or object 'three'; it has two words"));
}

// A square of side 3 in nine cells, the middle one left out: two boundaries, areas 9 and 1.
TEST_F(ObjLines, WithoutLinesAMeshGivesItsBoundary) {
  std::string text;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) text += "v " + std::to_string(i) + " 5 " + std::to_string(-j) + "\n";
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const int a = 4 * j + i + 1;
      if (i == 1 && j == 1) continue;
      for (const int corner : {a, a + 1, a + 5, a + 4})
        text += (corner == a ? "f " : " ") + std::to_string(corner);
      text += "\n";
    }
  const auto chains = read_obj_outline(file(text), "");
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_DOUBLE_EQ(std::abs(signed_area(chains[0])), 9);
  EXPECT_DOUBLE_EQ(std::abs(signed_area(chains[1])), 1);
  // It lies in y = 5: seen from above, −z is up.
  for (const dvec2& point : chains[0].points) EXPECT_GE(point.y, 0);
}

// uv, normals and numbers of them are of no use to a curve, however damaged.
TEST_F(ObjLines, OnlyPlacesCount) {
  const auto chains =
      read_obj_lines(file("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt nan\nvn x\nf 1/7/7 2/8/8 3/9/9\n"), "");
  EXPECT_DOUBLE_EQ(std::abs(signed_area(chains.at(0))), 0.5);
}

// The sides of a polygon are its boundary, not the diagonals that it is split by; a corner named twice is
// one.
TEST_F(ObjLines, PolygonsHaveTheirOwnBoundary) {
  for (const char* face : {"f 1 2 3 4 5", "f 1 2 2 3 4 5", "f 1 2 3 4 5 1"}) {
    const auto chains =
        read_obj_lines(file(std::string("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\n") + face), "");
    ASSERT_EQ(chains.size(), 1U) << face;
    EXPECT_EQ(chains[0].points.size(), 5U) << face;
    EXPECT_DOUBLE_EQ(std::abs(signed_area(chains[0])), 5) << face;
  }
}

TEST_F(ObjLines, WhatIsNoCurveIsRefused) {
  const auto complaint = [this](const std::string& text) {
    return test::error_of([&] { read_obj_outline(file(text), ""); });
  };
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 9 9 0\nv 9 8 0\nv 8 8 0\n";
  EXPECT_THAT(complaint(""), HasSubstr("neither lines nor faces"));
  EXPECT_THAT(complaint(points + "l 1 2 3"), HasSubstr("c.obj: a line is open"));
  EXPECT_THAT(complaint(points + "l 1 2\nl 1 3\nl 1 5"), HasSubstr("3 lines meet at vertex 1"));
  EXPECT_THAT(complaint(points + "l 1 2 3 4 1"), HasSubstr("is not flat"));
  EXPECT_THAT(complaint(points + "l 1 2 3 1\nl 5 6 7 5"), HasSubstr("2 closed lines beside one another"));
  EXPECT_THAT(complaint(points + "l 1 20"),
              HasSubstr("c.obj:8: vertex 20 does not exist: the file has 7 so far"));
  EXPECT_THAT(complaint("v 0 x 0"), HasSubstr("c.obj:1: 'x' is no finite number"));
  EXPECT_THAT(complaint("v 0 nan 0"), HasSubstr("no finite number"));
  EXPECT_THAT(complaint(points + "l 1 \\\n2\nl 1 20"), HasSubstr("c.obj:10: "));  // a line that goes on
  EXPECT_THAT(complaint(points + "l 1"), HasSubstr("a line needs two points"));
  EXPECT_THAT(complaint(points + "l 1 1"), HasSubstr("neither lines nor faces"));
  // A closed mesh has no boundary.
  EXPECT_THAT(complaint(points + "f 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n"), HasSubstr("neither lines nor"));
}

}  // namespace
}  // namespace plisse::sizing
