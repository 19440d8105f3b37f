#include "pipeline/loaded_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "config/frames.h"
#include "config/options.h"
#include "config/paint_file.h"
#include "config/rest_choice.h"
#include "io/import_place.h"
#include "io/wrinkle_field.h"
#include "paint/bias_file.h"
#include "paint/field.h"
#include "pipeline/fingerprint.h"
#include "scene/camera.h"
#include "scene/lights.h"
#include "scene/load_model.h"
#include "scene/wavelength_map.h"
#include "scene/wrinkles.h"

namespace plisse::pipeline {
namespace {

scene::AnimationChoice choice_of(const config::SceneSettings& scene) {
  const config::ModelSettings& model = scene.model;
  return {model.clip, model.frames_per_second, model.rest, model.loop, scene.limits};
}

// Solved waves are cosines as they were solved; `where`: what the passes' settings have no part in;
// `instead`: what has a use for them.
void warn_of_unused(const config::WrinkleSettings& wrinkles, std::string_view where,
                    std::string_view instead) {
  const config::WrinkleSettings plain;
  std::vector<std::string_view> unused;
  for (const auto& [given, name] : {std::pair{wrinkles.profile != plain.profile, "profile"},
                                    {wrinkles.fine > 0, "fine"},
                                    {wrinkles.irregularity > 0, "irregularity"},
                                    {!wrinkles.wavelength_map.empty(), "wavelength_map"}})
    if (given) unused.emplace_back(name);
  if (!unused.empty())
    log::warn(fmt::format("{} of [wrinkles] {} no part in {}; {} has a use for them", fmt::join(unused, ", "),
                          unused.size() == 1 ? "has" : "have", where, instead));
}

scene::Animation::Bounds bounds_of(const std::vector<glm::dvec3>& points) {
  scene::Animation::Bounds bounds{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (const auto& x : points) {
    bounds.low = glm::min(bounds.low, x);
    bounds.high = glm::max(bounds.high, x);
  }
  return bounds;
}

// Calls a function that reads the file of a key; errors get the key's place in the scene.
template <typename Work>
void for_key(const config::SceneSettings& scene, const std::string& key, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    const auto place = scene.places.find(key);
    if (place == scene.places.end()) throw;
    throw Error(error.code, fmt::format("{}: {}", place->second, error.what()));
  }
}

}  // namespace

int smooth_levels_within(const std::optional<int>& levels) {
  return std::min(LoadedScene::most_smooth, levels.value_or(LoadedScene::most_smooth));
}

LoadedScene::LoadedScene(const config::SceneSettings& given, const scene::InMemory& memory, int smooth)
    : settings(given),
      model(memory.model ? *memory.model : scene::load_model(given)),
      animation(model, choice_of(given)),
      profile(passes::with_finer_waves(passes::make_profile(given.wrinkles.profile), given.wrinkles.fine,
                                       given.wrinkles.fine_share)),
      smooth_levels_(smooth) {
  if (config::uv_rest_choice(settings.model.rest) &&
      !(settings.solve.on && settings.solve.method != config::SolveMethod::passes))
    throw Error(ExitCode::bad_input,
                fmt::format("rest '{}': flat panels are the rest shape of solved wrinkles only: add --solve, "
                            "or take another",
                            settings.model.rest));
  scene::select_parts(animation.surface(), settings.wrinkles,
                      settings.solve.on ? settings.solve.bodies : std::vector<std::string>{});
  if (settings.wrinkles.wavelength <= 0) settings.wrinkles.wavelength = scene::default_wavelength(surface());
  rest = rest_frames(surface());
  waves = scene::vertex_waves(surface(), settings.wrinkles, wavelength());
  if (!settings.wrinkles.wavelength_map.empty()) {
    for_key(settings, "wrinkles.wavelength_map", [&] {
      scene::take_wavelengths(surface(), settings.wrinkles,
                              io::file_to_world(model.up, model.metres_per_unit), waves);
    });
  }
  preroll_ = settings.model.loop ? animation.timeline().frame_count : 0;

  const std::vector<glm::dvec3> samples = animation.samples();
  bounds_ = bounds_of(samples);
  const auto rest_bounds = bounds_of(surface().rest);
  units.metres = ModelUnits::unit_for(
      std::max(glm::distance(bounds_.low, bounds_.high), glm::distance(rest_bounds.low, rest_bounds.high)));
  units.world_centre = 0.5 * (bounds_.low + bounds_.high);
  units.rest_centre = 0.5 * (rest_bounds.low + rest_bounds.high);
  settings.camera = scene::fitted_camera(settings, bounds_, samples);
  take_bias(memory);
  take_solved(memory);
  state_base_ = start_hash(*this);
}

void LoadedScene::take_bias(const scene::InMemory& memory) {
  const config::BiasSettings& given = settings.bias;
  if (!given.paint.empty()) paint::take_painting(painted(config::load_paint(given.paint)), waves);
  if (!given.file.empty())
    for_key(settings, "bias.file",
            [&] { paint::take_painting(paint::read_bias(given.file, surface(), rest), waves); });
  const int frames = animation.timeline().frame_count;
  if (memory.fields && memory.fields->size() == 1) {
    take_field(memory.fields->front(), glm::dmat4(1), "wrinkle field");
  } else if (memory.fields) {
    take_frame_fields({memory.fields, frames});
  } else if (!given.field.empty()) {
    for_key(settings, "bias.field", [&] {
      if (config::names_many_files(given.field))
        take_frame_fields({settings, frames});
      else
        take_field(io::read_wrinkle_field(given.field, settings.model.path),
                   io::file_to_world(model.up, model.metres_per_unit), given.field.string());
    });
  }
}

void LoadedScene::take_field(const io::WrinkleField& given, const glm::dmat4& to_world,
                             const std::string& name) {
  const auto field = paint::field_on(surface(), given, to_world, name);
  if (settings.bias.use == config::FieldUse::bias)
    return paint::field_as_bias(surface(), rest, field, settings.wrinkles.dead_zone, waves);
  const RestFrames own = rest;
  smooth_all();
  field_mask_.assign(waves.mask.size(), 1.0);
  carried_.emplace(surface(), drawn(animation.surface().rest, own, field), waves.mask);
  waves.carried = carried_->along();
  waves.field = carried_->in(scene::posed(surface(), posed_at(animation, 1).drawn));
  field_frame_ = 1;
}

// Each frame's field has all the waves of its surface: it was solved for the compression of that surface, so
// the animation must not add waves.
void LoadedScene::take_frame_fields(FrameFields fields) {
  warn_of_unused(settings.wrinkles, "the fields of [bias], which are drawn as they were solved",
                 "one field with use = \"bias\"");
  fields_ = std::move(fields);
  smooth_all();
  field_mask_ = waves.mask;
  std::fill(waves.mask.begin(), waves.mask.end(), 0.0);
  waves.field = field_at(scene::posed(animation.surface(), animation.pose(1)), 1);
  field_frame_ = 1;
}

// Solved waves take the place of the passes' on the parts that were selected, and no other part has any.
void LoadedScene::take_solved(const scene::InMemory& memory) {
  solved_ = memory.solved;
  if (!solved_) return;
  has_solved_waves_ =
      std::ranges::any_of(solved_->frames, [](const auto& frame) { return !frame.amplitude.empty(); });
  if (!has_solved_waves_) return;
  if (settings.solve.method == config::SolveMethod::bias) {
    has_solved_waves_ = false;  // they are crush's and relax's
    waves.unstrained = true;
    own_wavelength_ = waves.wavelength;
    bias_from(1, scene::posed(surface(), posed_at(animation, 1).drawn));
    return;
  }
  warn_of_unused(settings.wrinkles, "solved waves, which are drawn as they were solved",
                 "method = \"bias\" of [solve]");
  std::vector<bool> cloth = deforming(*solved_, surface().rest);
  const std::vector<bool> soft = smooth_at_rest(*solved_, surface());
  for (std::size_t f = 0; f < cloth.size(); ++f) cloth[f] = cloth[f] && soft[f];
  smooth(*solved_, cloth);
  field_mask_ = waves.mask;
  std::fill(waves.mask.begin(), waves.mask.end(), 0.0);
  waves.field = field_at({}, 1);
  field_frame_ = 1;
}

RestFrames LoadedScene::bias_from(int frame, const std::vector<glm::dvec3>& places) {
  const SolvedClip::Frame& solved = solved_->frames.at(static_cast<std::size_t>(frame - 1));
  Surface base = surface();
  base.rest = places;
  // The frames that the passes have: tangents as in the rest pose.
  RestFrames posed = rest_frames(base);
  posed.tangent_neighbour = rest.tangent_neighbour;
  for (std::size_t v = 0; v < places.size(); ++v) {
    const glm::dvec3 &n = posed.normal[v], e = places[rest.tangent_neighbour[v]] - places[v],
                     along = e - glm::dot(e, n) * n;
    if (glm::dot(along, along) > 1e-12 * glm::dot(e, e)) posed.tangent[v] = glm::normalize(along);
  }
  paint::SurfaceField field;
  field.amplitude.assign(places.size(), 0);
  field.phase.assign(base.triangle_count(), {0, 0, 0});
  for (std::size_t v = 0; v < solved.amplitude.size(); ++v) {
    double& height = field.amplitude[solved_->welded[v]];
    height = std::max(height, solved.amplitude[v]);
  }
  for (std::size_t f = 0; f < solved.phase.size(); ++f) field.phase[solved_->triangle[f]] = solved.phase[f];
  waves.wavelength = own_wavelength_;
  paint::field_as_bias(base, posed, field, settings.wrinkles.dead_zone, waves);
  return posed;
}

RestFrames LoadedScene::take_bias(int step) {
  return bias_from(frame_of_step(step), scene::posed(surface(), pose(step)));
}

void LoadedScene::smooth_all() {
  SolvedClip sheets;
  const Surface& surface = animation.surface();
  for (std::uint32_t v = 0; v < surface.vertex_count(); ++v) sheets.welded.push_back(v);
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    const auto corner = [&](std::size_t c) {
      return surface.render_vertices[surface.triangles[3 * t + c]].welded;
    };
    sheets.faces.push_back({corner(0), corner(1), corner(2)});
    sheets.triangle.push_back(t);
  }
  smooth(sheets, std::vector<bool>(sheets.faces.size(), true));
}

