// The run that makes pictures: steps the history, draws the frames that are wanted, and hands them to threads
// that encode and write while the next one is drawn.
#include "pipeline/render.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "config/frames.h"
#include "config/settings.h"
#include "gpu/shader_source.h"
#include "io/png.h"
#include "io/sequence.h"
#include "pipeline/aov.h"
#include "pipeline/displace.h"
#include "pipeline/frame_drawer.h"
#include "pipeline/frame_writer.h"
#include "pipeline/loaded_scene.h"

namespace plisse::pipeline {
namespace {

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

// --budget or --max-error at work, or neither.
class Governor {
 public:
  Governor(const RenderRequest& request, const config::SceneSettings& settings) {
    const Effort wanted{settings.relax.rounds, settings.relax.interval, settings.output.samples};
    if (request.budget_ms > 0) time_.emplace(wanted, request.budget_ms);
    if (request.max_error > 0) error_.emplace(wanted, request.max_error);
  }
  bool active() const { return time_ || error_; }
  std::optional<Effort> effort() const {
    if (time_) return time_->effort();
    if (error_) return error_->effort();
    return std::nullopt;
  }
  void drew(pipeline::Stepper& stepper, double milliseconds) {
    if (time_) time_->spent(milliseconds);
    if (error_ && stepper.descended()) error_->moved(stepper.last_round_moved());
  }

