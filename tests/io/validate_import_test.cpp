// What `validate` lets through and what it stops, one broken thing at a time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "base/error.h"
#include "io/import.h"

namespace plisse::io {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Model whole() {
  Model model;
  model.path = "model.glb";
  model.nodes.resize(2);
  model.nodes[1].parent = 0;
  model.nodes[1].meshes = {0};
  model.nodes[1].morph_weights = {0};
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.uvs.assign(3, {0, 0});
  mesh.triangles = {0, 1, 2};
  mesh.bones.push_back({1, glm::dmat4{1}});
  Influences influences;
  influences.weight[0] = 1;
  mesh.influences.assign(3, influences);
  mesh.targets.push_back({"smile", std::vector<glm::vec3>(3)});
  mesh.material = 0;
  model.meshes.push_back(mesh);
  model.materials.resize(1);
  Channel channel;
  channel.node = 1;
  channel.scale.times = {0, 1};
  channel.scale.values = {{1, 1, 1}, {2, 2, 2}};
  channel.morph_weights.times = {0};
  channel.morph_weights.values = {{0.5}};
  model.clips.push_back({"clip", 1, {channel}});
  return model;
}

TEST(Validate, TakesAWholeModel) {
  EXPECT_NO_THROW(validate(whole()));
}

TEST(Validate, LeavesBadKeyValuesToThePose) {
  Model model = whole();
  model.clips[0].channels[0].scale.values[1].x = static_cast<double>(nan);
  EXPECT_NO_THROW(validate(model));
}

TEST(Validate, StopsEachBrokenThing) {
  const std::vector<std::pair<std::string, std::function<void(Model&)>>> broken = {
      {"no triangles", [](Model& m) { m.meshes[0].triangles.clear(); }},
      {"multiple of three", [](Model& m) { m.meshes[0].triangles.pop_back(); }},
      {"names vertex 3, of 3", [](Model& m) { m.meshes[0].triangles[1] = 3; }},
      {"position 1 is not finite", [](Model& m) { m.meshes[0].positions[1].y = static_cast<double>(nan); }},
      {"1e+18 units from the origin", [](Model& m) { m.meshes[0].positions[1].y = 2e18; }},
      {"normal 2 is not finite", [](Model& m) { m.meshes[0].normals[2].y = nan; }},
      {"uv 0 is not finite", [](Model& m) { m.meshes[0].uvs[0].x = nan; }},
      {"uvs: 2 of them", [](Model& m) { m.meshes[0].uvs.pop_back(); }},
      {"material 7", [](Model& m) { m.meshes[0].material = 7; }},
      {"'smile' has 2 deltas", [](Model& m) { m.meshes[0].targets[0].position_deltas.pop_back(); }},
      {"sum to 0.5", [](Model& m) { m.meshes[0].influences[1].weight[0] = 0.5F; }},
      {"bone weight of -1",
       [](Model& m) {
         m.meshes[0].influences[1].weight = {2, -1};
       }},
      {"names bone 4", [](Model& m) { m.meshes[0].influences[1].bone[0] = 4; }},
      {"2 with bone weights", [](Model& m) { m.meshes[0].influences.pop_back(); }},
      {"moves with node 9", [](Model& m) { m.meshes[0].bones[0].node = 9; }},
      {"bind matrix of bone 0",
       [](Model& m) { m.meshes[0].bones[0].offset[1][1] = static_cast<double>(nan); }},
      {"parents must come before", [](Model& m) { m.nodes[0].parent = 1; }},
      {"parents must come before", [](Model& m) { m.nodes[1].parent = 1; }},
      {"shows mesh 3", [](Model& m) { m.nodes[1].meshes = {3}; }},
      {"places any",
       [](Model& m) { m.nodes[1].meshes.clear(), m.nodes[1].morph_weights.clear(), m.clips.clear(); }},
      {"2 morph weights for 1",
       [](Model& m) {
         m.nodes[1].morph_weights = {0, 0};
       }},
      {"does not come after", [](Model& m) { m.clips[0].channels[0].scale.times[1] = 0; }},
      {"2 key times for 1", [](Model& m) { m.clips[0].channels[0].scale.values.pop_back(); }},
      {"0 and 0 tangents",
       [](Model& m) { m.clips[0].channels[0].scale.interpolation = Interpolation::cubic_spline; }},
      {"2 morph weights for 1",
       [](Model& m) {
         m.clips[0].channels[0].morph_weights.values = {{0, 0}};
       }},
      {"no such node", [](Model& m) { m.clips[0].channels[0].node = 5; }},
      {"lasts -1", [](Model& m) { m.clips[0].duration = -1; }},
      {"texture 0, of 0", [](Model& m) { m.materials[0].base_colour_texture = 0; }},
      {"12 bytes",
       [](Model& m) {
         m.textures.push_back({"t", {2, 2, std::vector<std::uint8_t>(12)}});
       }},
      {"frame 1 of the cache",
       [](Model& m) { m.cache = VertexCache(std::vector<std::vector<glm::dvec3>>(1), 24); }},
      {"camera 'eye'",
       [](Model& m) {
         m.cameras.push_back({"eye", 2, 1});
       }},
  };
  for (const auto& [text, damage] : broken) {
    Model model = whole();
    damage(model);
    try {
      validate(model);
      ADD_FAILURE() << "let through: " << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::bad_input);
      EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("model.glb"), testing::HasSubstr(text)));
    }
  }
}

}  // namespace
}  // namespace plisse::io
