// What files say of their surfaces, from the file to the pixel: normal maps under the wrinkles, vertex
// colours, masks and the file's own cameras, with the shaders held against the reference.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "config/settings.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/look.h"
#include "pipeline/render.h"
#include "pipeline/verify.h"
#include "support/files.h"
#include "support/gltf_file.h"
#include "support/opengl.h"

namespace plisse::pipeline {
namespace {

constexpr int columns = 12, rows = 8;

// A picture as PPM, which the reader of textures takes.
template <typename Colour>
std::vector<std::uint8_t> picture(int size, const Colour& colour) {
  const std::string head = fmt::format("P6\n{} {}\n255\n", size, size);
  std::vector<std::uint8_t> bytes(head.begin(), head.end());
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (const double c : colour((x + 0.5) / size, (y + 0.5) / size))
        bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * c)));
  return bytes;
}

// A sheet of 1.2 × 0.8 m that a morph target squeezes by a third within a second; a camera of each kind
// before it.
class Materials : public test::DriverTest {
 protected:
  config::SceneSettings scene(const std::string& material, const std::string& attributes = "") {
    std::vector<float> place, squeeze, uv, colour;
    std::vector<std::uint16_t> triangles;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) {
        const float x = static_cast<float>(i) / columns, y = static_cast<float>(j) / rows;
        place.insert(place.end(), {1.2F * x - 0.6F, 0.8F * y - 0.4F, 0.1F * std::sin(3 * x)});
        squeeze.insert(squeeze.end(), {-0.4F * x + 0.2F, 0, 0.05F * y});
        uv.insert(uv.end(), {x, 1 - y});
        colour.insert(colour.end(), {1 - 0.6F * x, 1, 1 - 0.8F * y, 1 - x});
        const auto v = static_cast<std::uint16_t>(j * (columns + 1) + i),
                   up = static_cast<std::uint16_t>(v + columns + 1);
        if (i == columns || j == rows) continue;
        const auto next = [](std::uint16_t id) { return static_cast<std::uint16_t>(id + 1); };
        triangles.insert(triangles.end(), {v, next(v), next(up), v, next(up), up});
      }
    test::GltfBuffer buffer;
    const int position = buffer.array("VEC3", place), delta = buffer.array("VEC3", squeeze);
    const int coordinates = buffer.array("VEC2", uv), colours = buffer.array("VEC4", colour);
    const int index = buffer.array("SCALAR", triangles);
    const int times = buffer.array<float>("SCALAR", {0, 1}), weights = buffer.array<float>("SCALAR", {0, 1});
    // Ribs and dents; and a weave.
    const int normals = buffer.view(picture(32, [](double s, double t) {
      const double x = 0.35 * std::sin(25 * s), y = 0.35 * std::sin(12 * t);
      return std::array{0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * std::sqrt(1 - x * x - y * y)};
    }));
    const int weave = buffer.view(picture(16, [](double s, double t) {
      return std::array{0.5 + 0.4 * std::sin(12.6 * s), 0.6, 0.5 + 0.4 * std::cos(12.6 * t)};
    }));
    test::write_text(
        folder_ / "sheet.gltf",
        fmt::format(
            R"({{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}},{{"camera":0,"translation":[0.2,0,3]}},
{{"camera":1,"translation":[0,0.093,2],"scale":[2,2,2]}}],"cameras":[{{"name":"front","perspective":{{"yfov":0.4}}}},
{{"name":"plan","orthographic":{{"xmag":1,"ymag":0.5}}}}],
"meshes":[{{"name":"sheet","primitives":[{{"material":0,"indices":{},"attributes":{{"POSITION":{},"TEXCOORD_0":{}{}}},
"targets":[{{"POSITION":{}}}]}}]}}],"materials":[{{{}}}],"textures":[{{"source":0}},{{"source":1}}],
"images":[{{"bufferView":{}}},{{"bufferView":{}}}],"animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,
"path":"weights"}}}}],"samplers":[{{"input":{},"output":{}}}]}}],{}}})",
            index, position, coordinates,
            attributes.empty() ? "" : fmt::format(R"(,"{}":{})", attributes, colours), delta, material,
            normals, weave, times, weights, buffer.json()));
    config::SceneSettings settings;
    settings.model.path = folder_ / "sheet.gltf";
    settings.model.frames = "1,25";
    settings.output.width = 200;
    settings.output.height = 150;
    return settings;
  }
  static void expect_verified(const config::SceneSettings& settings) {
    pipeline::RenderRequest request;
    request.scene = settings;
    const pipeline::VerifyReport report = pipeline::verify(request, {});
    EXPECT_TRUE(report.ok) << fmt::format("{}", fmt::join(report.failures, "\n"));
    EXPECT_GT(report.fraction_within_4, 0.9975);
  }
  test::TemporaryFolder folder_;
};

