// plisse export from outside: meshes and point caches, in our own reader and in Blender's; and what it
// refuses.
#include <gmock/gmock.h>

#include <cmath>

#include "io/import.h"
#include "io/point_cache.h"
#include "system/blender.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Export : public Program {
 protected:
  // 450 vertices, bent; without the loop's first round, which a test need not wait for.
  void SetUp() override {
    Program::SetUp();
    write_text(folder_ / "scene.toml",
               "[model]\npath = \"" + asset("sleeve.glb").string() +
                   "\"\n[wrinkles]\nwavelength = 0.04\nexclude = [\"seam\", \"cuff\"]\n");
  }
  Outcome exported(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"export", (folder_ / "scene.toml").string(), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return plisse(arguments);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::vector<std::string>& more) const {
    const Outcome outcome = exported(more);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  TemporaryFolder folder_;
};

TEST_F(Export, TheReportNamesFilesSizesAndUnits) {
  write({"--frames", "20,30", "--levels", "1", "-o", file("a_##.ply"), "--json", file("report.json")});
  const auto json = nlohmann::json::parse(read_text(folder_ / "report.json"));
  ASSERT_EQ(json["outputs"].size(), 2U);
  EXPECT_EQ(json["outputs"][1]["path"], file("a_30.ply"));
  EXPECT_EQ(json["outputs"][1]["kind"], "mesh");
  EXPECT_EQ(json["outputs"][1]["frame"], 30);
  EXPECT_EQ(json["levels"], 1);
  EXPECT_EQ(json["triangles"], 4 * 864);
  EXPECT_EQ(json["units_m"], 1);
  EXPECT_EQ(json["up"], "y");
}

TEST_F(Export, WithoutStrengthItIsThePosedModel) {
  write({"--frames", "30", "--levels", "0", "--strength", "0", "-o", file("posed.obj")});
  const io::Model posed = io::import_model(folder_ / "posed.obj");
  EXPECT_EQ(posed.file_vertex_count, 450U);
  // And with it that model, wrinkled: no vertex moves further than a wave is high, a quarter of its length.
  write({"--frames", "30", "--levels", "0", "-o", file("wrinkled.obj")});
  const io::Model wrinkled = io::import_model(folder_ / "wrinkled.obj");
  double furthest = 0;
  for (std::size_t m = 0; m < posed.meshes.size(); ++m)
    for (std::size_t v = 0; v < posed.meshes[m].positions.size(); ++v)
      furthest =
          std::max(furthest, glm::distance(posed.meshes[m].positions[v], wrinkled.meshes[m].positions[v]));
  EXPECT_GT(furthest, 0.1 * 0.04 / 4);
  EXPECT_LT(furthest, 0.04 / 4);
}

TEST_F(Export, ACacheMovesTheObjToEachFramesMesh) {
  write({"--frames", "1", "--levels", "1", "-o", file("mesh.obj")});
  write({"--frames", "30", "--levels", "1", "-o", file("30.obj")});
  for (const std::string kind : {"pc2", "mdd"}) {
    write({"--frames", "20-40x5", "--levels", "1", "-o", file("cache." + kind)});
    const io::Model mesh = io::import_model(folder_ / "mesh.obj"),
                    then = io::import_model(folder_ / "30.obj");
    const io::VertexCache cache = io::read_point_cache(folder_ / ("cache." + kind), mesh);
    ASSERT_EQ(cache.size(), 5U);
    EXPECT_NEAR(cache.frames_per_second(), 24.0 / 5, 1e-4);
    const auto third = cache.frame(2);
    std::size_t at = 0;
    for (const io::Mesh& part : then.meshes)
      for (const glm::dvec3& x : part.positions)
        EXPECT_NEAR(glm::distance(third->at(at++), x), 0, 1e-6);  // single precision of metres
  }
}

TEST_F(Export, RefusesOutputsItCannotWrite) {
  const auto refused = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = exported(arguments);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(refused({}), HasSubstr("name the output with -o"));
  EXPECT_THAT(refused({"-o", file("a.stl")}), HasSubstr("written as .ply, .obj or .glb"));
  EXPECT_THAT(refused({"-o", file("a.obj")}), HasSubstr("give it a place for the number"));
  EXPECT_THAT(refused({"-o", file("a_##.pc2")}), HasSubstr("one file for all frames"));
  EXPECT_THAT(refused({"-o", file("a.pc2"), "--frames", "1,2,4"}), HasSubstr("one step for all frames"));
  EXPECT_THAT(refused({"-o", file("a.obj"), "--frames", "1", "--levels", "x"}), HasSubstr("--levels: 'x'"));
  EXPECT_THAT(refused({"-o", file("a.obj"), "--size", "64x64"}), HasSubstr("unknown option '--size'"));
  EXPECT_THAT(names_in(folder_.path()), ElementsAre("scene.toml"));
}

// Blender is no requirement of the project; where it is installed it opens what we write.
TEST_F(Export, BlenderFindsTheSamePlacesNormalsAndUv) {
  if (!has_blender()) GTEST_SKIP() << "no Blender with numpy on this machine";
  for (const std::string name : {"mesh.obj", "mesh.glb", "mesh.ply"})
    write({"--frames", "30", "--levels", "1", "-o", file(name)});
  write({"--frames", "1", "--levels", "1", "-o", file("cache.obj")});
  write({"--frames", "20-40x5", "--levels", "1", "-o", file("frame_##.obj")});
  for (const std::string name : {"cache.pc2", "cache.mdd"})
    write({"--frames", "20-40x5", "--levels", "1", "-o", file(name)});
  const Outcome outcome = blender_script("blender_export.py", {folder_.path().string(), file("report.json")});
  ASSERT_TRUE(std::filesystem::exists(folder_ / "report.json")) << outcome.out << outcome.err;
  const auto json = nlohmann::json::parse(read_text(folder_ / "report.json"));
  const double diagonal = json["diagonal"];
  for (const char* format : {"obj", "glb", "ply"}) {
    EXPECT_LT(json[format]["place"], 1e-6 * diagonal) << format;  // single precision
    EXPECT_LT(json[format]["uv"], 1e-6) << format;
  }
  // Blender keeps a custom normal in two 16-bit angles about its own smooth normal: half a degree. Its PLY
  // reader takes none.
  for (const char* format : {"obj", "glb"}) EXPECT_LT(json[format]["angle_deg"], 1) << format;
  for (const char* cache : {"pc2", "mdd"}) {
    EXPECT_EQ(json[cache]["frames"], 5);
    EXPECT_LT(json[cache]["place"], 1e-5 * diagonal) << cache;  // single precision keeps 6e-8
  }
}

}  // namespace
}  // namespace plisse::test