void LoadedScene::smooth(const SolvedClip& sheets, const std::vector<bool>& chosen) {
  constexpr double most_triangles = 5e5;  // more, and they are no larger than pixels
  const auto triangles = static_cast<double>(std::ranges::count(chosen, true));
  if (triangles == 0) return;
  while (smooth_levels_ > 0 && triangles * std::exp2(2 * smooth_levels_) > most_triangles) --smooth_levels_;
  if (smooth_levels_ == 0) return;
  try {
    smooth_.emplace(animation.surface(), sheets, smooth_levels_, chosen);
  } catch (const Error& error) {
    log::warn(fmt::format("solved waves are drawn on the mesh as it is, not smooth: {}", error.what()));
    return;
  }
  waves.wavelength = smooth_->spread(waves.wavelength);
  waves.mask = smooth_->spread(waves.mask);
  waves.wander = smooth_->spread(waves.wander);
  if (!waves.bias.empty()) waves.bias = smooth_->spread(waves.bias);
  // Painted waves under a field that is drawn directly begin as the passes' own do.
  waves.start_direction.clear();
  waves.start_phase.clear();
  rest = rest_frames(surface());
}

std::vector<FieldTriangle> LoadedScene::drawn_smooth(const SolvedClip::Frame& field) const {
  const SmoothSurface::Refined refined = smooth_->refined(field);
  return paint::field_of_cloth(surface(), refined.clip, 0, field_mask_, refined.gradient);
}

