// The run that makes pictures: steps the history, draws the frames that are wanted, and hands them to threads
// that encode and write while the next one is drawn.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <new>

#include "base/atomic_file.h"
#include "base/colour.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "config/frames.h"
#include "gpu/shader_source.h"
#include "io/png.h"
#include "pipeline.h"
#include "pipeline/aov.h"
#include "pipeline/displace.h"
#include "pipeline/frame_writer.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/stepper.h"

namespace plisse {
namespace {

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// The picture was made with premultiplied colours in linear light; PNG wants straight alpha.
void straighten_alpha(std::vector<std::uint8_t>& rgba) {
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const std::uint8_t alpha = rgba[i + 3];
    if (alpha == 0 || alpha == 255) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double straight = srgb_to_linear(rgba[i + c] / 255.0) * 255.0 / alpha;
      rgba[i + c] = static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(std::min(1.0, straight))));
    }
  }
}

// What draws: driver and shaders.
Hash driver_hash(const GlInfo& gl, const std::string& shader_folder) {
  Hash hash;
  hash.add(gl.vendor).add(gl.renderer).add(gl.version);
  for (const auto& shader : gpu::embedded_shaders())
    hash.add(shader.name).add(gpu::shader_source(shader.name, shader_folder));
  return hash;
}

// Calls `work` and files what it throws with the frame. A frame that wants too much memory is that frame's
// misfortune; any other error than these is the run's.
template <typename Work>
void guarded(FrameReport& frame, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.code != ExitCode::no_output && error.code != ExitCode::try_again) throw;
    frame.error = error.what();
    frame.code = error.code;
  } catch (const std::bad_alloc&) {
    frame.error =
        fmt::format("{}: memory is exhausted; try again with fewer threads or a smaller picture", frame.path);
    frame.code = ExitCode::try_again;
  }
}

ExitCode outcome(const std::vector<FrameReport>& frames) {
  bool failed = false, stands = false, unwritten = false;
  for (const FrameReport& frame : frames) {
    failed = failed || !frame.error.empty();
    stands = stands || frame.error.empty();
    unwritten = unwritten || frame.code == ExitCode::no_output;
  }
  if (!failed) return ExitCode::fine;
  if (unwritten) return ExitCode::no_output;
  return stands ? ExitCode::some_frames : ExitCode::try_again;
}

// A scene whose waves are geometry, as the render pass takes it.
class DisplacedScene {
 public:
  DisplacedScene(const pipeline::LoadedScene& scene, std::optional<int> levels)
      : scene_(scene), displacement_(scene, levels), buffers_(scene.surface(), displacement_.mesh()) {}
  void move(const passes::SurfaceBuffers& surface) {
    buffers_.show(scene_.surface(), displacement_.mesh(), displacement_.at(surface));
  }
  const passes::SurfaceBuffers& surface() const { return buffers_; }
  std::vector<passes::DrawPart> parts() const {
    auto parts = scene_.draw_parts();
    const int segments = displacement_.mesh().segments;
    for (passes::DrawPart& part : parts) {
      part.first_triangle *= static_cast<std::uint32_t>(segments * segments);
      part.triangle_count *= static_cast<std::uint32_t>(segments * segments);
    }
    return parts;
  }

 private:
  const pipeline::LoadedScene& scene_;
  pipeline::Displacement displacement_;
  passes::SurfaceBuffers buffers_;
};

// Displaced geometry has these of its own; the others are of single waves.
void check_aovs(const std::vector<passes::Aov>& aovs, bool displaced) {
  using passes::Aov;
  for (const Aov aov : aovs) {
    if (displaced && (aov == Aov::phase || aov == Aov::direction || aov == Aov::tension)) {
      throw Error(
          ExitCode::bad_input,
          "--aov: phase, direction and tension do not go with --displace; height, normal, amplitude and "
          "depth do");
    }
  }
}

}  // namespace

