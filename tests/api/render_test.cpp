// <plisse/render.h> against the files of the commands, and scenes in memory against the same scenes in files.
#include "plisse/render.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <tinyexr.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <thread>

#include "config/options.h"
#include "config/paint_file.h"
#include "config/scene_file.h"
#include "io/picture/image.h"
#include "io/ply.h"
#include "pipeline/bake.h"
#include "pipeline/paint.h"
#include "pipeline/render.h"
#include "pipeline/verify.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/opengl.h"

namespace plisse {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

using Options = std::vector<std::pair<std::string, std::string>>;

const Options small{{"--size", "96x80"}, {"--samples", "1"}};

std::vector<Picture> pictures(const Scene& scene, bool displace = false) {
  std::vector<Picture> result;
  RenderRequest request;
  request.scene = scene;
  request.displace = displace;
  if (displace) request.draw.levels = 2;
  const auto self = std::this_thread::get_id();
  request.on_picture = [&](int, const Picture& picture) {
    EXPECT_EQ(std::this_thread::get_id(), self);
    result.push_back(picture);
  };
  render(request);
  return result;
}

// A sheet that frame n squeezes along x, in files and in memory.
class PublicRender : public test::DriverTest {
 protected:
  static constexpr int frames = 3;
  PublicRender() {
    constexpr std::uint32_t n = 8;
    for (int frame = 1; frame <= frames; ++frame) {
      Mesh& mesh = in_memory_.frames.emplace_back();
      std::string obj;
      for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
          const double u = i / double(n), v = j / double(n);
          const Vector3 x{(1 - 0.125 * (frame - 1)) * u, v, 0};  // exact in the file
          mesh.positions.push_back(x);
          obj += fmt::format("v {} {} 0\nvt {} {}\n", x[0], x[1], u, v);
        }
      for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
          const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
          for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
            mesh.triangles.push_back(t);
            auto& uv = mesh.uv.emplace_back();
            obj += "f";
            for (std::size_t k = 0; k < 3; ++k) {
              uv[k] = {(t[k] % (n + 1)) / double(n), (t[k] / (n + 1)) / double(n)};
              obj += fmt::format(" {0}/{0}", t[k] + 1);
            }
            obj += "\n";
          }
        }
      test::write_text(folder_ / fmt::format("sheet_{}.obj", frame), obj);
    }
    in_files_.text = "[model]\npath = \"sheet_#.obj\"\n" + keys_;
    in_files_.folder = folder_.path();
    in_files_.options = in_memory_.options = small;
    in_memory_.text = keys_;
  }

  // Five waves over frame's sheet.
  WrinkleField field(int frame) const {
    const Mesh& mesh = in_memory_.frames[static_cast<std::size_t>(frame - 1)];
    WrinkleField result{mesh.positions, mesh.triangles, std::vector<double>(mesh.positions.size(), 0.01), {}};
    for (const Triangle& t : mesh.triangles) {
      auto& phase = result.phase.emplace_back();
      for (std::size_t c = 0; c < 3; ++c)
        phase[c] = 10 * std::numbers::pi * mesh.positions[t[c]][0] / mesh.positions[8][0];
    }
    return result;
  }

  const std::string keys_ = "[wrinkles]\nwavelength = 0.15\n";
  test::TemporaryFolder folder_;
  Scene in_files_, in_memory_;
};

std::vector<Vector3> plain(const std::vector<glm::dvec3>& points) {
  std::vector<Vector3> result;
  for (const glm::dvec3& p : points) result.push_back({p.x, p.y, p.z});
  return result;
}

void expect_equal(const std::vector<Picture>& a, const std::vector<Picture>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i].rgba == b[i].rgba) << "picture " << i + 1;
}

