// glTF files written here, byte for byte known, through the whole reader.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/import.h"
#include "support/files.h"
#include "support/gltf_file.h"

namespace plisse::io {
namespace {

namespace fs = std::filesystem;

class Gltf : public testing::Test {
 protected:
  // One triangle with uvs and a morph target under a node that moves.
  Model import(const std::string& material, const std::string& interpolation) const {
    test::GltfBuffer buffer;
    const int position = buffer.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int uv = buffer.array<float>("VEC2", {0, 0.25F, 1, 0, 0, 1});
    const int index = buffer.array<std::uint16_t>("SCALAR", {0, 1, 2});
    const int delta = buffer.array<float>("VEC3", {0, 0, 1, 0, 0, 2, 0, 0, 3});
    const int times = buffer.array<float>("SCALAR", {0.5F, 1, 2});
    const int moves = buffer.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 5, 0, 0});
    const int weights = buffer.array<float>("SCALAR", {0, 1, 0.5F});
    std::ofstream(folder_ / "file.gltf") << fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"name":"cloth","weights":[0.25],"primitives":[{{"attributes":{{"POSITION":{},"TEXCOORD_0":{}}},"indices":{},
"targets":[{{"POSITION":{}}}],"material":0}}]}}],"materials":[{}],
"images":[{{"uri":"weave%201.png"}}],"textures":[{{"source":0}}],
"animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}},
{{"sampler":1,"target":{{"node":0,"path":"weights"}}}}],
"samplers":[{{"input":{},"output":{},"interpolation":"{}"}},{{"input":{},"output":{}}}]}}],{}}})",
        position, uv, index, delta, material, times, moves, interpolation, times, weights, buffer.json());
    return import_model(folder_ / "file.gltf");
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(Gltf, GeometryAndMorphTargets) {
  const Model model = import("{}", "LINEAR");
  ASSERT_EQ(model.meshes.size(), 1U);
  const Mesh& mesh = model.meshes[0];
  EXPECT_EQ(mesh.name, "cloth");
  EXPECT_EQ(mesh.positions, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(mesh.normals.empty());
  // glTF's v points down the picture, ours up.
  EXPECT_EQ(mesh.uvs, (std::vector<glm::vec2>{{0, 0.75F}, {1, 1}, {0, 0}}));
  ASSERT_EQ(mesh.targets.size(), 1U);
  EXPECT_EQ(mesh.targets[0].position_deltas, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}));
  EXPECT_EQ(model.nodes[0].morph_weights, std::vector<double>{0.25});
}

TEST_F(Gltf, TracksInSecondsWithTheirInterpolation) {
  const Model model = import("{}", "LINEAR");
  ASSERT_EQ(model.clips.size(), 1U);
  const Clip& clip = model.clips[0];
  EXPECT_EQ(clip.name, "clip 0");
  EXPECT_EQ(clip.duration, 2);
  ASSERT_EQ(clip.channels.size(), 1U);
  const Channel& channel = clip.channels[0];
  ASSERT_EQ(channel.translation.times.size(), 3U);
  EXPECT_EQ(channel.translation.times[0], 0.5);
  EXPECT_EQ(channel.translation.values[2], glm::dvec3(5, 0, 0));
  EXPECT_EQ(channel.translation.interpolation, Interpolation::linear);
  EXPECT_EQ(channel.morph_weights.values, (std::vector<std::vector<double>>{{0}, {1}, {0.5}}));

  const Model stepped = import("{}", "STEP");
  EXPECT_EQ(stepped.clips[0].channels[0].translation.interpolation, Interpolation::step);
  EXPECT_EQ(stepped.clips[0].channels[0].morph_weights.interpolation, Interpolation::linear);
}

TEST_F(Gltf, Materials) {
  const Material plain =
      import(
          R"({"name":"felt","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.75]},)"
          R"("alphaMode":"MASK","alphaCutoff":0.125})",
          "LINEAR")
          .materials[0];
  EXPECT_EQ(plain.name, "felt");
  EXPECT_EQ(plain.base_colour, glm::vec4(0.5F, 0.25F, 1, 0.75F));  // linear already
  EXPECT_EQ(plain.alpha, Material::Alpha::mask);
  EXPECT_EQ(plain.alpha_cutoff, 0.125F);
  EXPECT_TRUE(plain.two_sided);
  EXPECT_EQ(plain.base_colour_texture, -1);
  EXPECT_FALSE(import("{}", "LINEAR").materials[0].two_sided);
}

TEST_F(Gltf, TexturesBesideTheFileAndMissingOnes) {
  const std::string textured = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  EXPECT_EQ(import(textured, "LINEAR").materials[0].base_colour_texture, -1);

  // A picture of 1×2 pixels as uncompressed TGA, top row first: red over half-clear blue (stored as BGRA).
  const std::vector<std::uint8_t> tga{0, 0, 2, 0,  0,    0, 0, 0,   0,   0,   0, 0, 1,
                                      0, 2, 0, 32, 0x28, 0, 0, 255, 255, 255, 0, 0, 128};
  std::ofstream(folder_ / "weave 1.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(tga.data()), static_cast<std::streamsize>(tga.size()));
  const Model model = import(textured, "LINEAR");
  EXPECT_EQ(model.materials[0].base_colour_texture, 0);
  ASSERT_EQ(model.textures.size(), 1U);
  EXPECT_EQ(model.textures[0].image.width, 1);
  EXPECT_EQ(model.textures[0].image.rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 128}));
}

}  // namespace
}  // namespace plisse::io
