// OBJ and MTL files as programs write them: encodings, ends of lines, several libraries, options, colours.
// Each is read as it is meant, or named in a warning.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "base/log.h"
#include "base/text.h"
#include "io/import.h"
#include "io/picture/png.h"
#include "support/files.h"

namespace plisse::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string quad_uv = quad + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

class ObjText : public testing::Test {
 protected:
  Model read(const std::string& text) const {
    test::write_text(folder_ / "m.obj", text);
    return import_model(folder_ / "m.obj");
  }
  void write(const std::string& name, const std::string& text) const {
    test::write_text(folder_ / name, text);
  }
  // Two texels in a row, RGBA each.
  void write_picture(const std::string& name, const std::vector<std::uint8_t>& rgba) const {
    write_png(folder_ / name, {2, 1, rgba});
  }
  std::vector<std::string> warnings() const {
    std::vector<std::string> ours;
    for (const std::string& text : log::warnings())
      if (text.find(folder_.path().string()) != std::string::npos) ours.push_back(text);
    return ours;
  }
  static const Material& material(const Model& model, const std::string& name) {
    for (const Material& one : model.materials)
      if (one.name == name) return one;
    throw std::out_of_range(name);
  }
  test::TemporaryFolder folder_;
};

std::string utf16(std::string_view text, bool big, bool mark) {
  std::string bytes;
  const auto put = [&](char high, char low) {
    bytes += big ? high : low;
    bytes += big ? low : high;
  };
  if (mark) put('\xFE', '\xFF');
  for (const char c : text) put('\0', c);
  return bytes;
}

TEST_F(ObjText, EncodingsAndEndsOfLines) {
  const std::string faces = "f 1 2 3\nf 1 3 4\n";
  const std::vector<std::uint32_t> expected{0, 1, 2, 0, 2, 3};
  std::vector<std::string> texts{"\xEF\xBB\xBF" + quad + faces,
                                 quad + "f 1 2 \\\r\n 3\r\nf 1 3 \\ \r\n 4\r\n"};
  for (const bool big : {false, true})
    for (const bool mark : {false, true}) texts.push_back(utf16(quad + faces, big, mark));
  std::string macintosh = quad + faces;
  std::replace(macintosh.begin(), macintosh.end(), '\n', '\r');
  texts.push_back(macintosh);
  for (const std::string& text : texts) {
    const Model model = read(text);
    EXPECT_EQ(model.file_vertex_count, 4U);
    EXPECT_EQ(model.meshes[0].triangles, expected);
  }
  // Half of a pair, letters of two, three and four bytes.
  EXPECT_EQ(utf8_of_file(std::string("\xFF\xFE\xE4\0\xAC\x20\x3D\xD8\x00\xDE\x3D\xD8", 12)),
            "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80\xEF\xBF\xBD");
}

TEST_F(ObjText, OneTextureCoordinateIsU) {
  const Model model = read(quad + "vt 0.25\nvt 1 # v\nvt 1 1\nvt 0 1 0\nf 1/1 2/2 3/3 4/4\n");
  EXPECT_THAT(model.meshes[0].uvs,
              ElementsAre(glm::vec2(0.25, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)));
}

TEST_F(ObjText, SeveralLibrariesInOneLine) {
  write("red.mtl", "\xEF\xBB\xBFnewmtl red\nKd 1 0 0\n");
  write("two words.mtl", "NEWMTL green\nkd 0 1 0\n");
  const Model model = read("mtllib red.mtl gone.mtl two words.mtl\n" + quad +
                           "usemtl red\nf 1 2 3\nusemtl green\nf 1 3 4\nusemtl grey\nf 1 2 4\n");
  EXPECT_EQ(glm::vec3(material(model, "red").base_colour), glm::vec3(1, 0, 0));
  EXPECT_EQ(glm::vec3(material(model, "green").base_colour), glm::vec3(0, 1, 0));
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("'gone.mtl' not found"), HasSubstr("'grey'")));
}

TEST_F(ObjText, TextureOptionsAndNames) {
  write_picture("My Check.PNG", {255, 0, 0, 255, 0, 0, 255, 255});
  write("m.mtl",
        "newmtl plain\nMap_Kd -clamp off -bm 1.0 my check.png\n"
        "newmtl scaled\nmap_Kd -s 4 2 1 -o 0.5 -mm 0 1 My Check.PNG\n"
        "newmtl odd\nmap_Kd -imfchan r -glow My Check.PNG\nmap_Bump b.png\nKe 0 0 1\n");
  const Model model =
      read("mtllib M.MTL\n" + quad_uv +
           "usemtl plain\nf 1/1 2/2 3/3\nusemtl scaled\nf 1/1 3/3 4/4\nusemtl odd\nf 1/1 2/2 4/4\n");
  ASSERT_EQ(model.textures.size(), 1U);
  for (const Material& one : model.materials) EXPECT_EQ(one.base_colour_texture, 0) << one.name;
  EXPECT_THAT(model.meshes[0].uvs, ElementsAre(glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1)));
  EXPECT_THAT(model.meshes[1].uvs, ElementsAre(glm::vec2(0.5, 0), glm::vec2(4.5, 2), glm::vec2(0.5, 2)));
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("'-imfchan r'"), HasSubstr("'-glow'"),
                                      HasSubstr("'map_bump'"), HasSubstr("'Ke'")));
}

