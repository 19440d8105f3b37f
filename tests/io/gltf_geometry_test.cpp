// glTF geometry through the whole reader: component types, sparse and strided accessors, strips and fans,
// skins, uv sets and their transforms, and what meshoptimizer's and Draco's own encoders made.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>

#include "base/log.h"
#include "io/import.h"
#include "io/picture/png.h"
#include "scene/animation.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/gltf_file.h"

namespace plisse::io {
namespace {

using testing::ElementsAre;
using Points = std::vector<glm::dvec3>;

class GltfGeometry : public testing::Test {
 protected:
  Model import(const std::string& rest) {
    std::ofstream(folder_ / "file.gltf")
        << fmt::format(R"({{"asset":{{"version":"2.0"}},{},{}}})", rest, buffer_.json());
    return import_model(folder_ / "file.gltf");
  }
  // One mesh of one primitive under one node.
  Mesh mesh(const std::string& primitive) {
    return import(fmt::format(R"("nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{{}}}]}}])", primitive))
        .meshes.at(0);
  }
  Points positions(int accessor) {
    return mesh(fmt::format(R"("attributes":{{"POSITION":{}}})", accessor)).positions;
  }

  test::TemporaryFolder folder_;
  test::GltfBuffer buffer_;
};

template <typename Number>
Points normalised_extremes(test::GltfBuffer& buffer, const std::function<Points(int)>& read) {
  constexpr Number low = std::numeric_limits<Number>::min(), high = std::numeric_limits<Number>::max();
  return read(
      buffer.array<Number>("VEC3", {low, 0, high, high, low, 0, 0, high, low}, R"(,"normalized":true)"));
}

TEST_F(GltfGeometry, EveryComponentType) {
  const auto read = [this](int id) { return positions(id); };
  const Points plain{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
  EXPECT_EQ(read(buffer_.array<std::int8_t>("VEC3", {1, 2, 3, 4, 5, 6, 7, 8, 10})), plain);
  EXPECT_EQ(read(buffer_.array<std::uint8_t>("VEC3", {1, 2, 3, 4, 5, 6, 7, 8, 10})), plain);
  EXPECT_EQ(read(buffer_.array<std::int16_t>("VEC3", {1, 2, 3, 4, 5, 6, 7, 8, 10})), plain);
  EXPECT_EQ(read(buffer_.array<std::uint16_t>("VEC3", {1, 2, 3, 4, 5, 6, 7, 8, 10})), plain);
  EXPECT_EQ(read(buffer_.array<std::uint32_t>("VEC3", {1, 2, 3, 4, 5, 6, 7, 8, 10})), plain);
  EXPECT_EQ(read(buffer_.array<float>("VEC3", {1, 2, 3, 4, 5, 6, 7, 8, 10})), plain);
  // Signed: max(c/127, −1), so that −128 is −1 as well (glTF 2.0, 3.11); unsigned: c/255.
  const Points s{{-1, 0, 1}, {1, -1, 0}, {0, 1, -1}}, u{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(normalised_extremes<std::int8_t>(buffer_, read), s);
  EXPECT_EQ(normalised_extremes<std::int16_t>(buffer_, read), s);
  EXPECT_EQ(normalised_extremes<std::uint8_t>(buffer_, read), u);
  EXPECT_EQ(normalised_extremes<std::uint16_t>(buffer_, read), u);
  const Points parts =
      read(buffer_.array<std::int8_t>("VEC3", {64, 0, 0, 0, 1, 0, 0, 0, -64}, R"(,"normalized":true)"));
  EXPECT_NEAR(parts[0].x, 64.0 / 127, 1e-15);
  EXPECT_NEAR(parts[2].z, -64.0 / 127, 1e-15);
}

TEST_F(GltfGeometry, StridedAndOffset) {
  // Two attributes in one view, 20 bytes a vertex, four bytes of something else before.
  const int view =
      buffer_.view<float>({99, 1, 2, 3, 0.5F, 0.25F, 4, 5, 6, 0, 1, 7, 8, 10, 1, 0}, R"(,"byteStride":20)");
  const int position = buffer_.accessor_of(view, 5126, "VEC3", 3, R"(,"byteOffset":4)");
  const int uv = buffer_.accessor_of(view, 5126, "VEC2", 3, R"(,"byteOffset":16)");
  const Mesh found = mesh(fmt::format(R"("attributes":{{"POSITION":{},"TEXCOORD_0":{}}})", position, uv));
  EXPECT_EQ(found.positions, (Points{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}));
  EXPECT_THAT(found.uvs, ElementsAre(glm::vec2(0.5F, 0.75F), glm::vec2(0, 0), glm::vec2(1, 1)));
}

TEST_F(GltfGeometry, Sparse) {
  const int base = buffer_.view<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int indices = buffer_.view<std::uint16_t>({1, 2}), values = buffer_.view<float>({5, 6, 7, 8, 9, 10});
  const std::string sparse = fmt::format(
      R"("sparse":{{"count":2,"indices":{{"bufferView":{},"componentType":5123}},"values":{{"bufferView":{}}}}})",
      indices, values);
  EXPECT_EQ(positions(buffer_.accessor_of(base, 5126, "VEC3", 3, "," + sparse)),
            (Points{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}}));
  // Without a view of its own an accessor is zero but for what is listed.
  EXPECT_EQ(positions(buffer_.accessor(R"({"componentType":5126,"count":3,"type":"VEC3",)" + sparse + "}")),
            (Points{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}}));
}

