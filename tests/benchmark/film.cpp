#include "benchmark/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "benchmark/effort.h"
#include "config/scene_file.h"
#include "config/settings.h"
#include "gpu/timer.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/look.h"
#include "pipeline/render.h"
#include "pipeline/stepper.h"
#include "support/files.h"

namespace plisse::benchmark {
namespace {

Sample per_frame(const Sample& all, int frames) {
  return {all.wall_s / frames, all.cpu_s / frames};
}

int frame_count(const pipeline::LoadedScene& scene, const Effort& effort) {
  const int all = scene.animation.timeline().frame_count;
  return effort.frames > 0 ? std::min(effort.frames, all) : all;
}

}  // namespace

config::SceneSettings film_settings(const std::string& scene, const Effort& effort, int samples_a_pixel) {
  config::SceneSettings settings = scene_settings(scene, effort);
  settings.output.samples = samples_a_pixel;
  return settings;
}

Sample film_without_files(const config::SceneSettings& settings, const Effort& effort, bool read_back,
                          bool software) {
  pipeline::LoadedScene scene(settings);
  gpu::StageTimer timer(true);
  pipeline::Stepper stepper(scene, timer, "");
  passes::RenderPass pass(pipeline::look_of(scene), scene.profile, pipeline::draw_parts(scene),
                          pipeline::texture_levels(scene), "");
  const auto& output = settings.output;
  const gpu::Target target(output.width, output.height, output.samples, gpu::Target::Format::srgb8);
  const int frames = frame_count(scene, effort);
  Sample begin;
  for (int frame = 1; frame <= frames; ++frame) {
    stepper.advance_to(scene.step_of_frame(frame));
    pass.draw(stepper.surface(), scene.view(frame), target, software);
    if (read_back) {
      target.read_rgba8();
    } else {
      finish();
    }
    if (frame == 1) begin = now();
  }
  return per_frame(now() - begin, frames - 1);
}

FilmWithFiles film_with_files(config::SceneSettings settings, const Effort& effort) {
  const test::TemporaryFolder folder;
  settings.output.path = folder.path().string();
  if (effort.frames > 0) settings.model.frames = fmt::format("1-{}", effort.frames);
  pipeline::RenderRequest request;
  request.scene = settings;
  FilmWithFiles result;
  Sample begin, end;
  const pipeline::RenderReport report = pipeline::render(
      request, [&](int done, int, const pipeline::FrameReport&) { (done == 1 ? begin : end) = now(); });
  result.frames = static_cast<int>(report.frames.size());
  result.frame = per_frame(end - begin, result.frames - 1);
  result.whole_run_fps = report.fps;
  return result;
}

std::size_t covered_pixels(passes::RenderPass& pass, const passes::SurfaceBuffers& surface,
                           const passes::View& view, const gpu::Target& float_target) {
  pass.draw_aov(surface, view, float_target, passes::Aov::depth);
  const auto pixels = float_target.read_rgba32f();
  std::size_t count = 0;
  for (std::size_t i = 3; i < pixels.size(); i += 4) count += pixels[i] > 0 ? 1 : 0;
  return count;
}

double average_covered_pixels(const config::SceneSettings& settings, const Effort& effort) {
  pipeline::LoadedScene scene(settings);
  gpu::StageTimer timer(true);
  pipeline::Stepper stepper(scene, timer, "");
  passes::RenderPass pass(pipeline::look_of(scene), scene.profile, pipeline::draw_parts(scene),
                          pipeline::texture_levels(scene), "");
  const gpu::Target target(effort.width, effort.height, 1, gpu::Target::Format::rgba32f);
  const int frames = frame_count(scene, effort);
  double sum = 0;
  for (int frame = 1; frame <= frames; ++frame) {
    stepper.advance_to(scene.step_of_frame(frame));
    sum += static_cast<double>(covered_pixels(pass, stepper.surface(), scene.view(frame), target));
  }
  return sum / frames;
}

}  // namespace plisse::benchmark
