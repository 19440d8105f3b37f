#include "bench/subject.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "pipeline/look.h"
#include "pipeline/stepper.h"

namespace plisse::bench {
namespace {

constexpr int bones = 4;

void add_bone_weights(PaletteInfluences& influences, double x) {
  // Hat functions over x: each vertex follows two bones.
  const double at = std::clamp(x, 0.0, 1.0) * (bones - 1);
  const auto left = std::min(static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(bones - 2));
  const double right_weight = at - left;
  influences.entry = {left, left + 1};
  influences.weight = {static_cast<float>(1 - right_weight), static_cast<float>(right_weight)};
  // Skin takes the heaviest first, and nothing after a weight of 0.
  if (right_weight > 0.5) {
    std::swap(influences.entry[0], influences.entry[1]);
    std::swap(influences.weight[0], influences.weight[1]);
  }
}

std::vector<glm::dmat4> bent(double squeeze, double angle, const ModelUnits& units) {
  std::vector<glm::dmat4> palette;
  for (int i = 0; i < bones; ++i) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), angle * i, glm::dvec3(0, 1, 0));
    palette.push_back(units.matrix(glm::scale(turn, glm::dvec3(squeeze, 1, 1))));
  }
  return palette;
}

}  // namespace

Subject subject_of(pipeline::LoadedScene& scene, const std::string& name) {
  Subject subject;
  subject.name = name;
  subject.surface = scene.surface();
  subject.rest = scene.rest;
  subject.waves = scene.waves;
  subject.units = scene.units;
  const int count = scene.animation.timeline().frame_count;
  for (int frame = 1; frame <= count; ++frame) {
    auto& palette = subject.palettes.emplace_back();
    for (const glm::dmat4& m : scene.animation.pose(frame).palette) palette.push_back(scene.units.matrix(m));
  }
  subject.look = pipeline::look_of(scene);
  subject.profile = scene.profile;
  subject.parts = pipeline::draw_parts(scene);
  subject.textures = pipeline::texture_levels(scene);
  subject.view = scene.view(1);
  subject.dead_zone = scene.settings.wrinkles.dead_zone;
  return subject;
}

Subject grid_subject(std::size_t vertices, int width, int height) {
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(vertices))));
  const double spacing = 1.0 / (side - 1);
  Subject subject;
  subject.name = "grid";
  subject.units.metres = 2;
  subject.units.rest_centre = subject.units.world_centre = glm::dvec3(0.5, 0.5, 0);

  Surface& surface = subject.surface;
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      const auto id = static_cast<std::uint32_t>(surface.rest.size());
      // Up to a quarter of the spacing off: neither neighbours nor triangles are alike.
      const double jitter_x = passes::initial_phase(1, id) / 12.6,
                   jitter_y = passes::initial_phase(2, id) / 12.6;
      const glm::dvec3 x((column + jitter_x) * spacing, (row + jitter_y) * spacing, 0);
      surface.rest.push_back(x);
      surface.bind_normal.emplace_back(0, 0, 1);
      add_bone_weights(surface.influences.emplace_back(), x.x);
      surface.render_vertices.push_back({id, glm::vec2(x), glm::vec3(0, 0, 1)});
      if (row + 1 < side && column + 1 < side) {
        for (std::uint32_t corner : {id, id + 1, id + side + 1, id, id + side + 1, id + side})
          surface.triangles.push_back(corner);
      }
    }
  }
  surface.bind = surface.rest;
  Part part;
  part.mesh = "grid";
  part.triangle_count = static_cast<std::uint32_t>(surface.triangle_count());
  part.has_uv = true;
  surface.parts = {part};
  build_adjacency(surface);
  subject.rest = rest_frames(surface);
  subject.waves.wavelength.assign(surface.vertex_count(), 0.05);
  subject.waves.mask.assign(surface.vertex_count(), 1);
  subject.waves.wander.assign(surface.vertex_count(), glm::dvec3(0));
  // Rest, then the squeeze.
  subject.palettes = {bent(1, 0, subject.units), bent(0.75, 0.1, subject.units)};
  subject.profile = passes::make_profile("sinusoid");
  passes::DrawPart draw_part;
  draw_part.triangle_count = part.triangle_count;
  subject.parts = {draw_part};

  passes::View& view = subject.view;
  view.eye = subject.units.world({0.4, 0.5, 2.4});
  view.view_projection = glm::perspective(glm::radians(30.0), static_cast<double>(width) / height, 0.2, 4.0) *
                         glm::lookAt(view.eye, view.eye + view.forward, view.up);
  view.lights = {passes::DirectionalLight{glm::normalize(glm::dvec3(-1, 0.8, 0.7)), glm::dvec3(2.4)},
                 passes::DirectionalLight{glm::normalize(glm::dvec3(1, 0.3, 0.8)), glm::dvec3(0.6)},
                 passes::DirectionalLight{glm::normalize(glm::dvec3(0.3, 0.6, -1)), glm::dvec3(0.8)}};
  return subject;
}

Rig::Rig(const Subject& subject, bool software, const std::string& shader_folder)
    : subject_(subject),
      software_(software),
      surface_(fresh_buffers(subject)),
      skin_(subject.palettes.front().size(), subject.surface.target_count, shader_folder),
      crush_(shader_folder),
      relax_(shader_folder),
      no_morphs_(subject.surface.target_count, 0.0) {
  step();
}

passes::SurfaceBuffers Rig::fresh_buffers(const Subject& subject) {
  return {subject.surface, subject.rest, subject.waves, subject.units, 1};
}

void Rig::restart() {
  surface_ = fresh_buffers(subject_);
  frame_ = 0;
}

void Rig::advance(const config::RelaxSettings& settings) {
  skin();
  if (frame_ % static_cast<std::size_t>(settings.interval) == 0) {
    crush_.run(surface_, subject_.dead_zone, settings.mode == config::RelaxMode::descent);
    relax_.run(surface_, pipeline::relax_options(settings));
  }
  frame_ = (frame_ + 1) % subject_.palettes.size();
}

void Rig::skin() {
  skin_.run(surface_, subject_.palettes[frame_], no_morphs_);
}
void Rig::crush() {
  crush_.run(surface_, subject_.dead_zone, false);
}

void Rig::relax(int rounds, bool onset) {
  passes::RelaxOptions options;
  options.rounds = rounds;
  options.onset = onset;
  relax_.run(surface_, options);
}

void Rig::step() {
  skin();
  crush();
  relax(1, true);
  frame_ = (frame_ + 1) % subject_.palettes.size();
}

void Rig::step_to_middle() {
  while (frame_ < subject_.palettes.size() / 2) step();
  step();
  // The single passes go on with the pose of this last step.
  frame_ = (frame_ + subject_.palettes.size() - 1) % subject_.palettes.size();
}

passes::Look bare(passes::Look look) {
  look.shadows = look.ground = look.wireframe = false;
  return look;
}

void draw(passes::RenderPass& pass, Rig& rig, const Subject& subject, const gpu::Target& target) {
  pass.draw(rig.surface(), subject.view, target, rig.software());
  finish();
}

void finish() {
  glFinish();
}

}  // namespace plisse::bench
