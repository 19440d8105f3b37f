// A model with every field filled goes through bytes and comes back the same; damaged bytes are noticed.
#include "io/model_bytes.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "io/import.h"

namespace plisse::io {
namespace {

Model full_model() {
  Model model;
  model.path = "folder/model.fbx";
  model.metres_per_unit = 0.01;
  model.up = "z";
  model.file_vertex_count = 9;
  model.nodes = {{"root", -1, glm::dmat4{2}, {}, {}}, {"", 0, glm::dmat4{3}, {0, 0}, {0.25}}};
  Mesh& mesh = model.meshes.emplace_back();
  mesh.name = "sheet";
  mesh.material = 0;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.normal_uvs = {{1, 1}, {0, 0}, {1, 0}};
  mesh.colours.assign(3, {0.5F, 0.25F, 1, 1});
  mesh.triangles = {0, 1, 2};
  mesh.bones = {{1, glm::dmat4{4}}};
  mesh.influences.resize(3);
  mesh.influences[2].weight[7] = 0.5F;
  mesh.targets = {{"smile", {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}}};
  mesh.file_max_influences = 11;
  mesh.file_vertices = {4, 2, 8};
  Material& material = model.materials.emplace_back();
  material.name = "wool";
  material.base_colour = {0.1F, 0.2F, 0.3F, 0.4F};
  material.base_colour_texture = 0;
  material.alpha = Material::Alpha::mask;
  material.alpha_cutoff = 0.7F;
  material.two_sided = false;
  model.textures.emplace_back().name = "t.png";
  model.textures[0].use = Texture::Use::normals;
  model.textures[0].image = {1, 1, {1, 2, 3, 4}};
  Channel channel;
  channel.node = 1;
  channel.rotation = {Interpolation::cubic_spline, {0.5}, {{1, 0, 0, 0}}, {{0, 1, 0, 0}}, {{0, 0, 1, 0}}};
  channel.morph_weights = {Interpolation::step, {0, 1}, {{0.5}, {1}}, {}, {}};
  model.clips = {{"walk | fast", 1.5, {channel}}};
  Camera& camera = model.cameras.emplace_back();
  camera.name = "eye";
  camera.node = 1;
  camera.vertical_field_of_view = 0.6;
  return model;
}

std::vector<std::byte> bytes_of(const Model& model) {
  std::vector<std::byte> bytes(byte_count(model));
  write_bytes(model, bytes);
  return bytes;
}

TEST(ModelBytes, ComeBackTheSame) {
  const Model model = full_model();
  const Model back = model_from_bytes(bytes_of(model));
  // Every byte of every field again, and some of them by name.
  EXPECT_EQ(bytes_of(back), bytes_of(model));
  EXPECT_EQ(back.path, model.path);
  EXPECT_EQ(back.meshes[0].positions, model.meshes[0].positions);
  EXPECT_EQ(back.meshes[0].influences[2].weight[7], 0.5F);
  EXPECT_EQ(back.meshes[0].targets[0].position_deltas[2], glm::vec3(7, 8, 9));
  EXPECT_EQ(back.meshes[0].file_vertices, (std::vector<std::uint32_t>{4, 2, 8}));
  EXPECT_EQ(back.materials[0].alpha, Material::Alpha::mask);
  EXPECT_FALSE(back.materials[0].two_sided);
  EXPECT_EQ(back.textures[0].image.rgba, model.textures[0].image.rgba);
  EXPECT_EQ(back.clips[0].channels[0].rotation.out_tangents[0], glm::dquat(0, 0, 1, 0));
  EXPECT_EQ(back.clips[0].channels[0].morph_weights.values[1], std::vector<double>{1});
  EXPECT_EQ(back.cameras[0].vertical_field_of_view, 0.6);
}

TEST(ModelBytes, AnyCutIsNoticed) {
  const std::vector<std::byte> bytes = bytes_of(full_model());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(model_from_bytes(std::span(bytes).first(size)), std::runtime_error) << size;
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_THROW(model_from_bytes(longer), std::runtime_error);
}

// A reader that crashed may have written anything: decoding it and validating must end in an exception or a
// sound model.
TEST(ModelBytes, DamageIsNoticedOrHarmless) {
  const std::vector<std::byte> bytes = bytes_of(full_model());
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::byte> damaged = bytes;
    for (int hit = 0; hit < 3; ++hit) damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    try {
      validate(model_from_bytes(damaged));
    } catch (const std::exception&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);  // counts, enumerations, indices and links are more than a third of these bytes
}

}  // namespace
}  // namespace plisse::io
