#include "pipeline/reference_scene.h"
#include "pipeline/look.h"

#include <numbers>

#include "base/colour.h"
#include "base/eigen_glm.h"
#include "reference/functions.h"

namespace plisse::pipeline {
namespace {

using Eigen::Index;

template <typename Function>
Eigen::Matrix3Xd columns(std::size_t count, Function&& column) {
  Eigen::Matrix3Xd result(3, static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i) result.col(static_cast<Index>(i)) = to_eigen(glm::dvec3(column(i)));
  return result;
}

Eigen::VectorXd vector(const std::vector<double>& values, double scale = 1) {
  Eigen::VectorXd result(static_cast<Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) result[static_cast<Index>(i)] = values[i] * scale;
  return result;
}

}  // namespace

ReferenceScene::ReferenceScene(const LoadedScene& loaded) : scene(loaded) {
  const Surface& surface = scene.surface();
  const std::size_t count = surface.vertex_count();
  const auto& units = scene.units;
  topology.rest = columns(count, [&](std::size_t v) { return units.rest(surface.rest[v]); });
  topology.neighbours = surface.neighbours;
  topology.corners = surface.corners;
  rest_frames.normal = columns(count, [&](std::size_t v) { return scene.rest.normal[v]; });
  rest_frames.tangent = columns(count, [&](std::size_t v) { return scene.rest.tangent[v]; });
  tangent_neighbour = scene.rest.tangent_neighbour;
  skin.bind = columns(count, [&](std::size_t v) { return units.rest(surface.bind[v]); });
  skin.bind_normal = columns(count, [&](std::size_t v) { return surface.bind_normal[v]; });
  for (const auto& influences : surface.influences) {
    reference::Influences converted;
    for (std::size_t i = 0; i < 8; ++i) {
      converted.entry[i] = influences.entry[i];
      converted.weight[i] = static_cast<double>(influences.weight[i]);
    }
    skin.influences.push_back(converted);
  }
  for (std::size_t t = 0; t < surface.target_count; ++t) {
    skin.deltas.push_back(columns(count, [&](std::size_t v) {
      return glm::dvec3(surface.target_deltas[t * count + v]) / units.metres;
    }));
  }
  wavelength = vector(scene.waves.wavelength, 1 / units.metres);
  mask = vector(scene.waves.mask);
  wander.resize(2, static_cast<Index>(count));
  for (Index v = 0; v < wander.cols(); ++v)
    wander.col(v) =
        rest_frames.basis(v).transpose() * to_eigen(scene.waves.wander[static_cast<std::size_t>(v)]);
  first_phases.resize(static_cast<Index>(count));
  for (std::size_t v = 0; v < count; ++v)
    first_phases[static_cast<Index>(v)] = static_cast<double>(
        passes::initial_phase(scene.settings.wrinkles.seed, static_cast<std::uint32_t>(v)));
  take_bias();
  const auto& settings = scene.settings;
  crush.dead_zone = settings.wrinkles.dead_zone;
  crush.unstrained = scene.waves.unstrained;
  crush.smooth = settings.relax.mode == config::RelaxMode::smooth;
  relax.smooth = crush.smooth;
  relax.descent_rounds = settings.relax.rounds;
  relax.epsilon = settings.relax.epsilon;
  relax.onset_rounds = settings.relax.onset_rounds;
  relax.smoothing_rounds = settings.relax.smoothing_rounds;
}

void ReferenceScene::take_bias() {
  wavelength = vector(scene.waves.wavelength, 1 / scene.units.metres);
  bias.p = columns(scene.waves.bias.size(), [&](std::size_t v) { return scene.waves.bias[v]; });
  bias.carried = columns(scene.waves.carried.size(), [&](std::size_t v) { return scene.waves.carried[v]; });
  bias.phase.assign(scene.waves.start_direction.size(), std::nullopt);
  for (std::size_t v = 0; v < bias.phase.size(); ++v) {
    if (scene.waves.start_direction[v] == glm::dvec3(0)) continue;
    bias.phase[v] = first_phases[static_cast<Index>(v)] = scene.waves.start_phase[v];
  }
}

std::vector<reference::CrushState> ReferenceScene::first_states(const reference::Frames& frames) const {
  std::vector<reference::CrushState> states(static_cast<std::size_t>(topology.size()));
  for (std::size_t v = 0; v < bias.phase.size(); ++v)
    if (bias.phase[v])
      states[v] = {frames.basis(static_cast<Index>(v)).transpose() * to_eigen(scene.waves.start_direction[v]),
                   reference::Status::set};
  return states;
}

reference::SkinPose ReferenceScene::pose(const scene::Pose& pose) const {
  reference::SkinPose result;
  for (const auto& m : pose.palette) result.palette.push_back(to_eigen(scene.units.matrix(m)));
  result.morph_weights = pose.morph_weights;
  return result;
}

Eigen::Matrix3Xd ReferenceScene::positions(const scene::Pose& given) const {
  if (!given.cache.empty()) {
    return columns(given.cache.size(), [&](std::size_t v) { return scene.units.world(given.cache[v]); });
  }
  return reference::skin_positions(skin, pose(given));
}

reference::Frames ReferenceScene::frames(const scene::Pose& given, const Eigen::Matrix3Xd& positions) const {
  std::vector<Eigen::Matrix3d> linear(skin.influences.size(), Eigen::Matrix3d::Identity());
  if (given.cache.empty()) {
    const auto at = pose(given);
    for (std::size_t v = 0; v < linear.size(); ++v) {
      linear[v] = reference::blended_matrix(skin, at, static_cast<Index>(v)).topLeftCorner<3, 3>();
    }
  }
  reference::Frames frames;
  frames.normal = reference::skin_normals(topology, positions, linear, skin.bind_normal);
  frames.tangent = reference::skin_tangents(positions, frames.normal, tangent_neighbour);
  return frames;
}

reference::WaveField WaveSnapshot::field() const {
  reference::WaveField field;
  field.positions = positions;
  field.wavenumbers.resize(3, positions.cols());
  for (Index v = 0; v < positions.cols(); ++v)
    field.wavenumbers.col(v) = frames.basis(v) * wavenumbers.col(v);
  field.weights = weights;
  for (const auto& state : states) field.status.push_back(state.status);
  field.phases = phases;
  return field;
}

WaveSnapshot read_snapshot(const passes::SurfaceBuffers& surface) {
  const std::size_t count = surface.vertex_count;
  const auto positions = surface.positions.read<glm::vec4>(), frames = surface.frames.read<glm::vec4>();
  const auto waves = surface.waves.read<glm::vec4>(), states = surface.states.read<glm::vec4>();
  const auto phases = surface.phases.read<glm::vec2>();
  WaveSnapshot snapshot;
  snapshot.positions = columns(count, [&](std::size_t v) { return glm::vec3(positions[v]); });
  snapshot.frames.normal = columns(count, [&](std::size_t v) { return glm::vec3(frames[2 * v]); });
  snapshot.frames.tangent = columns(count, [&](std::size_t v) { return glm::vec3(frames[2 * v + 1]); });
  const auto n = static_cast<Index>(count);
  snapshot.wavenumbers.resize(2, n);
  for (auto* values : {&snapshot.heights, &snapshot.weights, &snapshot.phases, &snapshot.compression})
    values->resize(n);
  for (std::size_t v = 0; v < count; ++v) {
    const auto i = static_cast<Index>(v);
    snapshot.wavenumbers.col(i) = Eigen::Vector2f(waves[v].x, waves[v].y).cast<double>();
    snapshot.heights[i] = static_cast<double>(waves[v].z);
    snapshot.weights[i] = static_cast<double>(waves[v].w);
    snapshot.phases[i] = static_cast<double>(phases[v].x);
    snapshot.compression[i] = static_cast<double>(states[v].z);
    snapshot.states.push_back({Eigen::Vector2f(states[v].x, states[v].y).cast<double>(),
                               static_cast<reference::Status>(static_cast<int>(phases[v].y))});
  }
  return snapshot;
}

std::vector<reference::Texture> reference_textures(const LoadedScene& scene) {
  std::vector<reference::Texture> textures;
  for (const auto& levels : texture_levels(scene)) {
    reference::Texture texture;
    for (const auto& level : levels) {
      reference::TextureLevel converted{level.width, level.height, {}};
      converted.texels.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
      for (int y = 0; y < level.height; ++y) {
        for (int x = 0; x < level.width; ++x) {
          const auto* texel =
              &level.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                               static_cast<std::size_t>(x))];
          Eigen::Vector4f value;
          for (int c = 0; c < 3; ++c)
            value[c] = static_cast<float>(level.srgb ? srgb_to_linear(texel[c] / 255.0) : texel[c] / 255.0);
          value[3] = static_cast<float>(texel[3] / 255.0);
          // The reference's row 0 is at v = 0, the bottom of the picture.
          converted
              .texels[static_cast<std::size_t>(level.height - 1 - y) * static_cast<std::size_t>(level.width) +
                      static_cast<std::size_t>(x)] = value;
        }
      }
      texture.levels.push_back(std::move(converted));
    }
    textures.push_back(std::move(texture));
  }
  return textures;
}