 private:
  std::optional<pipeline::TimeBudget> time_;
  std::optional<pipeline::ErrorBudget> error_;
};

// The stages' mean over frames that did, or did not, leave something out; nothing where there is no such
// frame.
std::optional<double> mean_ms(const RenderReport& report, const std::vector<const char*>& stages,
                              const std::string& what, bool left_out) {
  double sum = 0;
  int frames = 0;
  for (const FrameReport& frame : report.frames) {
    if ((std::ranges::count(frame.left_out, what) > 0) != left_out) continue;
    bool any = false;
    for (const char* stage : stages) {
      if (const auto found = frame.ms.find(stage); found != frame.ms.end()) {
        sum += found->second;
        any = true;
      }
    }
    frames += any ? 1 : 0;
  }
  if (frames == 0) return std::nullopt;
  return sum / frames;
}

// What was left out: of whole stages, times what they cost on average where they were not; of parts of a
// picture, what pictures cost more where nothing was.
std::map<std::string, double> saved_seconds(const RenderReport& report) {
  const std::map<std::string, std::vector<const char*>> whole = {
      {"unchanged poses", {"skin", "crush", "relax"}},
      {"idle relaxations", {"relax"}},
      {"masked surfaces", {"crush", "relax"}},
      {"copied pictures", {"render", "readback", "encode"}},
  };
  std::map<std::string, double> saved;
  for (const auto& [what, count] : report.skipped) {
    if (const auto stages = whole.find(what); stages != whole.end()) {
      if (const auto cost = mean_ms(report, stages->second, what, false)) saved[what] = 1e-3 * count * *cost;
    } else if (what != "existing frames") {
      const auto with = mean_ms(report, {"render"}, what, true),
                 without = mean_ms(report, {"render"}, what, false);
      const auto frames = std::ranges::count_if(report.frames, [&](const FrameReport& frame) {
        return std::ranges::count(frame.left_out, what) > 0;
      });
      if (with && without && *without > *with)
        saved[what] = 1e-3 * static_cast<double>(frames) * (*without - *with);
    }
  }
  return saved;
}

void check_budget(const RenderRequest& request) {
  if (request.budget_ms <= 0 && request.max_error <= 0) return;
  const char* option = request.budget_ms > 0 ? "--budget" : "--max-error";
  const auto refuse = [&](const char* other) {
    throw Error(ExitCode::bad_input,
                fmt::format("{} makes frames that depend on more than the scene, so {} has nothing to trust: "
                            "leave one of them out",
                            option, other));
  };
  if (request.budget_ms > 0 && request.max_error > 0)
    throw Error(ExitCode::bad_input, "--budget and --max-error exclude each other");
  if (request.skip_existing) refuse("--skip-existing");
  if (!request.state_file.empty()) refuse("--state");
}

// What a body decides: the bytes of its files (what they name beside them is not looked at), or the name of a
// part of the model.
std::string body_fingerprint(const std::string& body) {
  std::error_code ignored;
  std::vector<std::filesystem::path> files;
  if (config::names_many_files(body)) files = io::sequence_files(body);
  if (std::filesystem::is_regular_file(body, ignored)) files = {body};
  Hash hash;
  hash.add(body);
  for (const auto& file : files) hash.add_bytes(read_whole_file(file));
  return hash.hex();
}

// Displaced geometry has these of its own; the others are of single waves.
void check_aovs(const std::vector<passes::Aov>& aovs, bool displaced) {
  if (!displaced) return;
  std::vector<std::string> sound, unsound;
  for (const passes::AovKind& kind : passes::aov_kinds())
    (kind.of_one_wave ? unsound : sound).push_back(kind.name);
  for (const passes::Aov aov : aovs) {
    if (passes::kind_of(aov).of_one_wave)
      throw Error(ExitCode::bad_input, fmt::format("--aov: {} do not go with --displace; {} do",
                                                   fmt::join(unsound, ", "), fmt::join(sound, ", ")));
  }
}

}  // namespace

RenderReport render(const RenderRequest& request, const FrameCallback& on_frame) {
  const double started = wall_seconds();
  // A process of its own reads the model while the driver starts.
  auto loading =
      std::async(std::launch::async, [&] { return std::make_unique<pipeline::LoadedScene>(request.scene); });
  std::optional<gpu::Context> started_context;
  std::exception_ptr no_context;
  try {
    started_context.emplace(request.device);
  } catch (const Error&) {
    no_context = std::current_exception();
  }
  const auto loaded = loading.get();  // what is wrong with the scene is told first
  pipeline::LoadedScene& scene = *loaded;
  const auto& output = scene.settings.output;
  const auto frames =
      config::select_frames(scene.settings.model.frames, scene.animation.timeline().frame_count);
  config::check_frame_paths(output.path, frames);
  const auto aovs = pipeline::parse_aovs(request.aovs);
  check_aovs(aovs, request.displace);
  check_budget(request);

  const std::string body_hash = body_fingerprint(request.outside);
  if (!request.state_file.empty()) check_writable(request.state_file);
  if (no_context) std::rethrow_exception(no_context);
  const gpu::Context& context = *started_context;
  gpu::StageTimer timer(context.info().software);
  const Hash driver = driver_hash(context.info(), request.shader_folder);

  RenderReport report;
  report.gl = context.info();
  report.render_vertices = scene.surface().render_vertices.size();
  report.welded_vertices = scene.surface().vertex_count();
  report.triangles = scene.surface().triangle_count();
  report.timer = timer.kind();
  for (const Part& part : scene.surface().parts) report.objects.push_back({part.mesh, part.material_name});
  report.wavelength_m = scene.wavelength();
  report.frames.resize(frames.size());

  // The whole clip decides how a displaced surface is split, so it is a part of each frame's hash.
  std::optional<Subdivision> split;
  std::string split_hash;
  if (request.displace) {
    split =
        request.levels ? subdivide(scene.surface(), 1 << *request.levels) : pipeline::split_as_needed(scene);
    const auto bytes = std::as_bytes(std::span(split->triangles));
    split_hash = Hash().add_bytes({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}).hex();
  }

  // Made when the first frame is drawn: a run that finds all frames done is quick.
  std::optional<pipeline::FrameDrawer> drawer;
  Governor governor(request, scene.settings);

  std::mutex callback_mutex;
  int done = 0;
  const auto finished = [&](std::size_t index) {
    std::lock_guard lock(callback_mutex);
    ++done;
    if (on_frame) on_frame(done, static_cast<int>(frames.size()), report.frames[index]);
  };
  bool full = false;  // a frame could not be written: the next one would fare the same

  {
    pipeline::FrameWriter writer(context.info().software);
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
      entry.path = config::frame_path(output.path, frame);
      std::string hash = governor.active() ? std::string() : scene.frame_hash(frame, driver);
      if (request.displace && !hash.empty())
        hash = Hash().add(hash).add("displaced").add(split_hash).add(body_hash).hex();
      const bool exists = std::filesystem::exists(entry.path);
      if (request.skip_existing && exists && io::png_is_whole(entry.path, hash) &&
          pipeline::aovs_are_whole(aovs, entry.path, hash)) {
        entry.skipped = true;
        ++report.skipped["existing frames"];
        finished(i);
        continue;
      }
      if (!drawer) {
        drawer.emplace(scene, request, std::move(split), aovs, context, timer);
        if (!request.state_file.empty())
          drawer->stepper().read_state(request.state_file, driver, scene.step_of_frame(frame));
      }
      const double began = wall_seconds();
      const auto skipped_before = drawer->skipped();
      entry.effort = governor.effort();
      if (entry.effort) drawer->set_effort(*entry.effort);
      if (!drawer->advance_to(frame)) {
        entry.frame = 0;
        report.interrupted = true;
        break;
      }
      std::shared_ptr<pipeline::Picture> picture;
      guarded(entry, [&] { picture = drawer->draw(entry, hash); });
      for (const auto& [stage, ms] : timer.collect()) entry.ms[stage] += ms;
      for (const auto& [what, count] : drawer->skipped()) {
        const auto before = skipped_before.find(what);
        if (before == skipped_before.end() || before->second != count) entry.left_out.push_back(what);
      }
      governor.drew(drawer->stepper(), 1e3 * (wall_seconds() - began));

      writer.submit([&, i, hash, picture] {
        FrameReport& mine = report.frames[i];
        if (mine.error.empty()) {
          guarded(mine, [&] {
            const double encode = wall_seconds();
            const auto [bytes, compressed] = picture->png(hash);
            const double write = wall_seconds();
            write_whole_file(mine.path, bytes);
            if (compressed) mine.ms["encode"] = 1e3 * (write - encode);
            mine.ms["write"] = 1e3 * (wall_seconds() - write);
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
  if (drawer) {
    report.skipped.merge(drawer->skipped());
    report.saved_s = saved_seconds(report);
    if (!request.state_file.empty()) {
      try {
        drawer->stepper().write_state(request.state_file, driver);
      } catch (const Error& error) {  // the frames stand all the same
        report.outcome = ExitCode::no_output;
        if (report.failure.empty()) report.failure = error.what();
      }
    }
  }
  report.wall_s = wall_seconds() - started;
  report.fps = report.wall_s > 0 ? drawn / report.wall_s : 0;
  return report;
}

}  // namespace plisse::pipeline
