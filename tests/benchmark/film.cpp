#include "benchmark/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "benchmark/effort.h"
#include "config/scene_file.h"
#include "gpu/timer.h"
#include "pipeline.h"
#include "pipeline/loaded_scene.h"
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

SceneSettings film_settings(const std::string& scene, const Effort& effort, int samples_a_pixel) {
  SceneSettings settings = scene_settings(scene, effort);
  settings.output.samples = samples_a_pixel;
  return settings;
}

Sample film_without_files(const SceneSettings& settings, const Effort& effort, bool read_back,
                          bool software) {
  pipeline::LoadedScene scene(settings);
  gpu::StageTimer timer(true);
  pipeline::Stepper stepper(scene, timer, "");
  passes::RenderPass pass(scene.look(), scene.profile, scene.draw_parts(), scene.texture_levels(), "");
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

FilmWithFiles film_with_files(SceneSettings settings, const Effort& effort) {
  const test::TemporaryFolder folder;
  settings.output.path = folder.path().string();
  if (effort.frames > 0) settings.model.frames = fmt::format("1-{}", effort.frames);
  RenderRequest request;
  request.scene = settings;
  FilmWithFiles result;
  Sample begin, end;
  const RenderReport report =
      render(request, [&](int done, int, const FrameReport&) { (done == 1 ? begin : end) = now(); });
  result.frames = static_cast<int>(report.frames.size());
  result.frame = per_frame(end - begin, result.frames - 1);
  result.whole_run_fps = report.fps;
  return result;
}

double average_covered_pixels(const SceneSettings& settings, const Effort& effort) {
  pipeline::LoadedScene scene(settings);
  gpu::StageTimer timer(true);
  pipeline::Stepper stepper(scene, timer, "");
  passes::RenderPass pass(scene.look(), scene.profile, scene.draw_parts(), scene.texture_levels(), "");
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