TEST_F(GltfGeometry, ListsStripsAndFans) {
  const int position = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  const int index = buffer_.array<std::uint8_t>("SCALAR", {4, 3, 2, 1, 0});
  const auto triangles = [&](const std::string& rest) {
    return mesh(fmt::format(R"("attributes":{{"POSITION":{}}}{})", position, rest)).triangles;
  };
  EXPECT_THAT(triangles(""), ElementsAre(0, 1, 2));  // two corners are left over
  // Every other triangle of a strip is turned round, so that all face one way.
  EXPECT_THAT(triangles(R"(,"mode":5)"), ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
  EXPECT_THAT(triangles(R"(,"mode":6)"), ElementsAre(1, 2, 0, 2, 3, 0, 3, 4, 0));
  EXPECT_THAT(triangles(fmt::format(R"(,"mode":5,"indices":{})", index)),
              ElementsAre(4, 3, 2, 3, 1, 2, 2, 1, 0));
}

TEST_F(GltfGeometry, TwelveInfluencesInThreeSets) {
  const int position = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::string attributes = fmt::format(R"("POSITION":{})", position), joints;
  for (std::uint8_t set = 0; set < 3; ++set) {
    const auto j = static_cast<std::uint8_t>(4 * set);
    std::vector<std::uint8_t> ids, bytes;
    for (int v = 0; v < 3; ++v)
      for (std::uint8_t i = 0; i < 4; ++i) ids.push_back(static_cast<std::uint8_t>(j + i));
    // Vertex 0: weight 1 + its number for all twelve joints; vertex 1: joint 0 alone; vertex 2: none.
    for (std::uint8_t i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(1 + j + i));
    bytes.insert(bytes.end(), {static_cast<std::uint8_t>(set == 0 ? 255 : 0), 0, 0, 0, 0, 0, 0, 0});
    attributes +=
        fmt::format(R"(,"JOINTS_{0}":{1},"WEIGHTS_{0}":{2})", set, buffer_.array<std::uint8_t>("VEC4", ids),
                    buffer_.array<std::uint8_t>("VEC4", bytes, R"(,"normalized":true)"));
  }
  std::string nodes = R"({"mesh":0,"skin":0})";
  for (int j = 0; j < 12; ++j) {
    nodes += R"(,{})";
    joints += fmt::format("{}{}", j > 0 ? "," : "", 1 + j);
  }
  const Model model = import(fmt::format(
      R"("nodes":[{}],"skins":[{{"joints":[{}]}}],"meshes":[{{"primitives":[{{"attributes":{{{}}}}}]}}])",
      nodes, joints, attributes));
  const Mesh& found = model.meshes.at(0);
  EXPECT_EQ(found.file_max_influences, 12);
  ASSERT_EQ(found.bones.size(), 13U);  // and the mesh's own node, for vertex 2
  // The strongest eight are joints 11 down to 4 with weights 12 … 5 over their sum of 68.
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(found.influences[0].bone[i], 11 - i);
    EXPECT_NEAR(found.influences[0].weight[i], static_cast<float>(12 - i) / 68, 1e-7F);
  }
  EXPECT_EQ(found.influences[1].bone[0], 0U);
  EXPECT_EQ(found.influences[1].weight[0], 1);
  EXPECT_EQ(found.influences[2].bone[0], 12U);
  EXPECT_EQ(found.bones[12].node, 0);
}