std::vector<FieldTriangle> LoadedScene::drawn(const std::vector<glm::dvec3>& coarse, const RestFrames& frames,
                                              const paint::SurfaceField& field) const {
  if (smooth_) return drawn_smooth({coarse, field.amplitude, field.phase});
  Surface base = surface();
  base.rest = coarse;
  return paint::field_directly(base, frames, field, field_mask_);
}

LoadedScene::Posed LoadedScene::posed_at(scene::Animation& posing, int frame) const {
  Posed result{posing.pose(frame), {}};
  const Surface& own = animation.surface();
  std::vector<glm::dvec3> base;
  if (solved_) {
    base = solved_->frames.at(static_cast<std::size_t>(frame - 1)).base;
    if (!base.empty()) result.drawn = scene::with_cloth(own, std::move(result.drawn), solved_->welded, base);
  }
  if (!smooth_ && fields_.empty()) return result;
  result.coarse = scene::posed(own, result.drawn);
  if (!smooth_) return result;
  result.drawn.palette.assign(1, glm::dmat4{1});
  result.drawn.morph_weights.clear();
  result.drawn.cache = smooth_->places(result.coarse, base);
  return result;
}

std::vector<FieldTriangle> LoadedScene::field_at(const std::vector<glm::dvec3>& coarse, int frame) const {
  if (!has_solved_waves_) {
    const paint::SurfaceField field = fields_.over(animation.surface(), model, coarse, frame);
    if (smooth_) return drawn(coarse, {}, field);
    Surface base = surface();
    base.rest = coarse;
    return drawn(coarse, rest_frames(base), field);
  }
  const auto index = static_cast<std::size_t>(frame - 1);
  return smooth_ ? drawn_smooth(solved_->frames.at(index))
                 : paint::field_of_cloth(surface(), *solved_, index, field_mask_);
}

