// <plisse/size.h> against the files of `plisse size`, and panels in memory against the same panels in a file.
#include <gmock/gmock.h>

#include <cmath>

#include "cloth/size.h"
#include "config/fabric.h"
#include "io/obj.h"
#include "plisse/size.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse {
namespace {

using ::testing::HasSubstr;

// OBJ files have nine digits.
constexpr double digits = 1e-8;

void expect_equal(const Mesh& mesh, const io::ObjFile& file) {
  ASSERT_EQ(mesh.positions.size(), file.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(mesh.positions[v][static_cast<std::size_t>(axis)], file.positions[v][axis], digits) << v;
  ASSERT_EQ(mesh.triangles.size(), file.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(mesh.triangles[t][c], static_cast<std::uint32_t>(file.triangles[t][c].position)) << t;
      const auto uv = file.uvs.at(static_cast<std::size_t>(file.triangles[t][c].uv));
      ASSERT_NEAR(mesh.uv[t][c][0], uv.x, 1e-6) << t;  // in single precision
      ASSERT_NEAR(mesh.uv[t][c][1], uv.y, 1e-6) << t;
    }
}

TEST(PublicSize, PanelsAndGarmentAreThoseOfTheFiles) {
  const test::TemporaryFolder folder;
  const cloth::SizeReport report = cloth::size_panels({test::asset("skirt.toml"), folder.path()});
  SizeRequest request;
  request.file = test::asset("skirt.toml");
  const MeshedPanels found = size_panels(request);
  ASSERT_EQ(found.panels.size(), report.panels.size());
  for (std::size_t p = 0; p < found.panels.size(); ++p) {
    const MeshedPanel& panel = found.panels[p];
    SCOPED_TRACE(panel.name);
    EXPECT_EQ(panel.name, report.panels[p].name);
    EXPECT_EQ(panel.edges_within, report.panels[p].quality.edges_within);
    EXPECT_EQ(panel.least_angle, report.panels[p].quality.least_angle);
    EXPECT_EQ(panel.edge_length.size(), panel.mesh.positions.size());
    expect_equal(panel.mesh, io::read_obj(folder / (panel.name + ".obj"), {.looks = true}));
  }
  ASSERT_TRUE(found.garment);
  EXPECT_EQ(found.garment->parts.size(), found.panels.size());
  expect_equal(*found.garment, io::read_obj(folder / "garment.obj", {.looks = true}));
}

TEST(PublicSize, APanelInMemoryIsMeshedAsInAFile) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "square.toml",
                   "[[panel]]\nname = \"square\"\nfabric = \"2e-6, 3e5\"\ngrain = 60\n"
                   "outline = [[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.2]]\n");
  SizeRequest from_file, in_memory;
  from_file.file = folder / "square.toml";
  Panel& panel = in_memory.panels.emplace_back();
  panel.name = "square";
  panel.fabric = find_fabric("2e-6, 3e5");
  panel.grain = 60;
  panel.outline = {{0, 0}, {0.2, 0}, {0.2, 0.1}, {0, 0.2}};
  const MeshedPanel file = size_panels(from_file).panels.at(0), memory = size_panels(in_memory).panels.at(0);
  EXPECT_EQ(memory.mesh.positions, file.mesh.positions);
  EXPECT_EQ(memory.mesh.triangles, file.mesh.triangles);
  EXPECT_EQ(memory.edge_length, file.edge_length);
  in_memory.fabric = find_fabric("2e-5, 3e5");  // in place of the panel's own
  EXPECT_NE(size_panels(in_memory).panels.at(0).mesh.positions, file.mesh.positions);
}

TEST(PublicSize, RefusesInTheWordsOfTheCommandLine) {
  const std::string words = test::error_of([] { config::parse_fabric("wine-stile"); });
  ASSERT_THAT(words, HasSubstr("wine-style"));
  EXPECT_EQ(test::error_of([] { find_fabric("wine-stile"); }), words);
  EXPECT_THAT(test::error_of([] { edge_length({-1, 1}); }), HasSubstr("above 0 N·m"));

  SizeRequest request;
  EXPECT_THAT(test::error_of([&] { size_panels(request); }), HasSubstr("either panels or a file"));
  Panel& panel = request.panels.emplace_back();
  panel.outline = {{0, 0}, {0.1, 0.1}, {0.1, 0}, {0, 0.1}};
  panel.fabric = find_fabric("wine-style");
  EXPECT_THAT(test::error_of([&] { size_panels(request); }), HasSubstr("panel 'panel': the outline crosses"));
  panel.outline = {{0, 0}, {0.1, 0}, {0.1, std::nan("")}};
  EXPECT_THAT(test::error_of([&] { size_panels(request); }), HasSubstr("no number"));
  panel.outline = {{0, 0}, {0.1, 0}, {0.1, 0.1}};
  panel.fabric.warp.bending = 0;
  EXPECT_THAT(test::error_of([&] { size_panels(request); }), HasSubstr("above 0 N·m"));
}

}  // namespace
}  // namespace plisse