TEST_F(GltfGeometry, OneMeshOnTwoSkeletonsAndAsARigidPart) {
  const int position = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int joints = buffer_.array<std::uint8_t>("VEC4", std::vector<std::uint8_t>(12, 0));
  const int weights = buffer_.array<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const int bind = buffer_.array<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -3, 1});
  // The node of a skinned mesh does not move it; that of a rigid one does, here with a mirror.
  const Model model = import(fmt::format(
      R"("nodes":[{{"mesh":0,"skin":0,"translation":[50,0,0]}},{{"mesh":0,"skin":1}},{{"mesh":1,"scale":[-1,1,1]}},
{{"translation":[0,0,13]}},{{"translation":[0,0,20]}},{{"mesh":1,"translation":[0,9,0]}}],
"skins":[{{"joints":[3],"inverseBindMatrices":{3}}},{{"joints":[4]}}],
"meshes":[{{"name":"coat","primitives":[{{"attributes":{{"POSITION":{0},"JOINTS_0":{1},"WEIGHTS_0":{2}}}}}]}},
{{"name":"button","primitives":[{{"attributes":{{"POSITION":{0}}}}}]}}])",
      position, joints, weights, bind));
  ASSERT_EQ(model.meshes.size(), 3U);
  EXPECT_EQ(model.meshes[0].name, "coat");
  EXPECT_EQ(model.meshes[1].name, "coat");
  EXPECT_EQ(model.nodes[2].meshes, model.nodes[5].meshes);
  scene::Animation animation(model, {});
  const Points posed_points = scene::posed(animation.surface(), animation.pose(1));
  // Bind matrix −3, bone at 13: z = 10. No bind matrix, bone at 20. Mirrored in x. Nine up.
  EXPECT_THAT(posed_points, testing::IsSupersetOf(Points{{1, 0, 10}, {1, 0, 20}, {-1, 0, 0}, {1, 9, 0}}));
  // The mirrored button is wound the other way, so that its outside stays outside: both still face +z.
  for (const Part& part : animation.surface().parts) {
    const Surface& surface = animation.surface();
    const auto at = [&](std::size_t c) {
      return surface.bind[surface.render_vertices[surface.triangles[3 * part.first_triangle + c]].welded];
    };
    EXPECT_GT(glm::cross(at(1) - at(0), at(2) - at(0)).z, 0) << part.mesh;
  }
}

