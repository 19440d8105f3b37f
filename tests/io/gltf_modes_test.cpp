// glTF's three ways from key to key, for all that they move, from the file to the node's matrix: against
// values worked out by hand from the specification's formulas (glTF 2.0, appendix C).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "io/import.h"
#include "scene/animation.h"
#include "scene/rig.h"
#include "support/files.h"
#include "support/gltf_file.h"

namespace plisse::io {
namespace {

// A few products of numbers near 1; keys are exact in single precision unless said otherwise.
constexpr double rounding = 1e-12;
// Of a key rounded to single precision.
constexpr double single = 1e-7;

class GltfModes : public testing::Test {
 protected:
  // One node with one track of two keys, at 1 s and 3 s. `output` holds what the mode wants.
  Model import(const std::string& path, const std::string& type, const std::string& mode,
               const std::vector<float>& output) {
    test::GltfBuffer buffer;
    const int position = buffer.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int delta = buffer.array<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int times = buffer.array<float>("SCALAR", {1, 3});
    const int values = buffer.array<float>(type, output);
    const std::filesystem::path file = folder_.path() / "modes.gltf";
    std::ofstream(file) << fmt::format(
        R"({{"asset":{{"version":"2.0"}},"nodes":[{{"name":"own","mesh":0,"translation":[7,8,9],"scale":[1,-2,1],
"rotation":[0,0,0.6,0.8]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{0}}},"targets":[{{"POSITION":{1}}},{{}}]}}]}}],
"animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"{2}"}}}}],
"samplers":[{{"input":{3},"output":{4},"interpolation":"{5}"}}]}}],{6}}})",
        position, delta, path, times, values, mode, buffer.json());
    return import_model(file);
  }
  static glm::dmat4 matrix(const Model& model, double time) {
    return scene::Rig(model, &model.clips.at(0)).world(time).at(0);
  }
  static double difference(const glm::dmat4& a, const glm::dmat4& b) {
    double largest = 0;
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) largest = std::max(largest, std::abs(a[c][r] - b[c][r]));
    return largest;
  }
  // Where only the translation, the turn about z or the scale is animated the others stay the node's own:
  // (0.6, 0.8) is half the angle's sine and cosine.
  static glm::dmat4 expected(const glm::dvec3& t, double angle, const glm::dvec3& s) {
    return glm::scale(glm::rotate(glm::translate(glm::dmat4{1}, t), angle, glm::dvec3(0, 0, 1)), s);
  }
  static inline const double own_angle = 2 * std::atan2(0.6, 0.8);
  static inline const glm::dvec3 own_place{7, 8, 9}, own_scale{1, -2, 1};
  test::TemporaryFolder folder_;
};

TEST_F(GltfModes, Translation) {
  const std::vector<float> keys{0, 0, 0, 4, 0, 8};
  const auto at = [](const glm::dvec3& t) { return expected(t, own_angle, own_scale); };
  const Model linear = import("translation", "VEC3", "LINEAR", keys),
              step = import("translation", "VEC3", "STEP", keys);
  EXPECT_LT(difference(matrix(linear, 1.5), at({1, 0, 2})), rounding);
  EXPECT_LT(difference(matrix(linear, 0.5), at({0, 0, 0})), rounding);
  EXPECT_LT(difference(matrix(linear, 9), at({4, 0, 8})), rounding);
  EXPECT_LT(difference(matrix(step, 2.999), at({0, 0, 0})), rounding);
  EXPECT_LT(difference(matrix(step, 3), at({4, 0, 8})), rounding);
  // In-tangent, value, out-tangent of each key. At s = ½ of d = 2 s: ½p₀ + d/8·m₀ + ½p₁ − d/8·m₁
  // = (0 + ¼·3 + 2 + ¼, ¼·1, 4).
  const Model cubic =
      import("translation", "VEC3", "CUBICSPLINE", {9, 9, 9, 0, 0, 0, 3, 1, 0, -1, 0, 0, 4, 0, 8, 9, 9, 9});
  EXPECT_LT(difference(matrix(cubic, 2), at({3, 0.25, 4})), rounding);
  // s = ¼: weights 27/32, d·9/64, 5/32, −d·3/64: x = 0.28125·3 + 0.15625·4 + 0.09375·1.
  EXPECT_LT(difference(matrix(cubic, 1.5), at({1.5625, 0.28125, 1.25})), rounding);
  EXPECT_LT(difference(matrix(cubic, 3), at({4, 0, 8})), rounding);
}

TEST_F(GltfModes, Scale) {
  const std::vector<float> keys{1, -2, 1, 3, -2, 2};
  const auto at = [](const glm::dvec3& s) { return expected(own_place, own_angle, s); };
  EXPECT_LT(difference(matrix(import("scale", "VEC3", "LINEAR", keys), 2.5), at({2.5, -2, 1.75})), rounding);
  EXPECT_LT(difference(matrix(import("scale", "VEC3", "STEP", keys), 2.5), at({1, -2, 1})), rounding);
  const Model cubic =
      import("scale", "VEC3", "CUBICSPLINE", {0, 0, 0, 1, -2, 1, 0, 2, 0, 0, 0, 4, 3, -2, 2, 0, 0, 0});
  // s = ½: x 2, y −2 + ¼·2, z 1.5 − ¼·4.
  EXPECT_LT(difference(matrix(cubic, 2), at({2, -1.5, 0.5})), rounding);
}

