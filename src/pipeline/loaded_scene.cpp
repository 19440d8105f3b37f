#include "pipeline/loaded_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <span>

#include "base/colour.h"
#include "base/error.h"
#include "base/version.h"
#include "config/frames.h"
#include "config/options.h"
#include "config/paint_file.h"
#include "config/suggest.h"
#include "io/import_place.h"
#include "io/sequence.h"
#include "io/wrinkle_field.h"
#include "paint/bias_file.h"
#include "paint/field.h"
#include "pipeline/garment_model.h"
#include "scene/wavelength_map.h"
#include "scene/wrinkles.h"

namespace plisse::pipeline {
namespace {

AnimationChoice choice_of(const SceneSettings& scene) {
  const ModelSettings& model = scene.model;
  return {model.clip, model.frames_per_second, model.rest, model.loop, scene.limits};
}

glm::dvec3 linear(const glm::vec3& srgb) {
  return {srgb_to_linear(static_cast<double>(srgb.r)), srgb_to_linear(static_cast<double>(srgb.g)),
          srgb_to_linear(static_cast<double>(srgb.b))};
}

Animation::Bounds bounds_of(const std::vector<glm::dvec3>& points) {
  Animation::Bounds bounds{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (const auto& x : points) {
    bounds.low = glm::min(bounds.low, x);
    bounds.high = glm::max(bounds.high, x);
  }
  return bounds;
}

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

// Does what takes in the file that a key names; an error says where the scene has that key.
template <typename Work>
void for_key(const SceneSettings& scene, const std::string& key, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    const auto place = scene.places.find(key);
    if (place == scene.places.end()) throw;
    throw Error(error.code, fmt::format("{}: {}", place->second, error.what()));
  }
}

}  // namespace

}  // namespace plisse::pipeline

namespace plisse {

io::ImportOptions import_options(const SceneSettings& scene) {
  io::ImportOptions options;
  if (scene.model.metres_per_unit > 0) options.metres_per_unit = scene.model.metres_per_unit;
  options.up = scene.model.up;
  options.cache = scene.model.cache;
  options.limits = scene.limits;
  return options;
}

}  // namespace plisse