TEST_F(GltfGeometry, InstancesOfOneNode) {
  const int position = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int moves = buffer_.array<float>("VEC3", {0, 0, 0, 0, 0, 7});
  // A quarter turn about z, in normalised bytes; the second twice as large.
  const int turns = buffer_.array<std::int8_t>("VEC4", {0, 0, 0, 127, 0, 0, 90, 90}, R"(,"normalized":true)");
  const int scales = buffer_.array<float>("VEC3", {1, 1, 1, 2, 2, 2});
  const auto file = [&](int scale) {
    return fmt::format(
        R"("extensionsRequired":["EXT_mesh_gpu_instancing"],"nodes":[{{"mesh":0,"translation":[0,100,0],"extensions":
{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":{},"ROTATION":{},"SCALE":{}}}}}}}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}}}}]}}])",
        moves, turns, scale, position);
  };
  scene::Animation animation(import(file(scales)), {});
  const Points points = scene::posed(animation.surface(), animation.pose(1));
  ASSERT_EQ(points.size(), 6U);  // and none at the node itself
  const Points expected{{0, 100, 0}, {1, 100, 0}, {0, 101, 0}, {0, 100, 7}, {0, 102, 7}, {-2, 100, 7}};
  for (std::size_t v = 0; v < 6; ++v) EXPECT_LT(glm::distance(points[v], expected[v]), 1e-12) << v;
  EXPECT_THAT(test::error_of([&] { import(file(position)); }),
              testing::HasSubstr("SCALE: has 3 elements; the other"));
}

TEST_F(GltfGeometry, UvSetsAndTheirTransforms) {
  const int position = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int first = buffer_.array<float>("VEC2", {0, 0, 1, 0, 0, 1});
  const int second = buffer_.array<std::uint8_t>("VEC2", {0, 0, 255, 0, 0, 51}, R"(,"normalized":true)");
  const Model model = import(fmt::format(
      R"("nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"material":0,"attributes":{{"POSITION":{},"TEXCOORD_0":{},
"TEXCOORD_1":{}}}}}]}}],"textures":[{{"source":0}}],"images":[{{"uri":"none.png"}}],
"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0,"extensions":{{"KHR_texture_transform":
{{"offset":[0.5,0.25],"rotation":{},"scale":[2,3]}}}}}}}},"normalTexture":{{"index":0,"texCoord":1,"scale":0.5}}}}])",
      position, first, second, std::numbers::pi / 2));
  // Scaled, then turned counter-clockwise as it is seen, with v down: (u, v) → (v, −u), then moved; then v
  // upward.
  const std::vector<glm::vec2> expected{{0.5F, 0.75F}, {0.5F, 1 - (0.25F - 2)}, {3.5F, 0.75F}};
  for (std::size_t v = 0; v < 3; ++v)
    EXPECT_LT(glm::distance(model.meshes[0].uvs[v], expected[v]), 1e-6F) << v;
  EXPECT_THAT(model.meshes[0].normal_uvs, ElementsAre(glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(0, 0.8F)));
  EXPECT_EQ(model.materials[0].normal_scale, 0.5F);
  EXPECT_EQ(model.materials[0].normal_texture, -1);  // it is not there
}

TEST_F(GltfGeometry, ColoursAreLinearAndWhiteOnesSayNothing) {
  const int position = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int colour = buffer_.array<std::uint8_t>("VEC4", {255, 0, 51, 255, 0, 0, 0, 0, 255, 255, 255, 102},
                                                 R"(,"normalized":true)");
  const int three = buffer_.array<float>("VEC3", {0.5F, 0.25F, 1, 1, 1, 1, 1, 1, 1});
  const int white = buffer_.array<float>("VEC3", {1, 1, 1, 1, 1, 1, 1, 1, 1});
  const auto colours = [&](int id) {
    return mesh(fmt::format(R"("attributes":{{"POSITION":{},"COLOR_0":{}}})", position, id)).colours;
  };
  EXPECT_THAT(colours(colour), ElementsAre(glm::vec4(1, 0, 0.2F, 1), glm::vec4(0), glm::vec4(1, 1, 1, 0.4F)));
  EXPECT_EQ(colours(three).at(0), glm::vec4(0.5F, 0.25F, 1, 1));
  EXPECT_TRUE(colours(white).empty());
}