TEST_F(PublicRender, PicturesAreThoseOfTheCommand) {
  pipeline::RenderRequest command;
  command.scene = config::load_scene(test::asset("square.toml"));
  config::apply_options(command.scene, {{"--size", {"96x80"}},
                                        {"--samples", {"1"}},
                                        {"--frames", {"49-73x24"}},
                                        {"--output", {(folder_ / "theirs_####.png").string()}}});
  const pipeline::RenderReport theirs = pipeline::render(command, {});

  RenderRequest request;
  request.scene.file = test::asset("square.toml");
  request.scene.options = small;
  request.scene.options.emplace_back("--frames", "49-73x24");
  std::vector<Picture> drawn;
  request.on_picture = [&](int, const Picture& picture) { drawn.push_back(picture); };
  const RenderReport report = render(request);
  EXPECT_THAT(report.frames, ElementsAre(49, 73));
  EXPECT_TRUE(report.files.empty());
  EXPECT_EQ(report.triangles, theirs.triangles);
  EXPECT_EQ(report.vertices, theirs.welded_vertices);
  EXPECT_EQ(report.wavelength, theirs.wavelength_m);
  EXPECT_THAT(report.device, HasSubstr(theirs.gl.renderer));
  ASSERT_EQ(drawn.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const io::Image image = io::load_image(theirs.frames[k].path);
    EXPECT_EQ(drawn[k].width, image.width);
    EXPECT_EQ(drawn[k].height, image.height);
    EXPECT_TRUE(drawn[k].rgba == image.rgba) << k;
  }

  request.on_picture = {};
  request.scene.options.emplace_back("--output", (folder_ / "ours_####.png").string());
  const RenderReport files = render(request);
  ASSERT_EQ(files.files.size(), 2U);
  EXPECT_EQ(test::read_bytes(files.files[1]), test::read_bytes(theirs.frames[1].path));
}

TEST_F(PublicRender, MeshesInMemoryAreDrawnAsTheirFilesAre) {
  const auto drawn = pictures(in_memory_);
  ASSERT_EQ(drawn.size(), 3U);
  EXPECT_FALSE(drawn[0].rgba == drawn[2].rgba);
  expect_equal(drawn, pictures(in_files_));
  expect_equal(pictures(in_memory_, true), pictures(in_files_, true));
}

TEST_F(PublicRender, FieldsInMemoryAreDrawnAsTheirFilesAre) {
  const auto without = pictures(in_memory_);
  save_field(folder_ / "field.ply", field(1));
  in_files_.text += "[bias]\nfield = \"field.ply\"\nuse = \"direct\"\n";
  in_memory_.fields = {field(1)};
  const auto one = pictures(in_memory_);
  EXPECT_FALSE(one[0].rgba == without[0].rgba);
  expect_equal(one, pictures(in_files_));

  for (int frame = 1; frame <= frames; ++frame)
    save_field(folder_ / fmt::format("each_{}.ply", frame), field(frame));
  in_files_.text =
      "[model]\npath = \"sheet_#.obj\"\n" + keys_ + "[bias]\nfield = \"each_#.ply\"\nuse = \"direct\"\n";
  in_memory_.fields = {field(1), field(2), field(3)};
  const auto each = pictures(in_memory_);
  EXPECT_FALSE(each[2].rgba == one[2].rgba);
  expect_equal(each, pictures(in_files_));

  in_memory_.fields.pop_back();
  EXPECT_THAT(test::error_of([&] { pictures(in_memory_); }),
              HasSubstr("2 wrinkle fields, but the clip has 3 frames"));
  in_memory_.fields = {field(3)};  // of another surface than the rest pose
  EXPECT_NE(test::error_of([&] { pictures(in_memory_); }), "");
}