TEST_F(ObjText, OpacityPictures) {
  write_picture("holes.png", {255, 255, 255, 255, 0, 0, 0, 255});
  write_picture("glass.png", {9, 9, 9, 128, 9, 9, 9, 255});
  write_picture("cloth.png", {10, 20, 30, 255, 40, 50, 60, 255});
  write("m.mtl",
        "newmtl holes\nKd 1 0 0\nmap_d holes.png\nnewmtl both\nmap_d holes.png\nmap_Kd cloth.png\n"
        "newmtl glass\nmap_d glass.png\nnewmtl none\nKd 0 1 0\nmap_d no_holes.png\n");
  const Model model = read("mtllib m.mtl\n" + quad_uv + "usemtl holes\nf 1/1 2/2 3/3\n");
  const auto picture = [&](const std::string& name) {
    return model.textures.at(static_cast<std::size_t>(material(model, name).base_colour_texture)).image.rgba;
  };
  EXPECT_EQ(glm::vec3(material(model, "holes").base_colour), glm::vec3(1, 0, 0));
  EXPECT_EQ(material(model, "holes").alpha, Material::Alpha::mask);
  EXPECT_THAT(picture("holes"), ElementsAre(255, 255, 255, 255, 255, 255, 255, 0));
  EXPECT_EQ(material(model, "both").alpha, Material::Alpha::mask);
  EXPECT_THAT(picture("both"), ElementsAre(10, 20, 30, 255, 40, 50, 60, 0));
  EXPECT_EQ(material(model, "glass").alpha, Material::Alpha::blend);
  EXPECT_THAT(picture("glass"), ElementsAre(255, 255, 255, 128, 255, 255, 255, 255));
  EXPECT_EQ(material(model, "none").alpha, Material::Alpha::opaque);
  EXPECT_EQ(material(model, "none").base_colour_texture, -1);
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("'no_holes.png'")));
}

TEST_F(ObjText, ColoursOfVertices) {
  const glm::vec4 red(1, 0, 0, 1), white(1), half(glm::vec3(0.21404F), 1);  // 0.5 in sRGB, IEC 61966-2-1
  const auto check = [&](const std::string& text, const std::vector<glm::vec4>& expected) {
    const Model model = read(text);
    const std::vector<glm::vec4>& found = model.meshes[0].colours;
    ASSERT_EQ(found.size(), expected.size()) << text;
    for (std::size_t v = 0; v < found.size(); ++v)
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(found[v][c], expected[v][c], 2e-3) << text;  // eight bits
  };
  check("v 0 0 0 1 0 0\nv 1 0 0 .5 .5 .5\nv 1 1 0\nf 1 2 3\n", {red, half, white});
  check("v 0 0 0 255 0 0\nv 1 0 0 127.5 127.5 127.5\nv 1 1 0 255 255 255\nf 1 2 3\n", {red, half, white});
  check("v 0 0 0 255 0 0\nv 1 0 0\nv 1 1 0 255 255 255\nf 1 2 3\n", {red, white, white});
  check("v 0 0 0\nv 1 0 0\nv 1 1 0\n#MRGB ffff0000ff808080\n#MRGB ffffffff\nf 1 2 3\n", {red, half, white});
  check("v 0 0 0 1 0 0 .25\nv 1 0 0 1 1 1 1\nv 1 1 0\nf 1 2 3\n", {glm::vec4(1, 0, 0, 0.25), white, white});
  check("v 0 0 0 1\nv 1 0 0 2\nv 1 1 0 1\nf 1 2 3\n", {});  // weights
  check("v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 1 1 0 1 1 1\nf 1 2 3\n", {});
}

TEST_F(ObjText, ElementsThatAreNotReadAreTold) {
  read(quad + "f 1 2 3\np 1\nl 1 2 3\ncstype bezier\ncurv 0 1 1 2 3\n");
  EXPECT_THAT(warnings(),
              ElementsAre(HasSubstr("free-form curves and surfaces, lines, points are not read")));
}

}  // namespace
}  // namespace plisse::io