TEST_F(GltfGeometry, Cameras) {
  buffer_.view<float>({0});
  const int position = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const Model model = import(fmt::format(
      R"("nodes":[{{"mesh":0}},{{"camera":1,"name":"above"}},{{"camera":0,"translation":[0,0,5]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}}}}]}}],"cameras":[{{"name":"front","type":"perspective",
"perspective":{{"yfov":0.5,"znear":0.1}}}},{{"type":"orthographic","orthographic":{{"xmag":2,"ymag":1.5,"znear":0,"zfar":9}}}}])",
      position));
  ASSERT_EQ(model.cameras.size(), 2U);  // in the file's order of cameras
  EXPECT_EQ(model.cameras[0].name, "front");
  EXPECT_EQ(model.cameras[0].vertical_field_of_view, 0.5);
  EXPECT_EQ(model.cameras[0].node, 2);
  EXPECT_EQ(model.cameras[0].half_height, 0);
  EXPECT_EQ(model.cameras[1].name, "above");
  EXPECT_EQ(model.cameras[1].half_height, 1.5);
}

// --- compressed meshes -------------------------------------------------------------------------------------

class GltfMeshopt : public GltfGeometry {
 protected:
  int compressed_view(const std::vector<unsigned char>& bytes, std::size_t count, std::size_t stride,
                      const std::string& mode, const std::string& filter = "NONE") {
    buffer_.view(bytes);
    offset_ = (offset_ + 3) / 4 * 4;
    const std::string json = fmt::format(
        R"({{"buffer":0,"byteLength":{0},"byteStride":{1},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,
"byteOffset":{2},"byteLength":{3},"byteStride":{1},"count":{4},"mode":"{5}","filter":"{6}"}}}}}})",
        count * stride, stride, offset_, bytes.size(), count, mode, filter);
    offset_ += bytes.size();
    return buffer_.bare_view(json);
  }
  template <typename Vertex>
  static std::vector<unsigned char> encode(const std::vector<Vertex>& vertices) {
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vertices.data(), vertices.size(),
                                            sizeof(Vertex)));
    return bytes;
  }
  std::size_t offset_ = 0;  // of the next view in the buffer
};

TEST_F(GltfMeshopt, AttributesTrianglesAndSequences) {
  std::vector<glm::vec3> points;
  std::vector<unsigned> triangles;
  for (unsigned i = 0; i < 40; ++i)
    points.emplace_back(std::sin(i), std::cos(i), 0.1F * static_cast<float>(i));
  for (unsigned i = 0; i + 2 < 40; ++i) triangles.insert(triangles.end(), {i, i + 1, i + 2});
  std::vector<unsigned char> list(meshopt_encodeIndexBufferBound(triangles.size(), points.size()));
  list.resize(meshopt_encodeIndexBuffer(list.data(), list.size(), triangles.data(), triangles.size()));
  std::vector<unsigned char> sequence(meshopt_encodeIndexSequenceBound(triangles.size(), points.size()));
  sequence.resize(
      meshopt_encodeIndexSequence(sequence.data(), sequence.size(), triangles.data(), triangles.size()));

  const int position = buffer_.accessor_of(compressed_view(encode(points), points.size(), 12, "ATTRIBUTES"),
                                           5126, "VEC3", points.size());
  const int as_list = buffer_.accessor_of(compressed_view(list, triangles.size(), 2, "TRIANGLES"), 5123,
                                          "SCALAR", triangles.size());
  const int as_sequence = buffer_.accessor_of(compressed_view(sequence, triangles.size(), 4, "INDICES"), 5125,
                                              "SCALAR", triangles.size());
  const auto read = [&](int index) {
    return mesh(fmt::format(R"("attributes":{{"POSITION":{}}},"indices":{})", position, index));
  };
  const Mesh found = read(as_sequence);
  for (std::size_t v = 0; v < points.size(); ++v)
    EXPECT_EQ(glm::vec3(found.positions[v]), points[v]);  // lossless
  EXPECT_EQ(found.triangles, triangles);
  // TRIANGLES may turn a triangle's corners round, never over.
  const Mesh turned = read(as_list);
  ASSERT_EQ(turned.triangles.size(), triangles.size());
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    std::vector<unsigned> corners(turned.triangles.begin() + static_cast<std::ptrdiff_t>(t),
                                  turned.triangles.begin() + static_cast<std::ptrdiff_t>(t + 3));
    std::rotate(corners.begin(), std::find(corners.begin(), corners.end(), triangles[t]), corners.end());
    EXPECT_THAT(corners, ElementsAre(triangles[t], triangles[t + 1], triangles[t + 2]));
  }
}

