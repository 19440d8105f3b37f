// The example panels from file to meshes and pictures: the bounds of docs/sizing.md hold for each.
#include "cloth/size.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "io/obj.h"
#include "io/picture/image.h"
#include "support/files.h"

namespace plisse {
namespace {

TEST(Size, EveryExampleKeepsWhatIsPromised) {
  const test::TemporaryFolder folder;
  const cloth::SizeReport report = cloth::size_panels({test::asset("panels.toml"), folder.path()});
  ASSERT_GE(report.panels.size(), 8U);
  for (const cloth::SizeReport::Panel& panel : report.panels) {
    SCOPED_TRACE(panel.name);
    EXPECT_GE(panel.quality.edges_within, 0.99);
    EXPECT_GE(panel.quality.least_angle, 25);
    EXPECT_EQ(panel.quality.lost, 0);
    EXPECT_NEAR(static_cast<double>(panel.vertices) / panel.quality.expected_vertices, 1, 0.15);
    EXPECT_LT(static_cast<double>(panel.vertices), panel.uniform_vertices);
    if (panel.name == "two-way") {
      EXPECT_NEAR(panel.quality.length_ratio, 2.753, 0.15 * 2.753);
    }

    // The files hold what the report counts.
    const io::ObjFile obj = io::read_obj(folder / (panel.name + ".obj"), {.looks = true});
    EXPECT_EQ(obj.positions.size(), panel.vertices);
    EXPECT_EQ(obj.triangles.size(), panel.triangles);
    for (std::size_t i = 0; i < obj.positions.size();
         i += 97) {  // uv = panel coordinates, in single precision
      EXPECT_NEAR(obj.uvs[i].x, obj.positions[i].x, 1e-6);
      EXPECT_NEAR(obj.uvs[i].y, obj.positions[i].y, 1e-6);
    }
    const std::string ply = test::read_text(folder / (panel.name + ".ply"));
    EXPECT_NE(ply.find("element vertex " + std::to_string(panel.vertices) + "\n"), std::string::npos);
    EXPECT_NE(ply.find("element face " + std::to_string(panel.triangles) + "\n"), std::string::npos);
    const std::string text = test::read_text(folder / (panel.name + ".obj"));
    for (const cloth::SizeReport::Feature& feature : panel.features) {
      if (feature.rule == "collision") continue;  // a region, no line
      std::string group = "g " + feature.name + "\n";
      for (std::size_t i = 2; i < group.size(); ++i) group[i] = group[i] == ' ' ? '_' : group[i];
      EXPECT_NE(text.find(group), std::string::npos) << group;
    }
    EXPECT_GT(io::load_image(folder / (panel.name + "_map.png")).width, 400);
    EXPECT_GT(io::load_image(folder / (panel.name + "_mesh.png")).width, 400);
  }
}

TEST(Size, TheSkirtIsOneMesh) {
  const test::TemporaryFolder folder;
  const cloth::SizeReport report = cloth::size_panels({test::asset("skirt.toml"), folder.path()});
  ASSERT_TRUE(report.garment);
  EXPECT_EQ(report.garment->seams.size(), 6U);
  for (const cloth::SizeReport::Panel& panel : report.panels) {
    EXPECT_GE(panel.quality.edges_within, 0.99) << panel.name;
    EXPECT_GE(panel.quality.least_angle, 25) << panel.name;
  }
  const io::ObjFile obj = io::read_obj(folder / "garment.obj");
  EXPECT_EQ(obj.positions.size(), report.garment->vertices);
  std::size_t together = 0, seam_vertices = 0;
  for (const cloth::SizeReport::Panel& panel : report.panels) together += panel.vertices;
  for (const auto& seam : report.garment->seams) seam_vertices += seam.edges + 1;
  // Each seam joins two vertices to one, all the way; where four panels meet, left and right, four seams end
  // but three vertices go.
  EXPECT_EQ(together - report.garment->vertices, seam_vertices - 2);
}

TEST(Size, TheExamplesAreAsTheirScriptMakesThem) {
  const std::string check =
      fmt::format("'{}' --check > /dev/null", test::source_file("tools/make_panels").string());
  EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST(Size, TheSameFileGivesTheSameBytes) {
  const test::TemporaryFolder folder;
  test::write_text(
      folder / "p.toml",
      "fabric = \"dark-blue\"\n[[panel]]\nname = \"p\"\noutline = [[0, 0], [0.3, 0], [0.2, 0.3]]\n");
  cloth::size_panels({folder / "p.toml", folder / "one"});
  cloth::size_panels({folder / "p.toml", folder / "two"});
  for (const char* suffix : {"p.obj", "p.ply", "p_map.png", "p_mesh.png"})
    EXPECT_EQ(test::read_bytes(folder.path() / "one" / suffix),
              test::read_bytes(folder.path() / "two" / suffix))
        << suffix;
}

}  // namespace
}  // namespace plisse
