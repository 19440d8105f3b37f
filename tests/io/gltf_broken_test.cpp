// What is wrong with a glTF is named, with its place; nothing outside its folder is read.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "io/import.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/gltf_file.h"

namespace plisse::io {
namespace {

using testing::HasSubstr;

class GltfBroken : public testing::Test {
 protected:
  std::string error_of(const std::string& text, const std::string& name = "file.gltf") {
    test::write_text(folder_ / name, text);
    const std::string error = test::error_of([&] { import_model(folder_ / name); });
    if (!error.empty()) {
      EXPECT_THAT(error, HasSubstr(name));  // the file is named
    }
    return error;
  }
  // A sound triangle in which one text is replaced.
  std::string error_after(const std::string& old, const std::string& by) {
    std::string text = sound();
    EXPECT_NE(text.find(old), std::string::npos) << old;
    return error_of(text.replace(text.find(old), old.size(), by));
  }
  static std::string sound() {
    test::GltfBuffer buffer;
    buffer.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    buffer.array<std::uint16_t>("SCALAR", {0, 1, 2});
    buffer.array<std::uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    buffer.array<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    buffer.array<float>("SCALAR", {0, 1, 2});
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"skin":0,"children":[1]}},{{}}],
"skins":[{{"joints":[1]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3}},
"indices":1,"targets":[]}}]}}],"animations":[{{"channels":[{{"sampler":0,"target":{{"node":1,"path":"translation"}}}}],
"samplers":[{{"input":4,"output":0}}]}}],{}}})",
        buffer.json());
  }
  test::TemporaryFolder folder_;
};

TEST_F(GltfBroken, TheSoundOneIsSound) {
  EXPECT_EQ(error_of(sound()), "");
}

TEST_F(GltfBroken, PlacesOfWhatIsWrong) {
  EXPECT_THAT(error_after(R"("indices":1)", R"("indices":9)"),
              HasSubstr("meshes[0].primitives[0].indices: is 9, of 5 accessors"));
  EXPECT_THAT(error_after(R"("joints":[1])", R"("joints":[2])"),
              HasSubstr("skins[0].joints[0]: is 2, of 2 nodes"));
  EXPECT_THAT(error_after(R"("children":[1])", R"("children":[0])"), HasSubstr("nodes form a ring"));
  EXPECT_THAT(error_after(R"("children":[1]},{})", R"("children":[1,2]},{"children":[2]},{})"),
              HasSubstr("is a child of node"));
  EXPECT_THAT(error_after(R"("scene":0)", R"("scene":-1)"), HasSubstr("scene: is -1"));
  EXPECT_THAT(error_after(R"("count":3)", R"("count":4)"), HasSubstr("accessors[0]: 4 elements of 12 bytes"));
  EXPECT_THAT(error_after(R"("count":3)", R"("count":2)"), HasSubstr("names vertex 2, of 2"));
  EXPECT_THAT(error_after(R"("componentType":5126)", R"("componentType":5127)"),
              HasSubstr("is 5127, no type of glTF"));
  EXPECT_THAT(error_after(R"("type":"VEC3")", R"("type":"VEC2")"),
              HasSubstr("accessors[0].type: is 'VEC2', must be VEC3"));
  EXPECT_THAT(error_after(R"("byteLength":36)", R"("byteLength":3600)"), HasSubstr("of a buffer of"));
  EXPECT_THAT(error_after(R"("WEIGHTS_0":3)", R"("WEIGHTS_1":3)"), HasSubstr("JOINTS_0 without WEIGHTS_0"));
  EXPECT_THAT(error_after(R"("JOINTS_0":2)", R"("JOINTS_0":3)"), HasSubstr("names joint 1, of 1"));
  EXPECT_THAT(error_after(R"("output":0)", R"("output":4)"),
              HasSubstr("accessors[4].type: is 'SCALAR', must be VEC3"));
  EXPECT_THAT(error_after(R"("targets":[])", R"("targets":[{"POSITION":7}])"),
              HasSubstr("targets[0].POSITION: is 7"));
  EXPECT_THAT(error_after(R"("indices":1)", R"("mode":7)"), HasSubstr("must be 0 to 6"));
}

// Products and sums of these would wrap in 64 bits.
TEST_F(GltfBroken, CountsThatOverflow) {
  for (const char* huge :
       {"4611686018427387904", "9007199254740992", "18446744073709551615", "1e300", "1.5"}) {
    EXPECT_NE(error_after(R"("count":3)", fmt::format(R"("count":{})", huge)), "") << huge;
    EXPECT_NE(error_after(R"("byteOffset":36)", fmt::format(R"("byteOffset":{})", huge)), "") << huge;
    EXPECT_NE(error_after(R"("byteLength":36)", fmt::format(R"("byteLength":{})", huge)), "") << huge;
  }
  // Absent data are zeros, of which a file can state any number.
  EXPECT_THAT(error_after(R"({"bufferView":0,"componentType":5126,"count":3)",
                          R"({"componentType":5126,"count":400000000)"),
              HasSubstr("unfolds to 4800000000 bytes"));
}