TEST_F(GltfMeshopt, Filters) {
  const std::vector<glm::vec4> normals{{0, 0, 1, 0}, {0.6F, 0, 0.8F, 0}, {0, -0.6F, -0.8F, 0}};
  const std::vector<float> points{0, 0, 0, 1, 0.5F, -3, 0, 1, 100};
  std::vector<std::array<std::int8_t, 4>> oct(3);
  meshopt_encodeFilterOct(oct.data(), 3, 4, 8, &normals[0].x);
  std::vector<std::array<std::uint32_t, 3>> exponents(3);
  meshopt_encodeFilterExp(exponents.data(), 3, 12, 20, points.data());
  const int position = buffer_.accessor_of(
      compressed_view(encode(exponents), 3, 12, "ATTRIBUTES", "EXPONENTIAL"), 5126, "VEC3", 3);
  const int normal = buffer_.accessor_of(compressed_view(encode(oct), 3, 4, "ATTRIBUTES", "OCTAHEDRAL"), 5120,
                                         "VEC3", 3, R"(,"normalized":true)");
  const Mesh found = mesh(fmt::format(R"("attributes":{{"POSITION":{},"NORMAL":{}}})", position, normal));
  for (std::size_t v = 0; v < 3; ++v) {
    // 20 bits of mantissa over a vector of up to 100; 8 bits of an octahedron's axis.
    EXPECT_LT(
        glm::distance(found.positions[v], glm::dvec3(points[3 * v], points[3 * v + 1], points[3 * v + 2])),
        2e-4);
    EXPECT_LT(glm::distance(found.normals[v], glm::vec3(normals[v])), 0.02F);
  }
}

TEST_F(GltfGeometry, Draco) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int place = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int shade = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0.5F}, {0, 1, 0}};
  for (unsigned f = 0; f < 2; ++f) {
    builder.SetAttributeValuesForFace(place, draco::FaceIndex(f), &corners[3 * f].x, &corners[3 * f + 1].x,
                                      &corners[3 * f + 2].x);
    const std::array<std::uint8_t, 4> red{255, 0, 0, 255}, clear{0, 51, 0, 0};
    builder.SetAttributeValuesForFace(shade, draco::FaceIndex(f), red.data(), red.data(),
                                      f == 0 ? red.data() : clear.data());
  }
  const auto source = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  draco::EncoderBuffer bytes;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*source, &bytes).ok());
  const std::size_t points = source->num_points();
  const int view = buffer_.view(std::vector<char>(bytes.data(), bytes.data() + bytes.size()));
  const int position =
      buffer_.accessor(fmt::format(R"({{"componentType":5126,"count":{},"type":"VEC3"}})", points));
  const int colour = buffer_.accessor(
      fmt::format(R"({{"componentType":5121,"normalized":true,"count":{},"type":"VEC4"}})", points));
  const int index = buffer_.accessor(R"({"componentType":5123,"count":6,"type":"SCALAR"})");
  const Mesh found = mesh(fmt::format(
      R"("attributes":{{"POSITION":{},"COLOR_0":{}}},"indices":{},"extensions":{{"KHR_draco_mesh_compression":
{{"bufferView":{},"attributes":{{"POSITION":{},"COLOR_0":{}}}}}}})",
      position, colour, index, view, source->attribute(place)->unique_id(),
      source->attribute(shade)->unique_id()));
  ASSERT_EQ(found.triangles.size(), 6U);
  // The encoder may number points and faces anew: compare the corners as they lie in space, colours with
  // them.
  std::vector<std::pair<double, glm::vec4>> left, right;
  const auto key = [](const glm::dvec3& p) { return p.x + 10 * p.y + 100 * p.z; };
  for (const std::uint32_t v : found.triangles)
    left.emplace_back(std::round(10 * key(found.positions[v])), found.colours[v]);
  for (std::size_t c = 0; c < 6; ++c)
    right.emplace_back(std::round(10 * key(corners[c])),
                       c == 5 ? glm::vec4(0, 0.2F, 0, 0) : glm::vec4(1, 0, 0, 1));
  EXPECT_THAT(left, testing::UnorderedElementsAreArray(right));
}

