// PLY and STL files as programs write them: colours and uv of vertices and faces, pictures, old headers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "base/log.h"
#include "io/import.h"
#include "io/picture/png.h"
#include "support/files.h"

namespace plisse::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A unit square of two triangles, with more properties and comments.
std::string square(const std::string& comments, const std::string& of_vertices,
                   const std::vector<std::string>& vertices, const std::string& of_faces,
                   const std::vector<std::string>& faces) {
  std::string text = "ply\nformat ascii 1.0\n" + comments +
                     "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
                     of_vertices + "element face 2\nproperty list uchar int vertex_indices\n" + of_faces +
                     "end_header\n";
  constexpr std::array<const char*, 4> places{"0 0 0", "1 0 0", "1 1 0", "0 1 0"};
  for (std::size_t v = 0; v < 4; ++v)
    text += fmt::format("{} {}\n", places[v], vertices.empty() ? "" : vertices[v]);
  for (std::size_t f = 0; f < 2; ++f)
    text += fmt::format("3 0 {} {} {}\n", f + 1, f + 2, faces.empty() ? "" : faces[f]);
  return text;
}

class ImportPly : public testing::Test {
 protected:
  Model read(const std::string& text, const char* name = "m.ply") const {
    test::write_text(folder_ / name, text);
    return import_model(folder_ / name);
  }
  std::vector<std::string> warnings() const {
    std::vector<std::string> ours;
    for (const std::string& text : log::warnings())
      if (text.find(folder_.path().string()) != std::string::npos) ours.push_back(text);
    return ours;
  }
  test::TemporaryFolder folder_;
};

const std::string uchars = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

TEST_F(ImportPly, ColoursOfVertices) {
  const glm::vec4 red(1, 0, 0, 1), grey(glm::vec3(0.21586F), 1);  // 128/255 in sRGB, IEC 61966-2-1
  const auto near = [](const glm::vec4& a, const glm::vec4& b) { return glm::distance(a, b) < 2e-3F; };
  for (const std::string type : {"uchar", "ushort", "float"})
    for (const std::string prefix : {"", "diffuse_"}) {
      const double full = type == "uchar" ? 255 : type == "ushort" ? 65535 : 1, half = full * 128 / 255;
      const Model model = read(square(
          "", fmt::format("property {0} {1}red\nproperty {0} {1}green\nproperty {0} {1}blue\n", type, prefix),
          {fmt::format("{} 0 0", full),
           type == "float" ? fmt::format("{0} {0} {0}", half) : fmt::format("{0:.0f} {0:.0f} {0:.0f}", half),
           fmt::format("{} 0 0", full), fmt::format("{} 0 0", full)},
          "", {}));
      const auto& colours = model.meshes[0].colours;
      ASSERT_EQ(colours.size(), 4U) << type;
      EXPECT_TRUE(near(colours[0], red)) << type;
      EXPECT_TRUE(near(colours[1], grey)) << type << " " << colours[1].r;
      EXPECT_THAT(model.materials, IsEmpty());
    }
  // Partly transparent.
  const Model glass = read(square("", uchars + "property uchar alpha\n",
                                  {"255 0 0 51", "255 0 0 51", "255 0 0 51", "255 0 0 51"}, "", {}));
  EXPECT_NEAR(glass.meshes[0].colours.at(0).a, 0.2, 1e-6);
  EXPECT_EQ(glass.materials.at(static_cast<std::size_t>(glass.meshes[0].material)).alpha,
            Material::Alpha::blend);
  // White ones say nothing.
  const Model white =
      read(square("", uchars, {"255 255 255", "255 255 255", "255 255 255", "255 255 255"}, "", {}));
  EXPECT_THAT(white.meshes[0].colours, IsEmpty());
}

TEST_F(ImportPly, ColoursOfFaces) {
  const Model model = read(square("", "", {}, uchars, {"255 0 0", "0 0 255"}));
  const Mesh& mesh = model.meshes.at(0);
  ASSERT_EQ(mesh.triangles.size(), 6U);
  ASSERT_EQ(mesh.positions.size(), 6U);
  for (std::size_t corner = 0; corner < 6; ++corner)
    EXPECT_EQ(mesh.colours.at(mesh.triangles[corner]),
              corner < 3 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 0, 1, 1));
  EXPECT_THAT(mesh.file_vertices, ElementsAre(0, 1, 2, 0, 2, 3));
}