std::vector<reference::Triangle> reference_triangles(const ReferenceScene& scene,
                                                     const WaveSnapshot& snapshot) {
  const Surface& surface = scene.scene.surface();
  const auto field = snapshot.field();
  std::vector<reference::Triangle> triangles(surface.triangle_count());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    reference::Triangle& triangle = triangles[t];
    for (int c = 0; c < 3; ++c) {
      const RenderVertex& vertex =
          surface.render_vertices[surface.triangles[3 * t + static_cast<std::size_t>(c)]];
      const auto v = static_cast<Index>(vertex.welded);
      triangle.welded[static_cast<std::size_t>(c)] = vertex.welded;
      triangle.waves.corners.col(c) = snapshot.positions.col(v);
      triangle.waves.wavenumbers.col(c) = field.wavenumbers.col(v);
      // A wave without a direction is not drawn.
      triangle.waves.heights[c] = field.wavenumbers.col(v).isZero(0) ? 0 : snapshot.heights[v];
      triangle.waves.phases[c] =
          snapshot.phases[v] +
          2 * std::numbers::pi * snapshot.states[vertex.welded].direction.dot(scene.wander.col(v));
      if (!scene.scene.waves.field.empty()) {
        const auto corner = static_cast<std::size_t>(c);
        const FieldTriangle& carried = scene.scene.waves.field[t];
        if (!triangle.field) triangle.field.emplace();
        triangle.field->amplitudes[c] = carried.amplitude[corner] / scene.scene.units.metres;
        for (int k = 0; k < 3; ++k)
          triangle.field->turns(c, k) = carried.turns[corner][static_cast<std::size_t>(k)];
      }
      triangle.uv.col(c) = Eigen::Vector2f(vertex.uv.x, vertex.uv.y).cast<double>();
      triangle.normal_uv.col(c) = Eigen::Vector2f(vertex.normal_uv.x, vertex.normal_uv.y).cast<double>();
      triangle.colours.col(c) =
          Eigen::Vector4f(vertex.colour.r, vertex.colour.g, vertex.colour.b, vertex.colour.a).cast<double>();
      // The rest normal's components in the posed frame.
      const Eigen::Vector3d m = to_eigen(glm::dvec3(vertex.normal));
      triangle.normals.col(c) = snapshot.frames.basis(v) * (scene.rest_frames.basis(v).transpose() * m) +
                                snapshot.frames.normal.col(v) * scene.rest_frames.normal.col(v).dot(m);
    }
  }
  return triangles;
}