// glTF 2.0, 3.7.2.1.
TEST_F(GltfGeometry, WithoutNormalsMeshesAreFlat) {
  const int places = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int normals = buffer_.array<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  EXPECT_TRUE(mesh(fmt::format(R"("attributes":{{"POSITION":{}}})", places)).flat);
  EXPECT_FALSE(mesh(fmt::format(R"("attributes":{{"POSITION":{},"NORMAL":{}}})", places, normals)).flat);
}

TEST_F(GltfGeometry, PointsAndLinesAreTold) {
  const int places = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const Model model = import(fmt::format(
      R"("nodes":[{{"mesh":0}}],"meshes":[{{"name":"m","primitives":[{{"attributes":{{"POSITION":{0}}}}},{{"mode":1,"attributes":{{"POSITION":{0}}}}}]}}])",
      places));
  EXPECT_EQ(model.meshes.size(), 1U);
  EXPECT_THAT(log::warnings(), testing::Contains(testing::HasSubstr((folder_ / "file.gltf").string() +
                                                                    ": mesh 'm' has points or lines")));
}

// What changes the picture and is not read is named, once; what is as usual is not.
TEST_F(GltfGeometry, LooksThatAreNotReadAreTold) {
  const int places = buffer_.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto read = [&](const std::string& material, const std::string& sampler) {
    const std::size_t before = log::warnings().size();
    const std::string picture = test::base64(encode_png({1, 1, {9, 9, 9, 255}}));
    import(fmt::format(
        R"("nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"material":0,"attributes":{{"POSITION":{}}}}}]}}],
           "materials":[{{"name":"m",{}}}],"textures":[{{"source":0,"sampler":0}}],"samplers":[{{{}}}],
           "images":[{{"uri":"data:image/png;base64,{}"}}])",
        places, material, sampler, picture));
    std::vector<std::string> all = log::warnings();
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(before));
    return all;
  };
  using testing::HasSubstr;
  const std::string textured = R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}})";
  EXPECT_THAT(
      read(textured + R"(,"emissiveFactor":[0,0,0])", R"("wrapS":10497,"minFilter":9987,"magFilter":9729)"),
      testing::IsEmpty());
  EXPECT_THAT(read(R"("emissiveFactor":[0,0.5,0])", ""), ElementsAre(HasSubstr("'m' gives light")));
  EXPECT_THAT(read(R"("extensions":{"KHR_materials_unlit":{}})", ""), ElementsAre(HasSubstr("'m' is unlit")));
  EXPECT_THAT(read(textured, R"("wrapT":33071)"), ElementsAre(HasSubstr("wrapS, wrapT")));
  EXPECT_THAT(read(textured, R"("magFilter":9728)"), ElementsAre(HasSubstr("magFilter, minFilter")));
}

TEST_F(GltfGeometry, TheFirstVersionIsNamed) {
  std::ofstream(folder_ / "old.gltf")
      << R"({"meshes":{"m":{"primitives":[]}},"nodes":{"n":{"meshes":["m"]}}})";
  EXPECT_THAT(test::error_of([&] { import_model(folder_ / "old.gltf"); }),
              testing::HasSubstr("is glTF version 1"));
}

}  // namespace
}  // namespace plisse::io