TEST_F(ImportPly, TexturesAndUvOfFaces) {
  write_png(folder_ / "my chk.png", {1, 1, {9, 9, 9, 255}});
  write_png(folder_ / "other.png", {1, 1, {7, 7, 7, 255}});
  const std::string list = "property list uchar float texcoord\n";
  const std::vector<std::string> uvs{"6 0 0 1 0 1 1", "6 .5 0 1 1 0 1"};
  const Model one = read(square("comment TextureFile my chk.png\n", "", {}, list, uvs));
  ASSERT_EQ(one.meshes.size(), 1U);
  const Mesh& mesh = one.meshes[0];
  const std::vector<glm::vec2> expected{{0, 0}, {1, 0}, {1, 1}, {0.5, 0}, {1, 1}, {0, 1}};
  for (std::size_t corner = 0; corner < 6; ++corner)
    EXPECT_EQ(mesh.uvs.at(mesh.triangles.at(corner)), expected[corner]);
  EXPECT_EQ(mesh.positions.size(), 5U);  // the first vertex has two uvs
  EXPECT_EQ(one.textures.at(0).image.rgba[0], 9);
  EXPECT_EQ(one.materials.at(static_cast<std::size_t>(mesh.material)).base_colour_texture, 0);
  // A picture each.
  const Model two = read(square("comment TextureFile my chk.png\ncomment TextureFile OTHER.png\n", "", {},
                                list + "property int texnumber\n", {uvs[0] + " 1", uvs[1] + " 0"}));
  ASSERT_EQ(two.meshes.size(), 2U);
  const auto texel = [&](const Mesh& of) {
    const Material& material = two.materials.at(static_cast<std::size_t>(of.material));
    return two.textures.at(static_cast<std::size_t>(material.base_colour_texture)).image.rgba[0];
  };
  EXPECT_EQ(texel(two.meshes[0]), 7);
  EXPECT_EQ(texel(two.meshes[1]), 9);
  // With uv of vertices.
  const Model vertices =
      read(square("comment TextureFile my chk.png\n", "property float s\nproperty float t\n",
                  {"0 0", "1 0", "1 1", "0 1"}, "", {}));
  EXPECT_EQ(vertices.meshes[0].material, 0);
  EXPECT_EQ(vertices.materials.at(0).base_colour_texture, 0);
  EXPECT_THAT(warnings(), IsEmpty());
  read(square("comment TextureFile no_picture.png\n", "", {}, "", {}));
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("'no_picture.png'"), HasSubstr("has no uv")));
}

// What only dresses a surface does not stand in its way.
TEST_F(ImportPly, DamagedLooksAreTold) {
  const Model model =
      read(square("", uchars + "property float alpha\n", {"9 9 9 nan", "9 9 9 1", "9 9 9 1", "9 9 9 1"},
                  "property list uchar float texcoord\n", {"6 0 0 1 0 1 1", "2 0 0"}));
  EXPECT_EQ(model.meshes.at(0).triangles.size(), 6U);
  EXPECT_THAT(model.meshes[0].colours, IsEmpty());
  EXPECT_THAT(model.meshes[0].uvs, IsEmpty());
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("the colours of element 'vertex'"), HasSubstr("'texcoord'")));
}

// A polygon's uv go with its corners, wherever it is cut.
TEST_F(ImportPly, UvOfPolygons) {
  const Model model = read(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar float texcoord\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0\n1 -.2 0\n2 0 0\n1 .2 0\n8 0 0 1 -.2 2 0 1 .2 4 0 1 2 3\n");
  const Mesh& mesh = model.meshes.at(0);
  ASSERT_EQ(mesh.positions.size(), 4U);
  for (std::size_t v = 0; v < 4; ++v)
    EXPECT_LT(glm::distance(glm::dvec2(mesh.uvs[v]), glm::dvec2(mesh.positions[v])), 1e-6);  // floats
}

TEST_F(ImportPly, OldHeadersAndEncodings) {
  const std::string plain = square("", "", {}, "", {});
  std::string macintosh = plain, wide;
  std::replace(macintosh.begin(), macintosh.end(), '\n', '\r');
  for (const char c : plain) wide += {c, '\0'};
  for (const std::string& text :
       {macintosh, wide, "\xEF\xBB\xBF" + plain, square("obj_info 1992\n", "", {}, "", {})})
    EXPECT_EQ(read(text).meshes.at(0).triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_THAT(warnings(), IsEmpty());
  EXPECT_EQ(read(square("ply_version 0.9\n", "", {}, "", {})).meshes.at(0).triangles.size(), 6U);
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("'ply_version 0.9' is no line of a PLY header")));
}

TEST_F(ImportPly, ElementsThatAreNotReadAreTold) {
  std::string text = square("", "", {}, "", {});
  text.insert(text.find("end_header"), "element edge 1\nproperty int vertex1\nproperty int vertex2\n");
  read(text + "0 1\n");
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("'edge' is not read")));
}

TEST_F(ImportPly, StlHasZUp) {
  const std::string text =
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 3\nvertex 1 0 3\nvertex 0 2 3\nendloop\nendfacet\n"
      "endsolid s\n";
  const auto third = [](const Model& model) {
    return glm::dvec3(model.nodes.at(0).local * glm::dvec4(model.meshes.at(0).positions.at(2), 1));
  };
  test::write_text(folder_ / "s.stl", text);
  EXPECT_EQ(import_model(folder_ / "s.stl").up, "z");
  EXPECT_LT(glm::distance(third(import_model(folder_ / "s.stl")), glm::dvec3(0, 3, -2)), 1e-6);  // floats
  EXPECT_LT(glm::distance(third(import_model(folder_ / "s.stl", {{}, "y"})), glm::dvec3(0, 2, 3)), 1e-6);
}

}  // namespace
}  // namespace plisse::io
