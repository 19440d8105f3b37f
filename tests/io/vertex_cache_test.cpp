// PLY in its three formats against one another, MDD and PC2 caches written here byte by byte, sequences of
// PLY.
#include "io/ply.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/error.h"
#include "io/import.h"
#include "io/read_model.h"
#include "scene/animation.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Numbers as bytes, in the order of bytes that is wanted.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}
  template <typename Value>
  Bytes& operator<<(Value value) {
    char bytes[sizeof(Value)];
    std::memcpy(bytes, &value, sizeof(Value));
    if (big_endian_) std::reverse(bytes, bytes + sizeof(Value));
    text.append(bytes, sizeof(Value));
    return *this;
  }
  std::string text;

 private:
  bool big_endian_;
};

constexpr float corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0.5F}, {0, 1, 0.5F}};

std::string header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment of ours\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n"
         "property short s\nproperty uchar t\nelement face 1\nproperty int flags\n"
         "property list uchar uint vertex_indices\nproperty list uint8 float32 texcoord\nelement other 2\n"
         "property list ushort char name\nend_header\n";
}

std::string ascii_square(double height = 0) {
  std::string text = header("ascii");
  for (const auto& x : corners)
    text += fmt::format("{} {} {} 3 1\n", x[0], x[1], static_cast<double>(x[2]) + height);
  return text + "7 4 0 1 2 3 2 0.5 0.5\n1 65\n0\n";
}

std::string binary_square(bool big_endian) {
  Bytes bytes(big_endian);
  for (const auto& x : corners)
    bytes << x[0] << static_cast<double>(x[1]) << x[2] << std::int16_t{3} << std::uint8_t{1};
  bytes << std::int32_t{7} << std::uint8_t{4} << 0U << 1U << 2U << 3U << std::uint8_t{2} << 0.5F << 0.5F;
  bytes << std::uint16_t{1} << 'A' << std::uint16_t{0};
  return header(big_endian ? "binary_big_endian" : "binary_little_endian") + bytes.text;
}

class PlyModel : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    test::write_text(folder_ / name, text);
    return folder_ / name;
  }
  Model read(const std::string& text) const { return read_model(write("f.ply", text), {}); }
  test::TemporaryFolder folder_;
};