void LoadedScene::take_field(int step) {
  const int frame = frame_of_step(step);
  if (!has_field_a_frame() || frame == field_frame_) return;
  const scene::Pose& here = pose(step);
  waves.field = carried_ ? carried_->in(scene::posed(surface(), here))
                         : field_at(poses_.at(static_cast<std::size_t>(step - first_pose_)).coarse, frame);
  field_frame_ = frame;
}

void LoadedScene::visit_fields(const std::function<void(const std::vector<FieldTriangle>&)>& work) const {
  if (!has_field_a_frame()) return work(waves.field);
  scene::Animation posing(model, choice_of(settings));
  for (int frame = 1; frame <= posing.timeline().frame_count; ++frame) {
    if (has_solved_waves_ && solved_->frames[static_cast<std::size_t>(frame - 1)].amplitude.empty()) continue;
    const Posed posed = posed_at(posing, frame);
    work(carried_ ? carried_->in(scene::posed(surface(), posed.drawn)) : field_at(posed.coarse, frame));
  }
}

paint::Painting LoadedScene::painted(const config::PaintSettings& paint) const {
  const Surface& own = animation.surface();
  const RestFrames frames = smooth_ ? rest_frames(own) : rest;
  const paint::Canvas canvas{
      own, frames, [this](const config::PaintStroke& stroke) { return screen(stroke); },
      [this](const config::PaintStroke& stroke) { return field_of(stroke); }, settings.wrinkles.dead_zone};
  return paint::paint(canvas, paint.strokes);
}

paint::SurfaceField LoadedScene::field_of(const config::PaintStroke& stroke) const {
  return paint::field_on(animation.surface(), io::read_wrinkle_field(stroke.file, settings.model.path),
                         io::file_to_world(model.up, model.metres_per_unit), stroke.file.string());
}