reference::Profile reference_profile(const LoadedScene& scene) {
  const auto& profile = scene.profile;
  auto result = reference::tabulated(profile.f, profile.derivative, profile.slope_variance);
  result.fine_waves = profile.fine_waves;
  result.coarse = profile.coarse;
  result.fine = profile.fine;
  return result;
}

reference::Scene picture_scene(const ReferenceScene& scene, const WaveSnapshot& snapshot,
                               const passes::View& view, const std::vector<reference::Texture>& textures) {
  reference::Scene result;
  result.triangles = reference_triangles(scene, snapshot);
  const auto parts = draw_parts(scene.scene);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto& part = parts[p];
    reference::Material material;
    material.base_colour = to_eigen(glm::dvec3(part.base_colour));
    material.base_alpha = static_cast<double>(part.base_colour.a);
    material.texture = part.texture;
    material.normal_texture = part.normal_texture;
    material.normal_scale = static_cast<double>(part.normal_scale);
    material.alpha_cutoff = part.alpha_cutoff > 0 ? static_cast<double>(part.alpha_cutoff) : -1;
    material.blended = part.has_alpha;
    material.two_sided = part.two_sided;
    result.materials.push_back(material);
    for (std::size_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
      result.triangles[t].material = static_cast<int>(p);
  }
  result.textures = textures;
  result.camera.view_projection = to_eigen(view.view_projection);
  result.camera.eye = to_eigen(view.eye);
  for (std::size_t i = 0; i < 3; ++i) {
    result.lighting.lights[i] = {to_eigen(view.lights[i].direction), to_eigen(view.lights[i].colour)};
  }
  result.lighting.ambient = to_eigen(view.ambient);
  result.lighting.up = to_eigen(view.up);
  const auto& shading = scene.scene.settings.shading;
  result.shading.blend =
      shading.blend == config::Blend::smooth ? reference::Blend::smooth : reference::Blend::linear;
  result.shading.gradient =
      shading.gradient == config::Gradient::full ? reference::Gradient::full : reference::Gradient::paper;
  result.shading.roughness = shading.roughness;
  result.shading.sheen = shading.sheen;
  result.shading.cavity = shading.cavity;
  result.shading.parallax = shading.parallax;
  result.profile = reference_profile(scene.scene);
  return result;
}

