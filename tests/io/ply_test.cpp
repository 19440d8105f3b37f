// PLY tables: what is written comes back, files of all three formats by hand, and broken ones with their
// reason.
#include "io/ply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "base/error.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Type = PlyProperty::Type;

Ply parsed(const std::string& text) {
  return parse_ply(text, "some.ply");
}

std::string complaint(const std::string& text) {
  return test::error_of([&] { parsed(text); });
}

const std::string header =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 2\nproperty float x\nproperty uchar red\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST(PlyFile, ReadsTextByHand) {
  const Ply ply = parsed(header + "0.5 200\n-1e-3 +7\n3 0 1 1\n");
  ASSERT_EQ(ply.elements.size(), 2U);
  EXPECT_THAT(ply.comments, ElementsAre("by hand"));
  EXPECT_THAT(ply.find("vertex")->find("x")->values, ElementsAre(0.5, -1e-3));
  EXPECT_THAT(ply.find("vertex")->find("red")->values, ElementsAre(200, 7));
  EXPECT_THAT(ply.find("face")->find("vertex_indices")->values, ElementsAre(0, 1, 1));
  EXPECT_EQ(ply.find("edge"), nullptr);
  EXPECT_EQ(ply.find("vertex")->find("y"), nullptr);
}

TEST(PlyFile, ReadsBigEndianByHand) {
  std::string text =
      "ply\nformat binary_big_endian 1.0\nelement v 1\nproperty short a\nproperty list uchar float "
      "b\nend_header\n";
  text += std::string("\x01\x02", 2) + std::string("\x01\x3f\x80\x00\x00", 5);  // 258; one float, 1.0
  const Ply ply = parsed(text);
  EXPECT_THAT(ply.elements[0].properties[0].values, ElementsAre(258));
  EXPECT_THAT(ply.elements[0].properties[1].values, ElementsAre(1.0));
}

TEST(PlyFile, ComesBackAsWritten) {
  const test::TemporaryFolder folder;
  Ply ply;
  ply.comments = {"a comment"};
  PlyElement vertex{
      "vertex",
      3,
      {{"x", Type::float64, false, {1.0 / 3, -2e300, 0}}, {"count", Type::uint16, false, {0, 65535, 7}}}};
  PlyElement face{"face", 3, {{"phase", Type::float64, true, {0.1, 0.2, 5}, {2, 2, 3}}}};
  ply.elements = {vertex, face};
  write_ply(folder / "a.ply", ply);
  const Ply back = read_ply(folder / "a.ply");
  ASSERT_EQ(back.elements.size(), 2U);
  EXPECT_EQ(back.comments, ply.comments);
  for (std::size_t e = 0; e < 2; ++e) {
    for (std::size_t p = 0; p < ply.elements[e].properties.size(); ++p) {
      EXPECT_EQ(back.elements[e].properties[p].values, ply.elements[e].properties[p].values);
      EXPECT_EQ(back.elements[e].properties[p].ends, ply.elements[e].properties[p].ends);
      EXPECT_EQ(back.elements[e].properties[p].type, ply.elements[e].properties[p].type);
    }
  }
  ply.elements[0].properties[0].values[1] = NAN;
  EXPECT_THROW(write_ply(folder / "b.ply", ply), Error);
  EXPECT_THAT(test::names_in(folder.path()), ElementsAre("a.ply"));
}

// Data that is not requested may have any value, as long as it can be skipped.
TEST(PlyFile, OnlyWhatIsWantedHasToBeFinite) {
  const std::string text = header + "0.5 nan\n-1 7\n3 0 1 1\n";
  EXPECT_THAT(complaint(text), HasSubstr("vertex 0, 'red': the value is not finite"));
  const Ply ply = parse_ply(text, "some.ply", {"x", "vertex_indices"});
  EXPECT_THAT(ply.numbers("vertex", {"x"}), ElementsAre(0.5, -1));
  EXPECT_THAT(ply.lists("face", "vertex_indices", 3), ElementsAre(0, 1, 1));
  EXPECT_EQ(ply.find("vertex")->find("red"), nullptr);
  EXPECT_THAT(test::error_of([&] {
                ply.numbers("vertex", {"red", "r"});
              }),
              HasSubstr("some.ply: element 'vertex' has no property 'red' or 'r'"));
}

TEST(PlyFile, ListsAreCountedInAnyType) {
  const std::string counted = "ply\nformat ascii 1.0\nelement v 2\nproperty list float int a\nend_header\n";
  EXPECT_THAT(parsed(counted + "2 5 6\n1.0 7\n").find("v")->find("a")->values, ElementsAre(5, 6, 7));
}

TEST(PlyFile, TextHasNineDigitsOfADoubleAndSixOfAFloat) {
  const test::TemporaryFolder folder;
  PlyElement vertex{
      "vertex", 1, {{"x", Type::float64, false, {1.0 / 3}}, {"w", Type::float32, false, {2.0 / 3}}}};
  vertex.add_lists("a", Type::int8, 2, {-1, 2});
  write_ply(folder / "a.ply", {{"by hand"}, {vertex}}, PlyFormat::ascii);
  EXPECT_EQ(test::read_text(folder / "a.ply"),
            "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 1\nproperty double x\nproperty float w\n"
            "property list uchar char a\nend_header\n0.333333333 0.666667 2 -1 2\n");
}

TEST(PlyFile, SaysWhatIsWrong) {
  EXPECT_THAT(complaint("ply\nformat ascii 1.1\nend_header\n"),
              HasSubstr("some.ply:2: version '1.1' of the format is not known; 1.0 is the only one"));
  EXPECT_THAT(complaint("solid"), HasSubstr("some.ply: is no PLY"));
  EXPECT_THAT(complaint("ply\nformat ascii 1.0\n"), HasSubstr("does not end"));
  EXPECT_THAT(complaint("ply\nend_header\n"), HasSubstr("no 'format'"));
  EXPECT_THAT(complaint("ply\nformat ascii 1.0\nproperty int a\nend_header\n"), HasSubstr("some.ply:3: "));
  EXPECT_THAT(complaint("ply\nformat ascii 1.0\nelement v x\nend_header\n"), HasSubstr("'x' is no number"));
  EXPECT_THAT(complaint("ply\nformat ascii 1.0\nelement v 1\nproperty half a\nend_header\n"),
              HasSubstr("'half' is no type"));
  EXPECT_THAT(complaint(header + "0.5 200\n-1 nought\n3 0 1 1\n"),
              HasSubstr("vertex 1, 'red': 'nought' is no number"));
  EXPECT_THAT(complaint(header + "0.5 200\n-1 1\n3 0 1\n"),
              HasSubstr("face 0, 'vertex_indices': the file ends"));
  EXPECT_THAT(complaint(header + "0.5 200\nnan 1\n3 0 1 1\n"), HasSubstr("not finite"));
  EXPECT_THAT(complaint("ply\nformat ascii 1.0\nelement v 99999999999\nproperty int a\nend_header\n1\n"),
              HasSubstr("promises 99999999999"));
  EXPECT_THAT(complaint("ply\nformat ascii 1.0\nelement v 1\nproperty list int int a\nend_header\n-2\n"),
              HasSubstr("-2 is no length"));
  EXPECT_THAT(complaint("ply\nformat ascii 1.0\nelement v 1\nproperty list float int a\nend_header\n1.5 3\n"),
              HasSubstr("v 0, 'a': 1.5 is no length"));
}

}  // namespace
}  // namespace plisse::io