TEST_F(PlyModel, ThreeFormatsAreOneMesh) {
  for (const std::string& text : {ascii_square(), binary_square(false), binary_square(true)}) {
    const Mesh mesh = read(text).meshes.at(0);
    ASSERT_EQ(mesh.positions.size(), 4U);
    for (std::size_t v = 0; v < 4; ++v)
      EXPECT_EQ(mesh.positions[v], glm::dvec3(corners[v][0], corners[v][1], corners[v][2]));
    EXPECT_EQ(mesh.uvs, std::vector<glm::vec2>(4, {3, 1}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_EQ(mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  }
}

TEST_F(PlyModel, EveryCutIsNoticed) {
  // The last element is cut as well: nothing of a file may be missing.
  for (const std::string& text : {binary_square(false), binary_square(true)})
    for (std::size_t size = 0; size < text.size(); ++size)
      EXPECT_THAT(test::error_of([&] { parse_ply(text.substr(0, size), "f.ply", {"x"}); }),
                  HasSubstr("f.ply: "))
          << size;
}

TEST_F(PlyModel, SaysWhatIsWrong) {
  const std::string good = ascii_square();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return test::error_of([&] { read(text); });
  };
  EXPECT_THAT(with("vertex 4", "vertex 4000000000"), HasSubstr("too short"));
  EXPECT_THAT(with("vertex 4", "vertex -4"), HasSubstr("'-4' is no number of items"));
  EXPECT_THAT(with("4 0 1 2 3", "4 0 1 2 4"), HasSubstr("face 0: there is no vertex 4; the file has 4"));
  EXPECT_THAT(with("4 0 1 2 3", "4 0 1 2 -3"), HasSubstr("face 0: there is no vertex -3"));
  EXPECT_THAT(with("4 0 1 2 3", "2 0 1"), HasSubstr("three corners"));
  EXPECT_THAT(with("2 1 0.5", "2 nan 0.5"), AllOf(HasSubstr("vertex 2"), HasSubstr("not finite")));
  EXPECT_THAT(with("2 1 0.5", "2 one 0.5"), HasSubstr("'one' is no number"));
  EXPECT_THAT(with("format ascii", "format text"), HasSubstr("'text' is none of"));
  EXPECT_THAT(with("property short", "property half"), HasSubstr("'half' is no type"));
  EXPECT_THAT(with("float x", "float X"), HasSubstr("element 'vertex' has no property 'x'"));
  EXPECT_THAT(with("face 1", "faces 1"), HasSubstr("'face'"));
  EXPECT_THAT(
      test::error_of([&] { read("ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n"); }),
      HasSubstr("has no property 'x'"));
}

// A colour, a flag of a face or another element that is not a number does not stand in a surface's way.
TEST_F(PlyModel, WhatIsNotUsedMayBeAnything) {
  std::string text = ascii_square();
  text.replace(text.find("2 0.5 0.5"), 9, "2 nan inf");
  EXPECT_EQ(read(text).meshes.at(0).triangles.size(), 6U);
}

TEST_F(PlyModel, SequencesKeepTheirMesh) {
  for (int n = 1; n <= 3; ++n) write(fmt::format("c_{:02}.ply", n), ascii_square(n));
  const Model model = import_model(folder_.path(), {0.5, "z"});
  ASSERT_EQ(model.cache.size(), 3U);
  // z is up: (x, y, z) becomes (x, z, −y), halved by the unit.
  EXPECT_EQ(model.cache.frame(1)->at(2), glm::dvec3(1, 1.25, -0.5));
  EXPECT_EQ(model.meshes[0].positions[2], glm::dvec3(1, 0.75, -0.5));
  write("c_02.ply", binary_square(true));  // another format, the same mesh
  EXPECT_EQ(import_model(folder_.path()).cache.frame(1)->at(2), glm::dvec3(2, 1, 0.5));
  std::string other = ascii_square();
  other.replace(other.find("4 0 1 2 3"), 9, "4 1 2 3 0");
  write("c_02.ply", other);
  EXPECT_THAT(test::error_of([&] { scene::Animation(import_model(folder_.path()), {}); }),
              AllOf(HasSubstr("c_02.ply"), HasSubstr("other vertices")));
}

// --- point caches

struct Cache {
  std::vector<std::vector<glm::vec3>> frames;
  std::vector<float> times;
};

std::string mdd(const Cache& cache) {
  Bytes bytes(true);
  bytes << static_cast<std::int32_t>(cache.frames.size())
        << static_cast<std::int32_t>(cache.frames[0].size());
  for (const float time : cache.times) bytes << time;
  for (const auto& frame : cache.frames)
    for (const glm::vec3& x : frame) bytes << x.x << x.y << x.z;
  return bytes.text;
}

std::string pc2(const Cache& cache, float step) {
  Bytes bytes(false);
  bytes.text = std::string("POINTCACHE2\0", 12);
  bytes << std::int32_t{1} << static_cast<std::int32_t>(cache.frames[0].size()) << 0.0F << step
        << static_cast<std::int32_t>(cache.frames.size());
  for (const auto& frame : cache.frames)
    for (const glm::vec3& x : frame) bytes << x.x << x.y << x.z;
  return bytes.text;
}

// Four vertices in the order of the file, moved up by f in frame f.
Cache rising(std::size_t frames) {
  Cache cache;
  for (std::size_t f = 0; f < frames; ++f) {
    auto& frame = cache.frames.emplace_back();
    for (const auto& x : corners) frame.emplace_back(x[0], x[1], x[2] + static_cast<float>(f));
    cache.times.push_back(static_cast<float>(f) / 30);
  }
  return cache;
}

class PointCaches : public PlyModel {
 protected:
  // The second quad shares an edge whose vertices have other uvs: six vertices in memory, four in the file.
  std::filesystem::path obj() const {
    return write("mesh.obj",
                 "v 0 0 0\nv 2 0 0\nv 2 1 .5\nv 0 1 .5\nvt 0 0\nvt 1 1\nf 4/1 1/1 2/1\nf 2/2 3/2 4/2\n");
  }
  std::string error_with(const std::string& name, const std::string& bytes) const {
    ImportOptions options;
    options.cache = write(name, bytes);
    return test::error_of([&] { import_model(obj(), options); });
  }
};

TEST_F(PointCaches, MoveTheVerticesOfTheFile) {
  for (const std::string name : {"cache.mdd", "cache.pc2"}) {
    ImportOptions options;
    options.cache = write(name, name == "cache.mdd" ? mdd(rising(3)) : pc2(rising(3), 0.8F));
    options.up = "z";
    options.metres_per_unit = 0.01;
    const Model model = import_model(obj(), options);
    ASSERT_EQ(model.cache.size(), 3U);
    EXPECT_NEAR(model.cache.frames_per_second(), 30, 1e-5);  // 24/0.8; times and steps are floats
    ASSERT_EQ(model.meshes[0].positions.size(), 6U);
    // Vertex 0 of the mesh is vertex 4 of the file, at (0, 1, 0.5 + f); z up and centimetres.
    EXPECT_NEAR(glm::distance(model.cache.frame(2)->at(0), glm::dvec3(0, 0.025, -0.01)), 0, 1e-9);
    scene::Animation animation(model, {});
    EXPECT_EQ(animation.surface().vertex_count(), 4U);
    EXPECT_EQ(animation.timeline().frame_count, 3);
    // The surface has the file's order, in which it is the last.
    EXPECT_NEAR(scene::posed(animation.surface(), animation.pose(3))[3].y, 0.025, 1e-9);
  }
}

// In glTF vertices count as they stand there, and the node places them.
TEST_F(PointCaches, GoWithTheNodeWhereTheFormatHasNodes) {
  const std::filesystem::path path = test::asset("square.glb");
  const Model still = import_model(path);
  ASSERT_EQ(still.meshes.size(), 1U);
  Cache cache;
  auto& frame = cache.frames.emplace_back();
  for (const glm::dvec3& position : still.meshes[0].positions) frame.emplace_back(position);
  cache.times = {0};
  ImportOptions options;
  options.cache = write("cache.mdd", mdd(cache));
  const Model model = import_model(path, options);
  glm::dmat4 world{1};
  for (const Node& node : still.nodes) {
    ASSERT_LT(node.parent, 1) << "this test knows chains of two";
    if (!node.meshes.empty()) world = (node.parent == 0 ? still.nodes[0].local : glm::dmat4{1}) * node.local;
  }
  for (std::size_t v = 0; v < frame.size(); ++v) {
    const glm::dvec3 expected(world * glm::dvec4(still.meshes[0].positions[v], 1));
    EXPECT_NEAR(glm::distance(model.cache.frame(0)->at(v), expected), 0,
                1e-6);  // floats of a model one metre wide
  }
  // Formats that are read through assimp have lost the order of the exporter.
  options.cache = write("three.mdd", mdd(rising(1)));
  const auto x =
      write("mesh.x",
            "xof 0303txt 0032\nFrame Root {\n Mesh Sheet {\n  4;\n  0.0;0.0;0.0;,\n  2.0;0.0;0.0;,\n"
            "  2.0;1.0;0.5;,\n  0.0;1.0;0.5;;\n  1;\n  4;0;1;2;3;;\n }\n}\n");
  EXPECT_THAT(test::error_of([&] { import_model(x, options); }), HasSubstr("OBJ or PLY"));
}

TEST_F(PointCaches, SayWhatIsWrong) {
  const std::string good = mdd(rising(3));
  EXPECT_THAT(error_with("c.mdd", good.substr(0, good.size() - 1)), HasSubstr("cut off"));
  EXPECT_THAT(error_with("c.mdd", ""), HasSubstr("too short"));
  EXPECT_THAT(error_with("c.pc2", good), HasSubstr("POINTCACHE2"));
  EXPECT_THAT(error_with("c.xyz", good), HasSubstr("MDD or PC2"));
  EXPECT_THAT(error_with("c.pc2", pc2(rising(3), 0)), HasSubstr("every 0 frames"));
  Cache five = rising(2);
  for (auto& frame : five.frames) frame.emplace_back(0, 0, 0);
  EXPECT_THAT(error_with("c.mdd", mdd(five)), AllOf(HasSubstr("5 points"), HasSubstr("4 vertices")));
  // Counts whose product would not fit 32 bits, in a file of a few bytes.
  Bytes huge(true);
  huge << std::int32_t{0x7FFFFFFF} << std::int32_t{4};
  EXPECT_THAT(error_with("c.mdd", huge.text), HasSubstr("cut off"));
}

// Far more frames than stay in memory: 1000 frames of 4 vertices, of which the cache keeps two.
TEST_F(PointCaches, FramesStreamInAnyOrder) {
  class Counting : public FrameSource {
   public:
    std::size_t count() const override { return 1000; }
    std::vector<glm::dvec3> read(std::size_t frame) const override {
      ++reads;
      return std::vector<glm::dvec3>(4, glm::dvec3(static_cast<double>(frame)));
    }
    mutable int reads = 0;
  };
  const auto source = std::make_shared<Counting>();
  const VertexCache cache(source, 24, 1);
  const VertexCache::Frame first = cache.frame(0);
  for (std::size_t f = 0; f < 1000; ++f) EXPECT_EQ(cache.frame(f)->at(3).x, static_cast<double>(f));
  EXPECT_EQ(source->reads, 1000);
  EXPECT_EQ(cache.frame(999)->at(0).x, 999);  // still there
  EXPECT_EQ(source->reads, 1000);
  EXPECT_EQ(cache.frame(0)->at(0).x, 0);
  EXPECT_EQ(source->reads, 1001);
  EXPECT_EQ(first->at(0).x, 0);  // outlives its place in the cache
}

// Times of an MDD count from its first one; uneven ones are kept, useless ones make even steps.
TEST_F(PointCaches, KeepTheirTimes) {
  const auto times = [&](std::vector<float> of_file) {
    Cache cache = rising(3);
    cache.times = std::move(of_file);
    ImportOptions options;
    options.cache = write("cache.mdd", mdd(cache));
    return import_model(obj(), options).cache.times();
  };
  using testing::ElementsAre;
  EXPECT_THAT(times({2, 2.25F, 3}), ElementsAre(0, 0.25, 1));
  EXPECT_THAT(times({0, 0, 0}), ElementsAre(0, 1 / 24.0, 2 / 24.0));
  EXPECT_THAT(times({0, 2, 1}), ElementsAre(0, 0.5, 1));
  ImportOptions options;
  options.cache = write("cache.pc2", pc2(rising(3), 0.5F));
  EXPECT_THAT(import_model(obj(), options).cache.times(), ElementsAre(0, 1 / 48.0, 2 / 48.0));
}

}  // namespace
}  // namespace plisse::io
