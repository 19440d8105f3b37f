// OBJ and PLY files and numbered sequences of them, written here.
#include "io/sequence.h"

#include <fmt/format.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/text.h"
#include "io/import.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::io {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

// A folder of its own for every test, gone afterwards.
class ObjTest : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  std::string import_error(const fs::path& path) const {
    return test::error_of([&] {
      const Model model = import_model(path);
      for (std::size_t f = 0; f < model.cache.size(); ++f) model.cache.frame(f);
    });
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

std::string square(double height) {
  return fmt::format(
      "v 0 0 {0}\nv 1 0 {0}\nv 1 1 {0}\nv 0 1 {0}\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n",
      height);
}

TEST_F(ObjTest, ReadsFacesOfEveryForm) {
  const Model model =
      import_model(write("forms.obj",
                         "# comment\nv 0 0 0\nv +1e0 0 0\nv 1 1 0 1.0\nv 0 1 0\nv 0.5 2 \\\n 0\r\n"
                         "vn 0 0 2\nvt 0.25 0.75\n"
                         "g quad\nf 1 2 3 4\ng house\nusemtl roof\nf -2//1 -3//-1 5//1\nl 1 2\n"));
  ASSERT_EQ(model.meshes.size(), 2U);
  EXPECT_EQ(model.meshes[0].name, "quad");
  EXPECT_EQ(model.meshes[0].triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(model.meshes[0].uvs.empty());
  EXPECT_TRUE(model.meshes[0].normals.empty());
  const Mesh& house = model.meshes[1];
  EXPECT_EQ(house.positions, (std::vector<glm::dvec3>{{0, 1, 0}, {1, 1, 0}, {0.5, 2, 0}}));
  EXPECT_EQ(house.normals, std::vector<glm::vec3>(3, {0, 0, 1}));
  EXPECT_EQ(model.materials.at(static_cast<std::size_t>(house.material)).name, "roof");
}

TEST_F(ObjTest, ReadsMaterials) {
  write("cloth.mtl",
        "newmtl red wool\nKd 1 0.5 0\nd 0.25\nnewmtl lost\nKd 1 1 1\nmap_Kd -s 1 1 1 gone.png\n");
  const Model model = import_model(
      write("cloth.obj", "mtllib cloth.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red wool\nf 1 2 3\n"));
  const Material& material = model.materials.at(0);
  EXPECT_EQ(material.name, "red wool");
  EXPECT_NEAR(material.base_colour.g, 0.21404, 1e-5);  // ((0.5 + 0.055)/1.055)^2.4, IEC 61966-2-1
  EXPECT_EQ(material.base_colour.a, 0.25F);
  EXPECT_EQ(material.alpha, Material::Alpha::blend);
  EXPECT_EQ(model.materials.at(1).base_colour_texture, -1);
}

TEST_F(ObjTest, UnitsAndUpAxis) {
  const fs::path path = write("up.obj", "v 0 0 0\nv 1 0 0\nv 0 2 3\nf 1 2 3\n");
  EXPECT_EQ(import_model(path).meshes[0].positions[2], glm::dvec3(0, 2, 3));
  EXPECT_EQ(import_model(path, {0.5, "z"}).meshes[0].positions[2], glm::dvec3(0, 1.5, -1));
  EXPECT_EQ(import_model(path, {{}, "x"}).meshes[0].positions[2], glm::dvec3(-2, 0, 3));
  EXPECT_THAT(test::error_of([&] { import_model(path, {{}, "w"}); }), HasSubstr("expected x, y or z"));
  EXPECT_THAT(test::error_of([&] { import_model(path, {-1.0, ""}); }), HasSubstr("positive"));
}

TEST_F(ObjTest, SaysWhereAFileIsWrong) {
  EXPECT_THAT(import_error(write("a.obj", "v 0 0 0\nv 0 x 0\n")),
              AllOf(HasSubstr("a.obj:2"), HasSubstr("'x'")));
  EXPECT_THAT(import_error(write("b.obj", "v 0 0 nan\n")), HasSubstr("b.obj:1"));
  EXPECT_THAT(import_error(write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")),
              AllOf(HasSubstr("c.obj:4"), HasSubstr("vertex 4")));
  EXPECT_THAT(import_error(write("d.obj", "v 0 0 0\nf 1 1\n")), HasSubstr("d.obj:2"));
  EXPECT_THAT(import_error(write("e.obj", "v 0 0 1e999\n")), HasSubstr("e.obj:1"));
  EXPECT_THAT(import_error(write("f.obj", "v 0 0 0\n")), HasSubstr("no triangles"));
  EXPECT_THAT(import_error(folder_ / "g.obj"), HasSubstr("no such file"));
  EXPECT_THAT(import_error(write("h.txt", "")), HasSubstr("not a kind of model"));
}

TEST_F(ObjTest, SequenceByEveryNameForIt) {
  for (int n = 8; n <= 11; ++n) write(fmt::format("cloth_{:04}.obj", n), square(n));
  write("notes.obj", square(0));
  for (const fs::path& path :
       {folder_, folder_ / "cloth_####.obj", folder_ / "cloth_%04d.obj", folder_ / "cloth_{frame:04}.obj"}) {
    const Model model = import_model(path);
    ASSERT_EQ(model.cache.size(), 4U) << path;
    for (std::size_t f = 0; f < 4; ++f)
      for (const glm::dvec3& p : *model.cache.frame(f)) EXPECT_EQ(p.z, static_cast<double>(f) + 8);
    EXPECT_EQ(model.meshes[0].uvs.size(), 4U);
  }
}

double area_of(const Mesh& mesh, const std::vector<glm::dvec3>& positions) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto corner = [&](std::size_t c) { return positions.at(mesh.triangles[t + c]); };
    area += glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) / 2;
  }
  return area;
}