constexpr const char* mapped = R"("normalTexture":{"index":0,"scale":0.8},"doubleSided":true)";

TEST_F(Materials, NormalMapsUnderWrinkles) {
  const config::SceneSettings settings = scene(mapped);
  const pipeline::LoadedScene loaded(settings);
  const passes::DrawPart part = pipeline::draw_parts(loaded).at(0);
  EXPECT_EQ(part.normal_texture, 0);
  EXPECT_EQ(part.normal_scale, 0.8F);
  EXPECT_FALSE(pipeline::texture_levels(loaded).at(0).at(0).srgb);
  expect_verified(settings);
}

TEST_F(Materials, EverythingAtOnce) {
  const config::SceneSettings settings = scene(
      fmt::format(
          R"({},"alphaMode":"MASK","alphaCutoff":0.3,"pbrMetallicRoughness":{{"baseColorFactor":[0.9,0.8,1,1],
"baseColorTexture":{{"index":1,"extensions":{{"KHR_texture_transform":{{"scale":[3,2],"rotation":0.4}}}}}}}})",
          mapped),
      "COLOR_0");
  const passes::DrawPart part = pipeline::draw_parts(pipeline::LoadedScene(settings)).at(0);
  EXPECT_TRUE(part.has_colours);
  EXPECT_EQ(part.base_colour, glm::vec4(0.9F, 0.8F, 1, 1));
  EXPECT_EQ(part.alpha_cutoff, 0.3F);
  expect_verified(settings);
}

TEST_F(Materials, VertexColoursAlone) {
  const config::SceneSettings settings = scene(R"("doubleSided":true)", "COLOR_0");
  // They are the look: the scene's own colour is for surfaces that have none.
  EXPECT_EQ(pipeline::draw_parts(pipeline::LoadedScene(settings)).at(0).base_colour, glm::vec4(1));
  expect_verified(settings);
}

TEST_F(Materials, CamerasOfTheFile) {
  config::SceneSettings settings = scene(mapped);
  const auto picture_place = [&](const std::string& camera, const glm::dvec3& world) {
    settings.camera.name = camera;
    const pipeline::LoadedScene loaded(settings);
    const glm::dvec4 clip = loaded.view(1).view_projection * glm::dvec4(loaded.units.world(world), 1);
    return glm::dvec2(clip) / clip.w;
  };
  // 3 m before the sheet, 0.2 m to the right; half the picture's height is 3 tan 0.2 there, its width 4/3 of
  // that.
  const double half = 3 * std::tan(0.2);
  const glm::dvec2 place((0.5 - 0.2) / (half * 4 / 3), 0.3 / half);
  EXPECT_LT(glm::distance(picture_place("front", {0.5, 0.3, 0}), place), 1e-9);
  EXPECT_LT(glm::distance(picture_place("0", {0.5, 0.3, 0}), place), 1e-9);
  // Parallel: half the height is ymag times the node's scale, 1 m, whatever the distance. (0.093, so that no
  // edge of the sheet runs through the middles of pixels, where covered or not is a matter of taste.)
  for (const double z : {-0.5, 0.0, 0.5}) {
    EXPECT_LT(glm::distance(picture_place("plan", {0.5, 0.3, z}), {0.5 / (4.0 / 3), 0.207}), 1e-9);
    EXPECT_LT(glm::distance(picture_place("1", {0.5, 0.3, z}), {0.5 / (4.0 / 3), 0.207}), 1e-9);
  }
  settings.camera.name = "plan";
  expect_verified(settings);
  EXPECT_THROW(picture_place("fornt", {0, 0, 0}), Error);
}

}  // namespace
}  // namespace plisse::pipeline