TEST_F(GltfBroken, ExtensionsThatAreRequired) {
  EXPECT_THAT(
      error_after(R"("scene":0)",
                  R"("extensionsRequired":["KHR_mesh_quantization","KHR_texture_basisu","EXT_x"],"scene":0)"),
      HasSubstr("requires KHR_texture_basisu, EXT_x"));
  EXPECT_EQ(
      error_after(R"("scene":0)",
                  R"("extensionsUsed":["EXT_x"],"extensionsRequired":["KHR_materials_unlit"],"scene":0)"),
      "");
}

TEST_F(GltfBroken, VersionsAndTexts) {
  EXPECT_THAT(error_after(R"("version":"2.0")", R"("version":"1.0")"), HasSubstr("version 1.0"));
  EXPECT_THAT(error_of("{\"asset\": {,}"), HasSubstr("parse error at line 1, column 12"));
  EXPECT_THAT(error_of(""), HasSubstr("is empty"));
  EXPECT_THAT(error_of("[]"), HasSubstr("not an object"));
  EXPECT_NE(error_of(std::string(1'000'000, '[')), "");  // deep, but no stack to run out of
}

TEST_F(GltfBroken, DeepTreesAreNoRecursion) {
  std::string nodes = R"({"mesh":0,"skin":0,"children":[1]})";
  const int depth = 100'000;
  for (int n = 1; n < depth; ++n) nodes += fmt::format(R"(,{{"children":[{}]}})", n + 1);
  EXPECT_EQ(error_after(R"({"mesh":0,"skin":0,"children":[1]})", nodes), "");
}

TEST_F(GltfBroken, ChunksOfAGlb) {
  const auto word = [](std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
    return bytes;
  };
  std::string json = sound();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto size = static_cast<std::uint32_t>(json.size());
  const auto glb = [&](std::uint32_t version, std::uint32_t total, std::uint32_t chunk) {
    return "glTF" + word(version) + word(total) + word(chunk) + "JSON" + json;
  };
  EXPECT_EQ(error_of(glb(2, 20 + size, size), "file.glb"), "");
  EXPECT_THAT(error_of(glb(1, 20 + size, size), "file.glb"), HasSubstr("glTF version 1"));
  EXPECT_THAT(error_of(glb(2, 24 + size, size), "file.glb"), HasSubstr("cut off"));
  EXPECT_THAT(error_of(glb(2, 20 + size, 0xFFFFFFF0U), "file.glb"), HasSubstr("the chunk at byte 12"));
  EXPECT_THAT(error_of(glb(2, 20 + size, size).substr(0, 15), "file.glb"),
              HasSubstr("15 bytes hold no glTF"));
}

TEST_F(GltfBroken, FilesBesideItAndNoOthers) {
  const std::string text = sound();
  const std::size_t first = text.find(R"("data:)"), last = text.find('"', first + 1) + 1;
  const auto with_uri = [&](const std::string& uri) {
    return error_of(text.substr(0, first) + '"' + uri + '"' + text.substr(last), "sub/file.gltf");
  };
  // The buffer's bytes, as they stand in the file beside.
  test::GltfBuffer buffer;
  std::vector<float> floats{0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string bytes(reinterpret_cast<const char*>(floats.data()), 36);
  bytes += std::string("\0\0\1\0\2\0\0\0", 8) + std::string(12, '\0');
  const std::vector<float> more{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2};
  bytes += std::string(reinterpret_cast<const char*>(more.data()), 60);
  test::write_text(folder_ / "sub/a b%.bin", bytes);
  test::write_text(folder_ / "secret.bin", bytes);
  std::filesystem::create_symlink(folder_ / "secret.bin", folder_ / "sub/link.bin");
  std::filesystem::create_directories(folder_ / "submarine");

  EXPECT_EQ(with_uri("a%20b%.bin"), "");
  EXPECT_EQ(with_uri("./../sub/a%20b%25.bin"), "");
  EXPECT_THAT(with_uri("../secret.bin"), HasSubstr("outside the model's folder"));
  EXPECT_THAT(with_uri("%2e%2e/secret.bin"), HasSubstr("outside the model's folder"));
  EXPECT_THAT(with_uri("../submarine/x.bin"), HasSubstr("outside the model's folder"));
  EXPECT_THAT(with_uri((folder_ / "secret.bin").string()), HasSubstr("outside the model's folder"));
  EXPECT_THAT(with_uri("link.bin"), HasSubstr("outside the model's folder"));
  EXPECT_THAT(with_uri("http://example.org/a.bin"), HasSubstr("only files beside it"));
  EXPECT_THAT(with_uri("missing.bin"), HasSubstr("buffers[0].uri: 'missing.bin' cannot be read"));
  EXPECT_THAT(with_uri("data:application/octet-stream;base64,@@@"), HasSubstr("is not base64"));
  EXPECT_THAT(with_uri("data:application/octet-stream;base64,AAAA"), HasSubstr("and has 3"));
}

}  // namespace
}  // namespace plisse::io