// An L of three unit squares, whose fan from the first corner named here would reach outside.
TEST_F(ObjTest, PolygonsAreCutInsideThemselves) {
  const std::string corners = "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n";
  std::string obj;
  for_each_line(corners, [&](std::string_view line, std::size_t) { obj += fmt::format("v {}\n", line); });
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
      corners + "6 2 3 4 5 0 1\n";
  for (const fs::path& path : {write("l.obj", obj + "f 3 4 5 6 1 2\n"), write("l.ply", ply)}) {
    const Model model = import_model(path);
    EXPECT_EQ(model.meshes[0].triangles.size(), 12U);
    EXPECT_NEAR(area_of(model.meshes[0], model.meshes[0].positions), 3, 1e-12) << path;
  }
}

// A quad whose better diagonal changes over time keeps the one of the first frame.
TEST_F(ObjTest, SequencesAreCutAsTheirFirstFrame) {
  const auto frame = [](double flat, const char* face) {
    return fmt::format("v -1 0 0\nv 0 -{0} 0\nv 1 0 0\nv 0 {0} 0\n{1}\n", flat, face);
  };
  write("k_1.obj", frame(0.5, "f 1 2 3 4"));
  write("k_2.obj", frame(2, "f 1 2 3 4"));
  const Model model = import_model(folder_ / "k_#.obj");
  const Mesh& mesh = model.meshes[0];
  const Model alone = import_model(folder_ / "k_2.obj");
  const auto joins = [](const Mesh& of, double x) {  // a triangle on both vertices at x and −x of the axis
    for (std::size_t t = 0; t < of.triangles.size(); t += 3) {
      int found = 0;
      for (std::size_t c = 0; c < 3; ++c) found += std::abs(of.positions[of.triangles[t + c]].x) == x ? 1 : 0;
      if (found == 2) return true;
    }
    return false;
  };
  EXPECT_FALSE(joins(mesh, 1));
  EXPECT_TRUE(joins(alone.meshes[0], 1));
  EXPECT_NEAR(area_of(mesh, *model.cache.frame(1)), 4, 1e-12);
}

TEST_F(ObjTest, SequenceWithoutLeadingZerosCountsAsNumbers) {
  for (int n = 9; n <= 10; ++n) write(fmt::format("{}.obj", n), square(n));
  EXPECT_EQ(import_model(folder_).cache.frame(0)->at(0).z, 9);
  EXPECT_EQ(import_model(folder_ / "#.obj").cache.size(), 2U);
}

TEST_F(ObjTest, SequenceErrorsNameTheFile) {
  write("c_01.obj", square(1));
  write("c_03.obj", square(3));
  EXPECT_THAT(import_error(folder_), HasSubstr("c_02.obj: missing"));
  write("c_02.obj", square(2) + "v 0 0 0\n");
  EXPECT_THAT(import_error(folder_), AllOf(HasSubstr("c_02.obj"), HasSubstr("5 vertices")));
  write("c_02.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4 1\n");
  EXPECT_THAT(import_error(folder_), AllOf(HasSubstr("c_02.obj"), HasSubstr("other vertices")));
  write("d_1.obj", square(1));
  EXPECT_THAT(import_error(folder_), AllOf(HasSubstr("c_##.obj"), HasSubstr("d_#.obj")));
  EXPECT_THAT(import_error(folder_ / "x_##.obj"), HasSubstr("no file fits"));
  write("x_01.glb", "glTF");
  EXPECT_THAT(import_error(folder_ / "x_##.glb"), HasSubstr("a sequence is of OBJ or PLY files"));
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(import_error(folder_ / "empty"), HasSubstr("without numbered OBJ or PLY files"));
}

}  // namespace
}  // namespace plisse::io
