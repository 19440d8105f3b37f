// plisse size and info --fabric from outside: numbers, reports, exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program.h"

namespace plisse {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Size : public test::Program {};

TEST_F(Size, FabricsOnTheCommandLine) {
  const json wine = json::parse(run({"size", "--fabric", "2e-6,3e5", "--json", "-"}).out);
  EXPECT_NEAR(wine["resolution_mm"].get<double>(), 7.8261, 0.01);  // the paper's Table 1, recomputed
  EXPECT_TRUE(wine["in_range"].get<bool>());
  EXPECT_NEAR(wine["c1"].get<double>(), 32.0751, 5e-5);
  const json named = json::parse(run({"size", "--fabric", "wine-style", "--json", "-"}).out);
  EXPECT_EQ(named, wine);
  const json both = json::parse(run({"size", "--fabric", "two-way", "--json", "-"}).out);
  EXPECT_NEAR(both["ratio"].get<double>(), 2.753, 5e-4);
  const json paper = json::parse(
      run({"size", "--fabric", "2e-6,3e5", "--fabric-range", "1e-9,1e-3,2e3,2e6,2.5mm,50mm", "--json", "-"})
          .out);
  EXPECT_EQ(paper, wine);
  EXPECT_THAT(run({"size", "--list-fabrics"}).out, HasSubstr("pinkish-puff"));
  for (const char* wrong : {"0,1", "-2e-6,3e5", "nan,1", "1", "2e-6,3e5,1", "2e-6,3e5 furlongs", ""})
    EXPECT_EQ(run({"size", "--fabric", wrong}).code, 2) << wrong;
  EXPECT_EQ(run({"size"}).code, 2);
  EXPECT_EQ(run({"size", "--fabric", "2e-6,3e5", "--fabric-range", "1,2,3"}).code, 2);
}

TEST_F(Size, PanelsBecomeFiles) {
  test::write_text(
      folder_ / "p.toml",
      "units = \"mm\"\nfabric = \"khaki\"\n[[panel]]\nname = \"front\"\n"
      "outline = [[0, 0], [200, 0], [200, 150], [0, 150]]\n"
      "[[panel.feature]]\nrule = \"shirring\"\nname = \"hem\"\nratio = 0.5\nline = [[0, 0], [200, 0]]\n");
  const Outcome outcome = run({"size", path("p.toml"), "-o", path("out"), "--json", path("r.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("front: "));
  const json report = json::parse(test::read_text(folder_ / "r.json"));
  for (const char* key :
       {"features", "vertices", "triangles", "expected_vertices", "edges_within_half_and_double",
        "min_angle_deg", "map_s", "sample_s", "triangulate_s", "panels", "outputs"})
    EXPECT_TRUE(report.contains(key)) << key;
  EXPECT_EQ(report["features"][0]["name"], "hem");
  EXPECT_NEAR(report["features"][0]["resolution_mm"].get<double>(), 10.4698 / 2, 0.01);
  for (const json& file : report["outputs"])
    EXPECT_TRUE(std::filesystem::exists(file["path"].get<std::string>()));

  EXPECT_EQ(run({"size", path("none.toml")}).code, 2);
  EXPECT_EQ(run({"size", path("p.toml"), "-o", "/dev/null/x"}).code, 5);
  test::write_text(folder_ / "small.toml",
                   "fabric = \"khaki\"\n[[panel]]\noutline = [[0, 0], [1e-6, 0], [0, 1e-6]]\n");
  const Outcome small = run({"size", path("small.toml"), "-o", path("out")});
  EXPECT_EQ(small.code, 1);  // cannot hold edges of 10 mm
  EXPECT_THAT(small.err, HasSubstr("worse than promised"));
}

TEST_F(Size, AnotherFabricForTheSamePanels) {
  test::write_text(folder_ / "p.toml",
                   "fabric = \"khaki\"\n[[panel]]\noutline = [[0, 0], [0.2, 0], [0.2, 0.2], [0, 0.2]]\n");
  const auto resolution = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"size", path("p.toml"), "-o", path("out"), "--json", path("r.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).code, 0);
    return json::parse(test::read_text(folder_ / "r.json"))["panels"][0]["resolution_mm"]["weft"]
        .get<double>();
  };
  EXPECT_NEAR(resolution({}), 10.4698, 0.01);
  EXPECT_NEAR(resolution({"--fabric", "dark-blue"}), 18.4183, 0.01);
  const json model = json::parse(run({"info", path("p.toml"), "--fabric", "khaki", "--json", "-"}).out);
  EXPECT_EQ(model["meshes"][0]["name"], "panel1");
  EXPECT_EQ(model["fabric"]["meshes"][0]["coarser"], 0);  // it was meshed for it
}

TEST_F(Size, InfoTellsWhereAMeshIsTooCoarse) {
  test::write_text(folder_ / "cloth.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const Outcome outcome = run({"info", path("cloth.obj"), "--fabric", "khaki", "--json", path("r.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("100 % coarser than double"));
  const json fit = json::parse(test::read_text(folder_ / "r.json"))["fabric"]["meshes"][0];
  EXPECT_EQ(fit["coarser"], 1.0);
  EXPECT_EQ(run({"info", path("cloth.obj"), "--fabric", "kaki"}).code, 2);
}

}  // namespace
}  // namespace plisse