TEST_F(PublicRender, VerifyIsTheCommandsOwn) {
  RenderRequest request;
  request.scene = in_memory_;
  const VerifyReport report = verify(request);
  EXPECT_TRUE(report.ok) << (report.failures.empty() ? "" : report.failures.front());
  pipeline::RenderRequest command;
  command.scene = config::parse_scene(in_files_.text, folder_ / "scene.toml");
  config::apply_options(command.scene, {{"--size", {"96x80"}}, {"--samples", {"1"}}});
  const pipeline::VerifyReport theirs = pipeline::verify(command, {});
  ASSERT_EQ(report.passes.size(), theirs.passes.size());
  for (const VerifyReport::Pass& pass : report.passes) {
    EXPECT_EQ(pass.largest, theirs.passes.at(pass.name).max_abs) << pass.name;
    EXPECT_EQ(pass.tolerance, theirs.passes.at(pass.name).tolerance) << pass.name;
  }
}

TEST_F(PublicRender, ExportGivesTheWavesAsGeometry) {
  ExportRequest request;
  request.scene = in_memory_;
  request.draw.levels = 3;
  std::vector<Mesh> memory, files;
  request.on_mesh = [&](int, const Mesh& mesh) { memory.push_back(mesh); };
  EXPECT_EQ(export_meshes(request), 3);
  request.scene = in_files_;
  request.on_mesh = [&](int, const Mesh& mesh) { files.push_back(mesh); };
  export_meshes(request);
  ASSERT_EQ(memory.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(memory[k].positions, files[k].positions) << k;
    EXPECT_EQ(memory[k].triangles, files[k].triangles) << k;
  }
  EXPECT_EQ(memory[0].triangles.size(), 64 * in_memory_.frames[0].triangles.size());
  // Nothing is squeezed in the first frame; in the last, a quarter of the length is in the waves.
  const auto highest = [](const Mesh& mesh) {
    double height = 0;
    for (const Vector3& x : mesh.positions) height = std::max(height, std::abs(x[2]));
    return height;
  };
  EXPECT_LT(highest(memory[0]), 1e-6);
  EXPECT_GT(highest(memory[2]), 0.01);
}

TEST_F(PublicRender, BakedMapsAreThoseOfTheFiles) {
  Scene last = in_memory_;
  last.options.emplace_back("--frames", "3");
  BakeRequest request;
  request.scene = last;
  request.size = 64;
  BakedMaps maps;
  request.on_maps = [&](int, const BakedMaps& baked) { maps = baked; };
  bake(request);
  EXPECT_EQ(maps.corner, (Vector2{0, 0}));
  EXPECT_EQ(maps.side, 1);

  pipeline::BakeRequest command;
  command.scene = config::parse_scene(in_files_.text, folder_ / "scene.toml");
  config::apply_options(command.scene, {{"--frames", {"3"}}});
  command.texture_size = 64;
  command.output = (folder_ / "maps").string();
  pipeline::bake_maps(command, {});
  float* values = nullptr;
  int width = 0, height = 0;
  const char* problem = nullptr;
  ASSERT_EQ(LoadEXR(&values, &width, &height, (folder_ / "maps/height_0003.exr").c_str(), &problem), 0);
  ASSERT_EQ(maps.size, width);
  ASSERT_EQ(maps.height.size(), 64U * 64U);
  for (std::size_t i = 0; i < maps.height.size(); ++i) ASSERT_EQ(maps.height[i], values[4 * i]) << i;
  std::free(values);
  const io::Image normals = io::load_image(folder_ / "maps/normal_0003.png");
  ASSERT_EQ(maps.normals.size(), maps.height.size());
  for (std::size_t i = 0; i < maps.normals.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(127.5 + 127.5 * maps.normals[i][c], normals.rgba[4 * i + c], 0.51) << i;
}

TEST_F(PublicRender, PaintedVectorsAreThoseOfTheFile) {
  pipeline::PaintRequest command;
  command.paint = config::load_paint(test::asset("sleeve.paint.toml"));
  command.paint.preview_frame = 0;
  command.folder = (folder_ / "painted").string();
  pipeline::paint_wrinkles(command);
  PaintRequest request;
  request.file = test::asset("sleeve.paint.toml");
  const PaintedWrinkles painted = paint_wrinkles(request);
  const io::Ply ply = io::read_ply(folder_ / "painted/bias.ply");
  EXPECT_EQ(painted.positions, plain(ply.vectors("vertex")));
  EXPECT_EQ(painted.vectors, plain(ply.vectors("vertex", "bias_")));
  EXPECT_THAT(painted.vectors, Contains(Vector3{}));
  EXPECT_THAT(painted.vectors, Contains(Not(Vector3{})));

  PaintRequest text;
  text.text = test::read_text(test::asset("sleeve.paint.toml"));
  text.folder = test::asset("");
  EXPECT_EQ(paint_wrinkles(text).vectors, painted.vectors);
}

TEST_F(PublicRender, WhatACallbackThrowsComesOut) {
  RenderRequest request;
  request.scene = in_memory_;
  int calls = 0;
  request.on_picture = [&](int, const Picture&) {
    ++calls;
    throw std::runtime_error("enough");
  };
  try {
    render(request);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), std::string("enough"));
  }
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(pictures(in_memory_).size(), 3U);  // and the next request is as ever
}

