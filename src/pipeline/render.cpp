// The run that makes pictures: steps the history, draws the frames that are wanted, and hands them to threads
// that encode and write while the next one is drawn.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <thread>

#include "base/atomic_file.h"
#include "base/colour.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "config/frames.h"
#include "io/png.h"
#include "pipeline.h"
#include "pipeline/aov.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/stepper.h"

namespace plisse {
namespace {

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Encoding a frame takes about as long as llvmpipe takes to draw one on all cores: four threads keep up with
// a GPU.
int writer_threads() {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return static_cast<int>(std::min<std::size_t>(allowed, 4));
}

// Encodes and writes frames on threads of its own, a few at a time: more would only hold memory.
class FrameWriter {
 public:
  using Job = std::function<void()>;
  explicit FrameWriter(int threads) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  }
  ~FrameWriter() { finish(); }
  void submit(Job job) {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [this] { return jobs_.size() < 2 * threads_.size(); });
    jobs_.push_back(std::move(job));
    work_.notify_one();
  }
  void finish() {
    {
      std::lock_guard lock(mutex_);
      done_ = true;
    }
    work_.notify_all();
    for (auto& thread : threads_) {
      if (thread.joinable()) thread.join();
    }
  }

 private:
  void work() {
    while (true) {
      Job job;
      {
        std::unique_lock lock(mutex_);
        work_.wait(lock, [this] { return done_ || !jobs_.empty(); });
        if (jobs_.empty()) return;
        job = std::move(jobs_.front());
        jobs_.pop_front();
      }
      room_.notify_one();
      job();
    }
  }
  std::mutex mutex_;
  std::condition_variable work_, room_;
  std::deque<Job> jobs_;
  std::vector<std::thread> threads_;
  bool done_ = false;
};

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

Hash driver_hash(const GlInfo& gl) {
  Hash hash;
  hash.add(gl.vendor).add(gl.renderer).add(gl.version);
  return hash;
}

}  // namespace

RenderReport render(const RenderRequest& request, const FrameCallback& on_frame) {
  const double started = now_ms();
  pipeline::LoadedScene scene(request.scene);
  const auto& output = scene.settings.output;
  const auto frames = select_frames(scene.settings.model.frames, scene.animation.timeline().frame_count);
  check_frame_paths(output.path, frames);
  const auto aovs = pipeline::parse_aovs(request.aovs);

  const gpu::Context context(request.device);
  gpu::StageTimer timer(context.info().software);
  const Hash driver = driver_hash(context.info());

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
  std::exception_ptr stop;  // a frame that cannot be written: the next one would fare the same
  io::Image last_picture;   // of the last drawn step, for poses that stay
  int last_picture_step = 0;

  {
    FrameWriter writer(writer_threads());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (interrupted()) {
        report.interrupted = true;
        break;
      }
      {
        std::lock_guard lock(callback_mutex);
        if (stop) break;
      }
      const int frame = frames[i];
      FrameReport& entry = report.frames[i];
      entry.frame = frame;
      entry.time_s = scene.animation.timeline().time(frame);
      entry.path = frame_path(output.path, frame);
      const std::string hash = scene.frame_hash(frame, driver);
      const bool exists = std::filesystem::exists(entry.path);
      if (request.skip_existing && exists && aovs.empty() && io::png_is_whole(entry.path, hash)) {
        entry.skipped = true;
        ++report.skipped["existing frames"];
        finished(i);
        continue;
      }
      if (exists && !request.overwrite && !request.skip_existing) {
        throw Error(
            ExitCode::no_output,
            fmt::format(
                "{} exists already; --overwrite replaces it, --skip-existing keeps frames that are whole",
                entry.path));
      }
      if (!stepper) {
        stepper.emplace(scene, timer, request.shader_folder);
        if (!request.state_file.empty())
          stepper->read_state(request.state_file, driver, scene.step_of_frame(frame));
        pass.emplace(scene.look(), scene.profile, scene.draw_parts(), scene.texture_levels(),
                     request.shader_folder);
        target.emplace(output.width, output.height, output.samples, gpu::Target::Format::srgb8);
        if (!aovs.empty()) aov_writer.emplace(scene, *pass, aovs);
      }
      const int step = scene.step_of_frame(frame);
      const int before = stepper->step();
      stepper->advance_to(step);
      const passes::View view = scene.view(frame);
      io::Image picture;
      const bool same = stepper->unchanged() && before == step - 1 && last_picture_step == before &&
                        scene.settings.camera.name.empty();
      if (same) {
        picture = last_picture;
      } else {
        timer.begin("render");
        pass->draw_resolved(stepper->surface(), view, *target, context.info().software);
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
      for (const auto& [stage, ms] : timer.collect()) entry.ms[stage] += ms;
      if (aov_writer) aov_writer->write(stepper->surface(), view, entry.path);

      writer.submit([&, i, hash, picture = std::move(picture)] {
        FrameReport& mine = report.frames[i];
        try {
          const double encode = now_ms();
          io::PngOptions options;
          options.hash = hash;
          const auto bytes = io::encode_png(picture, options);
          const double write = now_ms();
          write_whole_file(mine.path, bytes);
          mine.ms["encode"] = write - encode;
          mine.ms["write"] = now_ms() - write;
        } catch (const Error& error) {
          mine.error = error.what();
          std::lock_guard lock(callback_mutex);
          if (!stop) stop = std::current_exception();
        }
        finished(i);
      });
    }
    writer.finish();
  }
  if (stop) std::rethrow_exception(stop);
  std::erase_if(report.frames, [](const FrameReport& frame) { return frame.frame == 0; });
  if (stepper) {
    if (stepper->unchanged_steps() > 0) report.skipped["unchanged poses"] = stepper->unchanged_steps();
    if (!request.state_file.empty()) stepper->write_state(request.state_file, driver);
  }
  report.wall_s = (now_ms() - started) * 1e-3;
  report.fps = report.wall_s > 0 ? static_cast<double>(report.frames.size()) / report.wall_s : 0;
  return report;
}

}  // namespace plisse
