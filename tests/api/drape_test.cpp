// <plisse/drape.h> against the files of `plisse drape`.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "cloth/drape.h"
#include "cloth/drape_examples.h"
#include "cloth/drape_setup.h"
#include "io/ply.h"
#include "plisse/drape.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse {
namespace {

using ::testing::HasSubstr;

void expect_equal(const BaseSurface& a, const BaseSurface& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.rest, b.rest);
  EXPECT_EQ(a.held, b.held);
  EXPECT_EQ(a.material.young, b.material.young);
  EXPECT_EQ(a.material.poisson, b.material.poisson);
  EXPECT_EQ(a.material.thickness, b.material.thickness);
  EXPECT_EQ(a.material.density, b.material.density);
}

TEST(PublicDrape, FramesAreThoseOfTheFiles) {
  const test::TemporaryFolder folder;
  cloth::DrapeScene scene = cloth::drape_example("twisted-cylinder", 150);
  scene.frames = 3;
  const cloth::DrapeReport files = cloth::drape({scene, "2-3", folder / "base_####.ply", {}});

  DrapeRequest request;
  request.example = "twisted-cylinder";
  request.vertices = 150;
  request.steps = 3;
  request.frames = "2-3";
  std::vector<BaseSurface> surfaces;
  const auto self = std::this_thread::get_id();
  request.on_frame = [&](const DrapeFrame&, const BaseSurface& base) {
    EXPECT_EQ(std::this_thread::get_id(), self);
    surfaces.push_back(base);
  };
  const DrapeReport report = drape(request);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.failure, "");
  ASSERT_EQ(report.frames.size(), 2U);
  ASSERT_EQ(surfaces.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const DrapeFrame& frame = report.frames[k];
    EXPECT_EQ(frame.frame, static_cast<int>(k) + 2);
    EXPECT_EQ(frame.energy, files.frames[k].equilibrium.energy);
    EXPECT_EQ(frame.iterations, files.frames[k].equilibrium.iterations);
    EXPECT_EQ(frame.reason, files.frames[k].equilibrium.reason);
    EXPECT_EQ(frame.measures, files.frames[k].measures);
    expect_equal(surfaces[k], load_base(files.outputs[k]));
    const io::Ply ply = io::read_ply(files.outputs[k]);
    std::vector<double> rest;
    for (const auto& corners : surfaces[k].rest)
      for (const Vector2& corner : corners) rest.insert(rest.end(), corner.begin(), corner.end());
    EXPECT_EQ(rest, ply.lists("face", "rest", 6));
    const auto& held = ply.numbers("vertex", {"held"});
    EXPECT_TRUE(std::equal(held.begin(), held.end(), surfaces[k].held.begin(), surfaces[k].held.end()));
    EXPECT_EQ(surfaces[k].positions.back()[1], ply.vectors("vertex").back().y);
    EXPECT_EQ(surfaces[k].material.thickness, scene.material.thickness);
  }

  request.output = folder / "ours_####.ply";
  drape(request);
  EXPECT_EQ(test::read_bytes(folder / "ours_0003.ply"), test::read_bytes(folder / "base_0003.ply"));
}

TEST(PublicDrape, ClothInMemoryIsDrapedAsTheSceneFileWouldDrapeIt) {
  const test::TemporaryFolder folder;
  DrapeRequest request;
  Cloth& cloth = request.cloth.emplace();
  std::string obj;
  constexpr std::uint32_t n = 6;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      cloth.rest.push_back({i / 16.0, 0, j / 16.0});  // exact in the file
      obj += fmt::format("v {} 0 {}\n", i / 16.0, j / 16.0);
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      for (const Triangle& t : {Triangle{a, c, b}, Triangle{a, d, c}}) {
        cloth.triangles.push_back(t);
        obj += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
      }
    }
  cloth.held.assign(cloth.rest.size(), 0);
  cloth.held[0] = cloth.held[n] = 1;
  cloth.material = {1e5, 0.25, 1e-3, 200};
  cloth.gravity = {0, -9.81, 0};
  const DrapeReport memory = drape(request);

  test::write_text(folder / "sheet.obj", obj);
  test::write_text(folder / "scene.toml",
                   fmt::format("[drape]\nmesh = \"sheet.obj\"\n[material]\nyoung = 1e5\npoisson = 0.25\n"
                               "thickness = 0.001\ndensity = 200\n[[hold]]\nvertices = [0, {}]\n",
                               n));
  DrapeRequest of_file;
  of_file.file = folder / "scene.toml";
  const DrapeReport file = drape(of_file);
  EXPECT_TRUE(memory.converged);
  EXPECT_EQ(memory.frames.at(0).energy, file.frames.at(0).energy);
  EXPECT_EQ(memory.frames.at(0).iterations, file.frames.at(0).iterations);
  EXPECT_EQ(test::names_in(folder.path()), (std::vector<std::string>{"scene.toml", "sheet.obj"}));
}

TEST(PublicDrape, SaysWhatIsWrong) {
  DrapeRequest request;
  EXPECT_THAT(test::error_of([&] { drape(request); }), HasSubstr("one of cloth, file and example"));
  request.example = "twisted-cilinder";
  const std::string words = test::error_of([] { cloth::drape_example("twisted-cilinder", 0); });
  EXPECT_THAT(words, HasSubstr("twisted-cylinder"));
  EXPECT_EQ(test::error_of([&] { drape(request); }), words);

  request.example.clear();
  Cloth& cloth = request.cloth.emplace();
  const auto complaint = [&] { return test::error_of([&] { drape(request); }); };
  cloth.rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THAT(complaint(), HasSubstr("no triangles"));
  cloth.triangles = {{0, 1, 3}};
  EXPECT_THAT(complaint(), HasSubstr("triangle 0 names vertex 3"));
  cloth.triangles = {{0, 1, 2}};
  cloth.held = {1};
  EXPECT_THAT(complaint(), HasSubstr("1 entries of held; there have to be 3"));
  cloth.held = {1, 1, 0};
  cloth.start = {{0, 0, 0}};
  EXPECT_THAT(complaint(), HasSubstr("1 positions of start"));
  cloth.start.clear();
  EXPECT_THAT(complaint(), HasSubstr("Young's modulus is 0"));
  cloth.material = {1e5, 0.3, 1e-3, 100};
  cloth.gravity = {0, std::nan(""), 0};
  EXPECT_THAT(complaint(), HasSubstr("must be finite"));
  cloth.gravity = {};
  request.steps = -1;
  EXPECT_THAT(complaint(), HasSubstr("-1 steps"));
  request.steps = 0;
  request.vertices = 100;
  EXPECT_THAT(complaint(), HasSubstr("vertices are for an example"));
}

}  // namespace
}  // namespace plisse