namespace plisse::pipeline {

LoadedScene::LoadedScene(const SceneSettings& given)
    : settings(given),
      model(load_model(given)),
      animation(model, choice_of(given)),
      profile(passes::with_finer_waves(passes::make_profile(given.wrinkles.profile), given.wrinkles.fine,
                                       given.wrinkles.fine_share)) {
  select_parts(animation.surface(), settings.wrinkles);
  if (settings.wrinkles.wavelength <= 0) settings.wrinkles.wavelength = default_wavelength(surface());
  rest = rest_frames(surface());
  waves = vertex_waves(surface(), settings.wrinkles, wavelength());
  if (!settings.wrinkles.wavelength_map.empty()) {
    for_key(settings, "wrinkles.wavelength_map", [&] {
      take_wavelengths(surface(), settings.wrinkles, io::file_to_world(model.up, model.metres_per_unit),
                       waves);
    });
  }
  preroll_ = settings.model.loop ? animation.timeline().frame_count : 0;

  const std::vector<glm::dvec3> samples = animation.samples();
  bounds_ = bounds_of(samples);
  const auto rest_bounds = bounds_of(surface().rest);
  units.metres = passes::ModelUnits::unit_for(
      std::max(glm::distance(bounds_.low, bounds_.high), glm::distance(rest_bounds.low, rest_bounds.high)));
  units.world_centre = 0.5 * (bounds_.low + bounds_.high);
  units.rest_centre = 0.5 * (rest_bounds.low + rest_bounds.high);
  settings.camera = fitted_camera(settings, samples);
  take_bias();

  Hash& hash = state_base_;
  hash.add(version).add(animation.timeline().frames_per_second).add(preroll_);
  add_items(hash, surface().bind);
  add_items(hash, surface().rest);
  add_items(hash, surface().influences);
  add_items(hash, surface().target_deltas);
  add_items(hash, surface().neighbours.offsets);
  add_items(hash, surface().neighbours.items);
  add_items(hash, waves.wavelength);
  add_items(hash, waves.mask);
  if (!waves.bias.empty()) {
    add_items(hash, waves.bias);
    add_items(hash, waves.start_direction);
    add_items(hash, waves.start_phase);
  }
  const auto& relax = settings.relax;
  hash.add(relax.mode)
      .add(relax.rounds)
      .add(relax.epsilon)
      .add(relax.interval)
      .add(relax.onset_rounds)
      .add(relax.smoothing_rounds);
  hash.add(settings.wrinkles.dead_zone).add(settings.wrinkles.seed);
  add(hash, units.world_centre);
  hash.add(units.metres);
}

passes::Look LoadedScene::look() const {
  const auto& s = settings.shading;
  passes::Look look;
  look.smooth_blend = s.blend == Blend::smooth;
  look.full_gradient = s.gradient == Gradient::full;
  look.field = !waves.field.empty();
  look.shadows = settings.light.shadows;
  look.ground = settings.output.ground;
  look.wireframe = s.wireframe;
  look.roughness = s.roughness;
  look.cavity = s.cavity;
  look.parallax = s.parallax;
  look.sheen = s.sheen;
  look.background = linear(settings.output.background);
  look.transparent = settings.output.transparent;
  return look;
}

bool LoadedScene::wrinkles(const Part& part) const {
  if (has_field_a_frame()) return true;
  for (std::size_t t = part.first_triangle; t < std::size_t{part.first_triangle} + part.triangle_count; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = surface().render_vertices[surface().triangles[3 * t + i]].welded;
      if (waves.mask[v] > 0) return true;
      if (!waves.field.empty() && waves.field[t].amplitude[i] > 0) return true;
    }
  }
  return false;
}

std::vector<passes::DrawPart> LoadedScene::draw_parts() const {
  std::vector<passes::DrawPart> parts;
  for (const Part& part : surface().parts) {
    passes::DrawPart draw;
    draw.first_triangle = part.first_triangle;
    draw.triangle_count = part.triangle_count;
    // A surface without a look of its own gets the scene's.
    const glm::vec3 plain(linear(settings.shading.colour));
    draw.base_colour = glm::vec4(plain, 1);
    if (part.material >= 0) {
      const io::Material& material = model.materials[static_cast<std::size_t>(part.material)];
      const bool textured = material.base_colour_texture >= 0 && part.has_uv;
      draw.two_sided = material.two_sided;
      draw.texture = textured ? material.base_colour_texture : -1;
      draw.normal_texture = part.has_uv ? material.normal_texture : -1;
      draw.normal_scale = material.normal_scale;
      const bool white = glm::vec3(material.base_colour) == glm::vec3(1);
      if (textured || !white || part.has_colours)
        draw.base_colour = material.base_colour;
      else
        draw.base_colour.a = material.base_colour.a;
      draw.has_alpha = material.alpha == io::Material::Alpha::blend;
      draw.alpha_cutoff = material.alpha == io::Material::Alpha::mask ? material.alpha_cutoff : 0.0F;
    }
    draw.wrinkles = wrinkles(part);
    draw.has_colours = part.has_colours;
    if (part.has_colours && part.material < 0) draw.base_colour = glm::vec4(1);
    parts.push_back(draw);
  }
  return parts;
}

std::vector<std::vector<passes::TextureLevel>> LoadedScene::texture_levels() const {
  std::vector<std::vector<passes::TextureLevel>> all;
  for (const auto& texture : model.textures) {
    all.push_back(passes::mip_levels(texture.image.width, texture.image.height, texture.image.rgba,
                                     texture.use == io::Texture::Use::colour));
  }
  return all;
}

