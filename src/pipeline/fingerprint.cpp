#include "pipeline/fingerprint.h"

#include <span>
#include <type_traits>

#include "base/version.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/look.h"

namespace plisse::pipeline {
namespace {

template <typename Item>
void add_items(Hash& hash, const std::vector<Item>& items) {
  static_assert(std::is_trivially_copyable_v<Item>);
  hash.add(items.size());
  hash.add_bytes({reinterpret_cast<const std::uint8_t*>(items.data()), items.size() * sizeof(Item)});
}

void add(Hash& hash, const glm::dvec3& v) {
  hash.add(v.x).add(v.y).add(v.z);
}
void add(Hash& hash, const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) hash.add(m[c][r]);
  }
}

}  // namespace

Hash start_hash(const LoadedScene& scene) {
  Hash hash;
  hash.add(version).add(scene.animation.timeline().frames_per_second).add(scene.step_of_frame(0));
  add_items(hash, scene.surface().bind);
  add_items(hash, scene.surface().rest);
  add_items(hash, scene.surface().influences);
  add_items(hash, scene.surface().target_deltas);
  add_items(hash, scene.surface().neighbours.offsets);
  add_items(hash, scene.surface().neighbours.items);
  add_items(hash, scene.waves.wavelength);
  add_items(hash, scene.waves.mask);
  if (!scene.waves.bias.empty()) {
    add_items(hash, scene.waves.bias);
    add_items(hash, scene.waves.start_direction);
    add_items(hash, scene.waves.start_phase);
  }
  if (!scene.waves.carried.empty()) add_items(hash, scene.waves.carried);
  const auto& relax = scene.settings.relax;
  hash.add(relax.mode)
      .add(relax.rounds)
      .add(relax.epsilon)
      .add(relax.interval)
      .add(relax.onset_rounds)
      .add(relax.smoothing_rounds);
  hash.add(scene.settings.wrinkles.dead_zone).add(scene.settings.wrinkles.seed);
  add(hash, scene.units.world_centre);
  hash.add(scene.units.metres);
  return hash;
}

Hash constants_hash(const LoadedScene& scene) {
  Hash hash;
  add_items(hash, scene.waves.wander);
  if (!scene.has_field_a_frame() && !scene.waves.field.empty()) add_items(hash, scene.waves.field);
  add_items(hash, scene.profile.f);
  add_items(hash, scene.profile.derivative);
  hash.add(scene.profile.fine_waves).add(scene.profile.coarse).add(scene.profile.fine);
  for (const auto& vertex : scene.surface().render_vertices) {
    hash.add(vertex.welded)
        .add(vertex.uv.x)
        .add(vertex.uv.y)
        .add(vertex.normal.x)
        .add(vertex.normal.y)
        .add(vertex.normal.z)
        .add(vertex.normal_uv.x)
        .add(vertex.normal_uv.y);
    for (int i = 0; i < 4; ++i) hash.add(vertex.colour[i]);
  }
  add_items(hash, scene.surface().triangles);
  for (const auto& part : draw_parts(scene)) {
    hash.add(part.first_triangle)
        .add(part.triangle_count)
        .add(part.texture)
        .add(part.normal_texture)
        .add(part.normal_scale)
        .add(part.has_colours)
        .add(part.has_alpha)
        .add(part.alpha_cutoff)
        .add(part.two_sided);
    for (int i = 0; i < 4; ++i) hash.add(part.base_colour[i]);
  }
  for (const auto& texture : scene.model.textures) {
    hash.add(texture.image.width).add(texture.image.height);
    hash.add_bytes(texture.image.rgba);
  }
  const passes::Look l = look_of(scene);
  hash.add(l.smooth_blend)
      .add(l.full_gradient)
      .add(l.shadows)
      .add(l.ground)
      .add(l.wireframe)
      .add(l.transparent);
  hash.add(l.roughness).add(l.cavity).add(l.parallax).add(l.sheen);
  add(hash, l.background);
  hash.add(scene.settings.output.width).add(scene.settings.output.height).add(scene.settings.output.samples);
  return hash;
}

void add_pose(Hash& hash, const scene::Pose& pose) {
  for (const auto& m : pose.palette) add(hash, m);
  add_items(hash, pose.morph_weights);
  add_items(hash, pose.cache);
}

void add_solved(Hash& hash, const SolvedClip::Frame& frame) {
  add_items(hash, frame.amplitude);
  add_items(hash, frame.phase);
}

void add_field(Hash& hash, const std::vector<FieldTriangle>& field) {
  add_items(hash, field);
}

void add_view(Hash& hash, const passes::View& view) {
  add(hash, view.view_projection);
  add(hash, view.eye);
  add(hash, view.ambient);
  hash.add(view.floor);
  for (const auto& light : view.lights) {
    add(hash, light.direction);
    add(hash, light.colour);
  }
}

}  // namespace plisse::pipeline