TEST_F(GltfModes, Rotation) {
  constexpr float half = 0.70710678F;  // a quarter turn about z: (0, 0, sin 45°, cos 45°)
  const std::vector<float> keys{0, 0, 0, 1, 0, 0, half, half};
  const double quarter = std::acos(-1.0) / 2;
  const auto at = [](double angle) { return expected(own_place, angle, own_scale); };
  // Spherical: the angle goes in proportion to time. A chord would give 18.43° at the quarter, not 22.5°.
  EXPECT_LT(difference(matrix(import("rotation", "VEC4", "LINEAR", keys), 1.5), at(quarter / 4)),
            10 * single);
  EXPECT_LT(difference(matrix(import("rotation", "VEC4", "STEP", keys), 2.9), at(0)), rounding);
  // The shorter way round: the second key negated is the same turn.
  EXPECT_LT(difference(matrix(import("rotation", "VEC4", "LINEAR", {0, 0, 0, 1, 0, 0, -half, -half}), 1.5),
                       at(quarter / 4)),
            10 * single);
  // Tangents of 0: at s = ½ the mean of both, made a unit again: half the angle. With an out-tangent of (0,
  // 0, 1, 0): z = ½·half + ¼·1, w = ½ + ½·half, and the turn is 2·atan(z/w).
  EXPECT_LT(
      difference(matrix(import("rotation", "VEC4", "CUBICSPLINE", {0, 0, 0, 0, 0, 0, 0,    1,    0, 0, 0, 0,
                                                                   0, 0, 0, 0, 0, 0, half, half, 0, 0, 0, 0}),
                        2),
                 at(quarter / 2)),
      10 * single);
  const double h = std::sqrt(0.5);
  EXPECT_LT(
      difference(matrix(import("rotation", "VEC4", "CUBICSPLINE", {0, 0, 0, 0, 0, 0, 0,    1,    0, 0, 1, 0,
                                                                   0, 0, 0, 0, 0, 0, half, half, 0, 0, 0, 0}),
                        2),
                 at(2 * std::atan((0.5 * h + 0.25) / (0.5 + 0.5 * h)))),
      10 * single);
}

TEST_F(GltfModes, Weights) {
  const auto weights = [](const Model& model, double time) {
    return scene::Rig(model, &model.clips.at(0)).morph_weights(0, time);
  };
  // Two targets a key.
  const std::vector<float> keys{0, 1, 1, 0.5F};
  EXPECT_EQ(weights(import("weights", "SCALAR", "LINEAR", keys), 1.5), (std::vector<double>{0.25, 0.875}));
  EXPECT_EQ(weights(import("weights", "SCALAR", "STEP", keys), 2.5), (std::vector<double>{0, 1}));
  // Per key: in-tangents of both, values of both, out-tangents of both. s = ½: ½ + ¼·2, ½·1.5 − ¼·(−1).
  const Model cubic = import("weights", "SCALAR", "CUBICSPLINE", {9, 9, 0, 1, 2, 0, 0, -1, 1, 0.5F, 9, 9});
  EXPECT_EQ(weights(cubic, 2), (std::vector<double>{1, 1}));
  EXPECT_EQ(weights(cubic, 3), (std::vector<double>{1, 0.5}));
}

TEST_F(GltfModes, NamesAndClipsWithoutLength) {
  test::GltfBuffer buffer;
  const int position = buffer.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int zero = buffer.array<float>("SCALAR", {0}), value = buffer.array<float>("VEC3", {0, 5, 0});
  const int repeated = buffer.array<float>("SCALAR", {0, 1, 1, 0.5F, 2});
  const int places = buffer.array<float>("VEC3", {0, 0, 0, 1, 0, 0, 2, 0, 0, 9, 9, 9, 4, 0, 0});
  const auto clip = [&](const std::string& name, int times, int output) {
    return fmt::format(R"({{{}"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}],
"samplers":[{{"input":{},"output":{}}}]}})",
                       name, times, output);
  };
  const std::filesystem::path file = folder_.path() / "clips.gltf";
  std::ofstream(file) << fmt::format(
      R"({{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}}}}]}}],
"animations":[{},{},{}],{}}})",
      position, clip("", zero, value), clip(R"("name":"Armature|walk on",)", repeated, places),
      clip(R"("name":"",)", zero, value), buffer.json());
  const Model model = import_model(file);
  ASSERT_EQ(model.clips.size(), 3U);
  EXPECT_EQ(model.clips[0].name, "clip 0");
  EXPECT_EQ(model.clips[0].duration, 0);
  scene::Animation still(model, {.clip = "0"});
  EXPECT_EQ(still.timeline().frame_count, 1);
  EXPECT_EQ(still.pose(1).palette.at(0)[3].y, 0);  // rests where its only frame has it
  EXPECT_EQ(still.surface().rest.at(0).y, 5);
  EXPECT_EQ(model.clips[1].name, "Armature|walk on");
  EXPECT_EQ(scene::Animation(model, {.clip = "Armature|walk on"}).clip_name(), "Armature|walk on");
  // Of keys at one time the last counts, one that goes back is dropped.
  EXPECT_EQ(model.clips[1].channels[0].translation.times, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(model.clips[1].channels[0].translation.values[1], glm::dvec3(2, 0, 0));
  EXPECT_EQ(model.clips[2].name, "clip 2");
}

}  // namespace
}  // namespace plisse::io