namespace {

// Half the picture's width and height at distance 1. The film is 36 mm along the longer side of the picture.
glm::dvec2 half_film(const SceneSettings& settings) {
  const double aspect = static_cast<double>(settings.output.width) / settings.output.height;
  const double half_long = 18.0 / settings.camera.focal_length;
  return aspect >= 1 ? glm::dvec2(half_long, half_long / aspect) : glm::dvec2(half_long * aspect, half_long);
}

// What lies flat is looked at from higher up, lest it be a line: from a height of 0.3 of the narrower side
// downward.
double elevation_for(const glm::dvec3& size) {
  const double flat = 1 - std::min(size.y / std::max(0.3 * std::min(size.x, size.z), 1e-12), 1.0);
  return 15 + 35 * flat;
}

}  // namespace

// Where no camera is given, or only its direction: the place nearest to the model from which every sampled
// point of the clip is in the picture. In the camera's own axes a point (x, y) at depth z is seen where |x −
// s| ≤ (z + d) tan, so each side of the picture is a plane that the points push outward.
CameraSettings LoadedScene::fitted_camera(const SceneSettings& given,
                                          const std::vector<glm::dvec3>& samples) const {
  CameraSettings camera = given.camera;
  if (!camera.name.empty() || camera.explicit_pose) return camera;
  if (camera.elevation == CameraSettings::from_the_shape)
    camera.elevation = elevation_for(bounds_.high - bounds_.low);
  const double a = glm::radians(camera.azimuth), e = glm::radians(camera.elevation);
  const glm::dvec3 toward(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
  glm::dvec3 right = glm::cross(glm::dvec3(0, 1, 0), toward);
  right = glm::length(right) > 1e-6 ? glm::normalize(right) : glm::dvec3(1, 0, 0);
  const glm::dvec3 high = glm::cross(toward, right), centre = 0.5 * (bounds_.low + bounds_.high);
  const glm::dvec2 tangent = half_film(given) / camera.margin;
  glm::dvec4 push(-INFINITY);  // right, left, up, down
  double nearest = -INFINITY;
  for (const glm::dvec3& point : samples) {
    const glm::dvec3 d = point - centre;
    const double x = glm::dot(d, right), y = glm::dot(d, high), z = glm::dot(d, toward);
    push = glm::max(push,
                    glm::dvec4(x + z * tangent.x, -x + z * tangent.x, y + z * tangent.y, -y + z * tangent.y));
    nearest = std::max(nearest, z);
  }
  const double radius = std::max(0.5 * glm::distance(bounds_.low, bounds_.high), 1e-9);
  double distance = camera.distance;
  if (distance <= 0) {
    distance = std::max({0.5 * (push[0] + push[1]) / tangent.x, 0.5 * (push[2] + push[3]) / tangent.y,
                         nearest + 0.01 * radius});
  }
  camera.target = centre + 0.5 * (push[0] - push[1]) * right + 0.5 * (push[2] - push[3]) * high;
  camera.eye = camera.target + distance * toward;
  camera.explicit_pose = true;
  return camera;
}

namespace {

// By name, or else by index. Throws Error(bad_input) naming those there are.
const io::Camera& model_camera(const io::Model& model, const std::string& choice) {
  std::vector<std::string> names;
  for (const io::Camera& camera : model.cameras) names.push_back(camera.name);
  const auto named = std::find(names.begin(), names.end(), choice);
  if (named != names.end()) return model.cameras[static_cast<std::size_t>(named - names.begin())];
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::to_string(i) == choice) return model.cameras[i];
  throw Error(
      ExitCode::bad_input,
      fmt::format(
          "{}: no camera '{}'{}; it has {}; or give azimuth,elevation[,focal] or eye=x,y,z;target=x,y,z",
          model.path.string(), choice, did_you_mean(choice, names),
          names.empty() ? std::string("none") : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

void LoadedScene::take_bias() {
  const BiasSettings& given = settings.bias;
  if (!given.paint.empty()) waves.bias = painted(load_paint(given.paint));
  if (!given.file.empty())
    for_key(settings, "bias.file", [&] { waves.bias = paint::read_bias(given.file, surface(), rest); });
  if (!given.field.empty())
    for_key(settings, "bias.field",
            [&] { names_many_files(given.field) ? take_field_files() : take_field(); });
}

void LoadedScene::take_field() {
  const BiasSettings& given = settings.bias;
  const auto field =
      paint::field_on(surface(), io::read_wrinkle_field(given.field, settings.model.path),
                      io::file_to_world(model.up, model.metres_per_unit), given.field.string());
  if (given.use == FieldUse::bias)
    paint::field_as_bias(surface(), rest, field, settings.wrinkles.dead_zone, waves);
  else
    waves.field = paint::field_directly(surface(), rest, field, waves.mask);
}

// One field a frame. Each has all the waves of its frame's surface: what that surface is compressed against
// the rest pose is what the field was solved for, and no reason for more.
void LoadedScene::take_field_files() {
  const std::filesystem::path& pattern = settings.bias.field;
  field_files_ = io::sequence_files(pattern);
  const auto frames = static_cast<std::size_t>(animation.timeline().frame_count);
  if (field_files_.size() != frames) {
    throw Error(ExitCode::bad_input,
                fmt::format("{}: there are {} fields, {} to {}, but the clip has {} frames; each needs one",
                            pattern.string(), field_files_.size(), field_files_.front().filename().string(),
                            field_files_.back().filename().string(), frames));
  }
  const std::filesystem::path& mesh = settings.model.path;
  if (std::filesystem::is_directory(mesh) || names_many_files(mesh)) field_meshes_ = io::sequence_files(mesh);
  field_mask_ = waves.mask;
  std::fill(waves.mask.begin(), waves.mask.end(), 0.0);
  waves.field = field_over(posed(surface(), animation.pose(1)), 1);
  field_frame_ = 1;
}

std::vector<FieldTriangle> LoadedScene::field_over(const std::vector<glm::dvec3>& positions,
                                                   int frame) const {
  const auto index = static_cast<std::size_t>(frame - 1);
  Surface base = surface();
  base.rest = positions;
  const auto file = io::read_wrinkle_field(
      field_files_.at(index), index < field_meshes_.size() ? field_meshes_[index] : settings.model.path);
  const auto field = paint::field_on(base, file, io::file_to_world(model.up, model.metres_per_unit),
                                     field_files_[index].string());
  return paint::field_directly(base, rest_frames(base), field, field_mask_);
}

void LoadedScene::take_field(int step) {
  const int frame = frame_of_step(step);
  if (field_files_.empty() || frame == field_frame_) return;
  waves.field = field_over(posed(surface(), pose(step)), frame);
  field_frame_ = frame;
}

void LoadedScene::visit_fields(const std::function<void(const std::vector<FieldTriangle>&)>& work) const {
  if (field_files_.empty()) return work(waves.field);
  Animation posing(model, choice_of(settings));
  for (int frame = 1; frame <= posing.timeline().frame_count; ++frame)
    work(field_over(posed(surface(), posing.pose(frame)), frame));
}

std::vector<glm::dvec3> LoadedScene::painted(const PaintSettings& paint) const {
  const paint::Canvas canvas{surface(), rest, [this](const PaintStroke& stroke) { return screen(stroke); }};
  return paint::paint(canvas, paint.strokes);
}

paint::Screen LoadedScene::screen(const PaintStroke& stroke) const {
  // An animation of its own: the scene's is asked for its frames in order.
  Animation posing(model, choice_of(settings));
  if (stroke.frame > posing.timeline().frame_count) {
    throw Error(ExitCode::bad_input, fmt::format("{}: there is no frame {}; the clip has {}", stroke.place,
                                                 stroke.frame, posing.timeline().frame_count));
  }
  SceneSettings given = settings;
  if (stroke.width > 0) {
    given.output.width = stroke.width;
    given.output.height = stroke.height;
  }
  if (!stroke.camera.empty()) {
    given.camera = {};
    try {
      apply_options(given, {{"--camera", {stroke.camera}}});
    } catch (const Error& error) {
      throw Error(ExitCode::bad_input, fmt::format("{}: camera: {}", stroke.place, error.what()));
    }
    given.camera = fitted_camera(given, posing.samples());
  }
  paint::Screen screen;
  screen.view_projection = view(stroke.frame, given).view_projection;
  screen.width = given.output.width;
  screen.height = given.output.height;
  for (const glm::dvec3& x : posed(surface(), posing.pose(stroke.frame)))
    screen.positions.push_back(units.world(x));
  return screen;
}

passes::View LoadedScene::view(int frame, const SceneSettings& given) const {
  const CameraSettings& camera = given.camera;
  const glm::dvec3 up(0, 1, 0), centre = 0.5 * (bounds_.low + bounds_.high);
  const double radius = std::max(0.5 * glm::distance(bounds_.low, bounds_.high), 1e-9);
  double half_height = 0;  // of a parallel projection
  double tan_x = half_film(given).x, tan_y = half_film(given).y;
  glm::dvec3 eye = camera.eye, forward = glm::normalize(camera.target - camera.eye), camera_up = up;
  if (!camera.name.empty()) {
    const io::Camera& chosen = model_camera(model, camera.name);
    const glm::dmat4 place = animation.node_matrix(chosen.node, frame);
    eye = glm::dvec3(place[3]);
    forward = glm::normalize(-glm::dvec3(place[2]));
    camera_up = glm::normalize(glm::dvec3(place[1]));
    tan_y = std::tan(chosen.vertical_field_of_view / 2);
    tan_x = tan_y * given.output.width / given.output.height;
    if (chosen.half_height > 0) {
      half_height = chosen.half_height * glm::length(glm::dvec3(place[1])) / units.metres;
      // Parallel rays come from far away; shading wants a point they come from, here right to a thousandth.
      eye -= 1000 * radius * forward;
    }
  }
  if (std::abs(glm::dot(forward, camera_up)) > 0.9999)
    camera_up = std::abs(forward.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);

  passes::View view;
  view.eye = units.world(eye);
  view.forward = forward;
  view.up = up;
  view.bounds_centre = units.world(centre);
  view.bounds_radius = radius / units.metres;
  view.floor = units.world(bounds_.low).y;
  const double distance = glm::distance(view.eye, view.bounds_centre);
  const double far = distance + (settings.output.ground ? 12 : 1.5) * view.bounds_radius;
  const double near = std::max(distance - 1.5 * view.bounds_radius, 1e-3 * (distance + view.bounds_radius));
  const double half_width = half_height * given.output.width / given.output.height;
  const glm::dmat4 projection =
      half_height > 0 ? glm::ortho(-half_width, half_width, -half_height, half_height, near, far)
                      : glm::frustum(-tan_x * near, tan_x * near, -tan_y * near, tan_y * near, near, far);
  view.view_projection = projection * glm::lookAt(view.eye, view.eye + forward, camera_up);

  // Lights stand relative to the camera, round the up axis.
  glm::dvec3 back(-forward.x, 0, -forward.z);
  back = glm::length(back) > 1e-6 ? glm::normalize(back) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::cross(up, back);
  const auto direction = [&](double azimuth, double elevation) {
    const double a = glm::radians(azimuth), e = glm::radians(elevation);
    return std::cos(e) * (std::cos(a) * back + std::sin(a) * right) + std::sin(e) * up;
  };
  const LightSettings& light = settings.light;
  const glm::dvec3 key(light.key_colour), fill(light.fill_colour);
  view.lights[0] = {direction(light.key_azimuth, light.key_elevation), light.key_intensity * key};
  view.lights[1] = {direction(light.fill_azimuth, light.fill_elevation),
                    light.key_intensity * light.fill_ratio * fill};
  view.lights[2] = {direction(light.rim_azimuth, light.rim_elevation), light.rim_intensity * glm::dvec3(1)};
  view.ambient = light.ambient * 0.5 * (fill + glm::dvec3(1));
  return view;
}

double LoadedScene::lead_at(int step) const {
  const Timeline& timeline = animation.timeline();
  if (step <= preroll_ + 1 || preroll_ == 0) return 0;
  const int left = timeline.frame_count - frame_of_step(step);  // frames until the last
  const int reach = std::min(timeline.frame_count / 3, static_cast<int>(timeline.frames_per_second));
  // Equal shares of the way: what is left over after the last frame is one share, which the first frame
  // makes.
  return left < reach ? 1.0 / (left + 2) : 0.0;
}

const Pose& LoadedScene::pose(int step) {
  extend(step);
  return poses_.at(static_cast<std::size_t>(step - first_pose_));
}

void LoadedScene::drop_poses_before(int step) {
  while (first_pose_ < step && !poses_.empty()) {
    poses_.pop_front();
    ++first_pose_;
  }
}

void LoadedScene::extend(int step) {
  while (static_cast<int>(chain_.size()) < step) {
    const int next = static_cast<int>(chain_.size()) + 1;
    poses_.push_back(animation.pose(frame_of_step(next)));
    const Pose& pose = poses_.back();
    Hash hash = chain_.empty() ? state_base_ : chain_.back();
    for (const auto& m : pose.palette) add(hash, m);
    add_items(hash, pose.morph_weights);
    add_items(hash, pose.cache);
    chain_.push_back(hash);
  }
}

Hash LoadedScene::state_hash(int step) {
  extend(step);
  return step == 0 ? state_base_ : chain_[static_cast<std::size_t>(step - 1)];
}

// What all frames have in common beyond the history.
Hash LoadedScene::constants_hash() const {
  Hash hash;
  add_items(hash, waves.wander);
  if (!has_field_a_frame() && !waves.field.empty()) add_items(hash, waves.field);
  add_items(hash, profile.f);
  add_items(hash, profile.derivative);
  hash.add(profile.fine_waves).add(profile.coarse).add(profile.fine);
  for (const auto& vertex : surface().render_vertices) {
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
  add_items(hash, surface().triangles);
  for (const auto& part : draw_parts()) {
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
  for (const auto& texture : model.textures) {
    hash.add(texture.image.width).add(texture.image.height);
    hash.add_bytes(texture.image.rgba);
  }
  const passes::Look l = look();
  hash.add(l.smooth_blend)
      .add(l.full_gradient)
      .add(l.shadows)
      .add(l.ground)
      .add(l.wireframe)
      .add(l.transparent);
  hash.add(l.roughness).add(l.cavity).add(l.parallax).add(l.sheen);
  add(hash, l.background);
  hash.add(settings.output.width).add(settings.output.height).add(settings.output.samples);
  return hash;
}

std::string LoadedScene::frame_hash(int frame, const Hash& driver) {
  if (constants_.empty()) constants_ = constants_hash().hex();
  Hash hash = state_hash(step_of_frame(frame));
  hash.add(driver.hex()).add(constants_);
  if (has_field_a_frame()) {
    take_field(step_of_frame(frame));
    add_items(hash, waves.field);
  }
  const passes::View at = view(frame);
  add(hash, at.view_projection);
  add(hash, at.eye);
  add(hash, at.ambient);
  hash.add(at.floor);
  for (const auto& light : at.lights) {
    add(hash, light.direction);
    add(hash, light.colour);
  }
  return hash.hex();
}

}  // namespace plisse::pipeline