TEST_F(PublicRender, SaysWhatIsWrong) {
  const auto complaint = [](const Scene& scene) { return test::error_of([&] { pictures(scene); }); };
  EXPECT_THAT(complaint({}), HasSubstr("one of file, text and frames"));
  Scene scene = in_memory_;
  scene.options.emplace_back("--wavelenght", "1cm");
  EXPECT_THAT(complaint(scene), HasSubstr("no option '--wavelenght' (did you mean '--wavelength'?)"));
  scene.options = {{"--wavelength", "1cm"}, {"--wavelength", "2cm"}};
  EXPECT_THAT(complaint(scene), HasSubstr("--wavelength: given 2 times"));
  scene.options = {{"--only", "b"}, {"--only", "mesh"}};  // both count, as on the command line
  EXPECT_THAT(complaint(scene), HasSubstr("'b' is neither a mesh nor a material"));
  scene = in_memory_;
  scene.text = "[wrinkles]\nwavelenght = 1\n";
  EXPECT_THAT(complaint(scene), HasSubstr("scene.toml:2:1: key 'wavelenght': unknown in [wrinkles]"));
  scene.text = in_files_.text;
  EXPECT_THAT(complaint(scene), HasSubstr("leave path and garment out"));
  scene = in_memory_;
  scene.frames[1].positions.pop_back();
  EXPECT_THAT(complaint(scene), HasSubstr("frame 2"));
  scene = in_memory_;
  scene.frames[2].triangles[0] = {0, 1, 11};
  EXPECT_THAT(complaint(scene), HasSubstr("frame 3: has other triangles than frame 1"));
  scene = in_memory_;
  scene.frames[1].positions[4][1] = INFINITY;
  EXPECT_THAT(complaint(scene), HasSubstr("frame 2: the position of vertex 4 is not finite"));
  scene = in_memory_;
  scene.frames_per_second = 0;
  EXPECT_THAT(complaint(scene), HasSubstr("0 frames a second"));

  RenderRequest request;
  request.scene = in_memory_;
  request.draw.levels = 2;
  EXPECT_THAT(test::error_of([&] { render(request); }), HasSubstr("set displace"));
  request.displace = true;
  request.draw.levels = 9;
  EXPECT_THAT(test::error_of([&] { render(request); }), HasSubstr("9 levels; allowed: 0 … 8"));
  EXPECT_THAT(test::error_of([&] { export_meshes({}); }), HasSubstr("set on_mesh"));
  EXPECT_THAT(test::error_of([&] { bake({}); }), HasSubstr("set on_maps"));
  EXPECT_THAT(test::error_of([&] { paint_wrinkles({}); }), HasSubstr("either a file or a text"));
}

}  // namespace
}  // namespace plisse