RenderReport render(const RenderRequest& request, const FrameCallback& on_frame) {
  const double started = now_ms();
  pipeline::LoadedScene scene(request.scene);
  const auto& output = scene.settings.output;
  const auto frames = select_frames(scene.settings.model.frames, scene.animation.timeline().frame_count);
  check_frame_paths(output.path, frames);
  const auto aovs = pipeline::parse_aovs(request.aovs);
  check_aovs(aovs, request.displace);

  if (!request.state_file.empty()) check_writable(request.state_file);
  const gpu::Context context(request.device);
  gpu::StageTimer timer(context.info().software);
  const Hash driver = driver_hash(context.info(), request.shader_folder);

  RenderReport report;
  report.gl = context.info();
  report.render_vertices = scene.surface().render_vertices.size();
  report.welded_vertices = scene.surface().vertex_count();
  report.triangles = scene.surface().triangle_count();
  report.timer = timer.kind();
  report.wavelength_m = scene.wavelength();
  report.frames.resize(frames.size());

  // Everything that only drawing needs is made when the first frame is drawn: a run that finds all frames
  // done is quick.
  std::optional<pipeline::Stepper> stepper;
  std::optional<DisplacedScene> displaced;
  std::optional<passes::RenderPass> pass;
  std::optional<gpu::Target> target;
  std::optional<pipeline::AovWriter> aov_writer;

  std::mutex callback_mutex;
  int done = 0;
  const auto finished = [&](std::size_t index) {
    std::lock_guard lock(callback_mutex);
    ++done;
    if (on_frame) on_frame(done, static_cast<int>(frames.size()), report.frames[index]);
  };
  bool full = false;       // a frame could not be written: the next one would fare the same
  io::Image last_picture;  // of the last drawn step, for poses that stay
  int last_picture_step = 0;

  {
    pipeline::FrameWriter writer;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      {
        std::lock_guard lock(callback_mutex);
        if (full) break;
      }
      const int frame = frames[i];
      if (interrupted()) {
        report.interrupted = true;
        break;
      }
      FrameReport& entry = report.frames[i];
      entry.frame = frame;
      entry.time_s = scene.animation.timeline().time(frame);
      entry.path = frame_path(output.path, frame);
      std::string hash = scene.frame_hash(frame, driver);
      if (request.displace) hash = Hash().add(hash).add("displaced").add(request.levels.value_or(-1)).hex();
      const bool exists = std::filesystem::exists(entry.path);
      if (request.skip_existing && exists && io::png_is_whole(entry.path, hash) &&
          pipeline::aovs_are_whole(aovs, entry.path, hash)) {
        entry.skipped = true;
        ++report.skipped["existing frames"];
        finished(i);
        continue;
      }
      if (!stepper) {
        stepper.emplace(scene, timer, request.shader_folder);
        if (!request.state_file.empty())
          stepper->read_state(request.state_file, driver, scene.step_of_frame(frame));
        if (request.displace) displaced.emplace(scene, request.levels);
        passes::Look look = scene.look();
        look.displaced = request.displace;
        pass.emplace(look, scene.profile, displaced ? displaced->parts() : scene.draw_parts(),
                     scene.texture_levels(), request.shader_folder);
        target.emplace(output.width, output.height, output.samples, gpu::Target::Format::srgb8);
        if (!aovs.empty()) aov_writer.emplace(scene, *pass, aovs);
      }
      const int step = scene.step_of_frame(frame);
      const int before = stepper->step();
      if (!stepper->advance_to(step)) {
        entry.frame = 0;
        report.interrupted = true;
        break;
      }
      const passes::View view = scene.view(frame);
      io::Image picture;
      guarded(entry, [&] {
        const auto drawn = [&]() -> const passes::SurfaceBuffers& {
          return displaced ? displaced->surface() : stepper->surface();
        };
        const bool same = stepper->unchanged() && before == step - 1 && last_picture_step == before &&
                          scene.settings.camera.name.empty();
        if (same) {
          picture = last_picture;
        } else {
          if (displaced) {
            const double began = now_ms();
            displaced->move(stepper->surface());
            entry.ms["displace"] = now_ms() - began;
          }
          timer.begin("render");
          pass->draw_resolved(drawn(), view, *target, context.info().software);
          timer.end();
          const double read = now_ms();
          picture.width = output.width;
          picture.height = output.height;
          picture.rgba = target->read_rgba8();
          if (output.transparent) straighten_alpha(picture.rgba);
          entry.ms["readback"] = now_ms() - read;
          last_picture = picture;
        }
        last_picture_step = step;
        if (aov_writer) aov_writer->write(drawn(), view, entry.path, hash);
      });
      for (const auto& [stage, ms] : timer.collect()) entry.ms[stage] += ms;

      writer.submit([&, i, hash, picture = std::move(picture)] {
        FrameReport& mine = report.frames[i];
        if (mine.error.empty()) {
          guarded(mine, [&] {
            const double encode = now_ms();
            io::PngOptions options;
            options.hash = hash;
            const auto bytes = io::encode_png(picture, options);
            const double write = now_ms();
            write_whole_file(mine.path, bytes);
            mine.ms["encode"] = write - encode;
            mine.ms["write"] = now_ms() - write;
          });
        }
        if (mine.code == ExitCode::no_output) {
          std::lock_guard lock(callback_mutex);
          full = true;
        }
        finished(i);
      });
    }
    writer.finish();
  }
  std::erase_if(report.frames, [](const FrameReport& frame) { return frame.frame == 0; });
  report.outcome = outcome(report.frames);
  for (const FrameReport& frame : report.frames)
    if (report.failure.empty()) report.failure = frame.error;
  int drawn = 0;
  for (const FrameReport& frame : report.frames) drawn += !frame.skipped && frame.error.empty() ? 1 : 0;
  if (stepper) {
    if (stepper->unchanged_steps() > 0) report.skipped["unchanged poses"] = stepper->unchanged_steps();
    if (!request.state_file.empty()) {
      try {
        stepper->write_state(request.state_file, driver);
      } catch (const Error& error) {  // the frames stand all the same
        report.outcome = ExitCode::no_output;
        if (report.failure.empty()) report.failure = error.what();
      }
    }
  }
  report.wall_s = (now_ms() - started) * 1e-3;
  report.fps = report.wall_s > 0 ? drawn / report.wall_s : 0;
  return report;
}

}  // namespace plisse