ReferenceChain::ReferenceChain(const ReferenceScene& scene) : scene_(scene) {
  now_.phases = scene.first_phases;
  const auto count = scene.topology.size();
  now_.states = scene.first_states(scene.rest_frames);
  now_.wavenumbers = Eigen::Matrix2Xd::Zero(2, count);
  now_.heights = now_.weights = now_.compression = Eigen::VectorXd::Zero(count);
}

void ReferenceChain::step(int step, const scene::Pose& pose, bool with_crush,
                          const std::vector<Eigen::Vector2d>& first_directions) {
  first_directions_ = first_directions;
  const double share = scene_.scene.lead_at(step);
  if (!last_ || *last_ != pose) {
    now_.positions = scene_.positions(pose);
    now_.frames = scene_.frames(pose, now_.positions);
    last_ = pose;
  }
  const bool bias_a_frame = scene_.scene.has_bias_a_frame();
  if (with_crush && (bias_a_frame || !crushed_ || *crushed_ != pose)) {
    if (bias_a_frame) {
      now_.states = scene_.first_states(now_.frames);
      now_.phases = scene_.first_phases;
    }
    crush_and_relax(share > 0);
    crushed_ = pose;
  }
  if (share > 0) lead(reference::Status::set, share);
  if (scene_.scene.remembers_at(step)) remembered_ = now_;
}

void ReferenceChain::crush_and_relax(bool leads) {
  auto crushed = reference::crush(scene_.topology, scene_.rest_frames, now_.positions, now_.frames,
                                  scene_.wavelength, scene_.mask, scene_.crush, now_.states, scene_.bias);
  for (std::size_t v = 0; v < crushed.size(); ++v) {
    const auto i = static_cast<Index>(v);
    if (now_.states[v].direction.isZero(0) && crushed[v].direction.dot(first_directions_[v]) < 0) {
      crushed[v].direction *= -1;
      crushed[v].wave_vector *= -1;
      crushed[v].wavenumber *= -1;
      if (crushed[v].phase) *crushed[v].phase *= -1;
    }
    now_.wavenumbers.col(i) = crushed[v].wavenumber;
    now_.heights[i] = crushed[v].height;
    now_.weights[i] = crushed[v].weight;
    now_.compression[i] = 1 - crushed[v].r;
    now_.states[v] = {crushed[v].direction, crushed[v].status};
    if (crushed[v].phase) now_.phases[i] = *crushed[v].phase;
  }
  if (leads) lead(reference::Status::fresh, 1);
  reference::WaveField field = now_.field();
  reference::relax(scene_.topology, field, scene_.relax);
  now_.phases = field.phases;
  for (std::size_t v = 0; v < now_.states.size(); ++v) now_.states[v].status = field.status[v];
}

void ReferenceChain::lead(reference::Status which, double share) {
  reference::lead(now_.phases, now_.states, remembered_.phases, remembered_.states, which, share);
}

}  // namespace plisse::pipeline