paint::Screen LoadedScene::screen(const config::PaintStroke& stroke) const {
  // A second animation, because frames of the scene's own must be requested in order.
  scene::Animation posing(model, choice_of(settings));
  if (stroke.frame > posing.timeline().frame_count) {
    throw Error(ExitCode::bad_input, fmt::format("{}: there is no frame {}; the clip has {}", stroke.place,
                                                 stroke.frame, posing.timeline().frame_count));
  }
  config::SceneSettings given = settings;
  if (stroke.width > 0) {
    given.output.width = stroke.width;
    given.output.height = stroke.height;
  }
  if (!stroke.camera.empty()) {
    given.camera = {};
    try {
      config::apply_options(given, {{"--camera", {stroke.camera}}});
    } catch (const Error& error) {
      throw Error(ExitCode::bad_input, fmt::format("{}: camera: {}", stroke.place, error.what()));
    }
    given.camera = scene::fitted_camera(given, bounds_, posing.samples());
  }
  paint::Screen screen;
  screen.view_projection =
      scene::camera_at(given, model, animation, stroke.frame, bounds_, units).view_projection;
  screen.width = given.output.width;
  screen.height = given.output.height;
  for (const glm::dvec3& x : scene::posed(animation.surface(), posing.pose(stroke.frame)))
    screen.positions.push_back(units.world(x));
  return screen;
}

double LoadedScene::lead_at(int step) const {
  const scene::Timeline& timeline = animation.timeline();
  if (step <= preroll_ + 1 || preroll_ == 0 || has_bias_a_frame()) return 0;
  const int left = timeline.frame_count - frame_of_step(step);  // frames until the last
  const int reach = std::min(timeline.frame_count / 3, static_cast<int>(timeline.frames_per_second));
  // Equal steps: the remaining difference after the last frame is one step, the one to the first frame.
  return left < reach ? 1.0 / (left + 2) : 0.0;
}

const scene::Pose& LoadedScene::pose(int step) {
  extend(step);
  return poses_.at(static_cast<std::size_t>(step - first_pose_)).drawn;
}

void LoadedScene::drop_poses_before(int step) {
  while (first_pose_ < step && !poses_.empty()) {
    poses_.pop_front();
    ++first_pose_;
  }
}

Hash LoadedScene::state_hash(int step) {
  extend(step);
  return step == 0 ? state_base_ : chain_[static_cast<std::size_t>(step - 1)];
}

void LoadedScene::extend(int step) {
  while (static_cast<int>(chain_.size()) < step) {
    const int next = static_cast<int>(chain_.size()) + 1;
    poses_.push_back(posed_at(animation, frame_of_step(next)));
    Hash hash = chain_.empty() ? state_base_ : chain_.back();
    add_pose(hash, poses_.back().drawn);
    if (has_bias_a_frame())
      add_solved(hash, solved_->frames.at(static_cast<std::size_t>(frame_of_step(next) - 1)));
    chain_.push_back(hash);
  }
}

passes::View LoadedScene::view(int frame) const {
  const scene::Camera camera = scene::camera_at(settings, model, animation, frame, bounds_, units);
  const scene::Lights lights = scene::lights_for(settings.light, camera.forward, camera.up);
  passes::View view{camera.view_projection, camera.eye,           camera.forward,       camera.up,   {},
                    lights.ambient,         camera.bounds_centre, camera.bounds_radius, camera.floor};
  for (std::size_t i = 0; i < lights.directional.size(); ++i)
    view.lights[i] = {lights.directional[i].direction, lights.directional[i].colour};
  return view;
}

std::string LoadedScene::frame_hash(int frame, const Hash& driver) {
  if (constants_.empty()) constants_ = constants_hash(*this).hex();
  Hash hash = state_hash(step_of_frame(frame));
  hash.add(driver.hex()).add(constants_);
  if (has_field_a_frame()) {
    take_field(step_of_frame(frame));
    add_field(hash, waves.field);
  }
  add_view(hash, view(frame));
  return hash.hex();
}

}  // namespace plisse::pipeline
