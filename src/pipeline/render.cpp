// The run that makes pictures: steps the history, draws the requested frames, and passes them to threads that
// encode and write while the next one is drawn.
#include "pipeline/render.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
#include "base/message_scope.h"
#include "config/frames.h"
#include "config/settings.h"
#include "gpu/shader_source.h"
#include "io/picture/png.h"
#include "io/sequence.h"
#include "pipeline/aov.h"
#include "pipeline/displace.h"
#include "pipeline/frame_drawer.h"
#include "pipeline/frame_writer.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/saved.h"

namespace plisse::pipeline {
namespace {

// The drawing part: driver and shaders.
Hash driver_hash(const GlInfo& gl, const std::string& shader_folder) {
  Hash hash;
  hash.add(gl.vendor).add(gl.renderer).add(gl.version);
  for (const auto& shader : gpu::embedded_shaders())
    hash.add(shader.name).add(gpu::shader_source(shader.name, shader_folder));
  return hash;
}

// Calls `work` and records its errors in the frame's report. Too little memory is an error of that frame
// alone; any other error ends the run.
template <typename Work>
void guarded(FrameReport& frame, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.code != ExitCode::no_output && error.code != ExitCode::try_again) throw;
    frame.error = error.what();
    frame.code = error.code;
  } catch (const std::bad_alloc&) {
    frame.error = fmt::format("{}: memory is exhausted; try again with fewer threads or a smaller picture",
                              frame.path.empty() ? fmt::format("frame {}", frame.frame) : frame.path);
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

// The control of --budget or --max-error, or neither.
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
  void drew(Stepper& stepper, double milliseconds) {
    if (time_) time_->spent(milliseconds);
    if (error_ && stepper.descended()) error_->moved(stepper.last_round_moved());
  }

 private:
  std::optional<TimeBudget> time_;
  std::optional<ErrorBudget> error_;
};

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

// The hash of a body: the bytes of its files (without files that these name), or the name of a part of the
// model.
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

// Displaced geometry has these AOVs; the others belong to single waves.
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

// One run: the data that its stages share.
class Run {
 public:
  Run(const RenderRequest& request, const FrameCallback& on_frame)
      : request_(request), on_frame_(on_frame), started_(wall_seconds()) {}

  void load();
  void split();
  void draw_frames();
  RenderReport report();

 private:
  void begin_report();
  std::string hash_of(int frame);
  bool stands_already(FrameReport& entry, const std::string& hash);
  bool draw(FrameReport& entry, const std::string& hash, std::shared_ptr<Picture>& picture);
  void write(std::size_t index, const std::string& hash, const std::shared_ptr<Picture>& picture);
  void finished(std::size_t index);
  void write_state();

  const RenderRequest& request_;
  const FrameCallback& on_frame_;
  double started_;
  std::unique_ptr<LoadedScene> scene_;
  std::optional<gpu::Context> context_;
  std::exception_ptr no_context_;
  std::optional<gpu::StageTimer> timer_;
  std::optional<Governor> governor_;
  std::vector<int> frames_;
  std::vector<passes::Aov> aovs_;
  Hash driver_;
  std::string body_hash_, split_hash_;  // of what displaces
  std::optional<Subdivision> split_;
  // Made when the first frame is drawn, so that a run whose frames all exist is fast.
  std::optional<FrameDrawer> drawer_;
  RenderReport report_;
  std::mutex callback_mutex_;  // of the two below, and of callbacks
  int done_ = 0;
  bool full_ = false;  // a frame could not be written, and the next one could not either
};

// Loads the scene and the driver at the same time: a separate process reads the model.
void Run::load() {
  auto loading = std::async(std::launch::async, log::in_this_scope([&] {
                              return std::make_unique<LoadedScene>(request_.scene, request_.memory,
                                                                   smooth_levels_within(request_.levels));
                            }));
  try {
    context_.emplace(request_.device);
  } catch (const Error&) {
    no_context_ = std::current_exception();
  }
  scene_ = loading.get();  // errors of the scene are reported first
  frames_ = config::select_frames(scene_->settings.model.frames, scene_->animation.timeline().frame_count);
  if (!request_.on_picture) config::check_frame_paths(scene_->settings.output.path, frames_);
  aovs_ = parse_aovs(request_.aovs);
  check_aovs(aovs_, request_.displace);
  check_budget(request_);
  body_hash_ = body_fingerprint(request_.outside);
  if (!request_.state_file.empty()) check_writable(request_.state_file);
  if (no_context_) std::rethrow_exception(no_context_);
  timer_.emplace(context_->info().software);
  driver_ = driver_hash(context_->info(), request_.shader_folder);
  governor_.emplace(request_, scene_->settings);
  begin_report();
}

void Run::begin_report() {
  report_.gl = context_->info();
  report_.render_vertices = scene_->surface().render_vertices.size();
  report_.welded_vertices = scene_->surface().vertex_count();
  report_.triangles = scene_->surface().triangle_count();
  report_.timer = timer_->kind();
  for (const Part& part : scene_->surface().parts) report_.objects.push_back({part.mesh, part.material_name});
  report_.wavelength_m = scene_->wavelength();
  report_.frames.resize(frames_.size());
}

// The splitting of a displaced surface depends on the whole clip, so it is a part of each frame's hash.
void Run::split() {
  if (!request_.displace) return;
  split_ = request_.levels ? subdivide(scene_->surface(), 1 << (*request_.levels - scene_->smooth_levels()))
                           : split_as_needed(*scene_);
  const auto bytes = std::as_bytes(std::span(split_->triangles));
  split_hash_ = Hash().add_bytes({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}).hex();
}

std::string Run::hash_of(int frame) {
  if (governor_->active() || request_.on_picture) return {};
  const std::string hash = scene_->frame_hash(frame, driver_);
  if (!request_.displace) return hash;
  return Hash().add(hash).add("displaced").add(split_hash_).add(body_hash_).hex();
}

bool Run::stands_already(FrameReport& entry, const std::string& hash) {
  entry.skipped = request_.skip_existing && std::filesystem::exists(entry.path) &&
                  io::png_is_whole(entry.path, hash) && aovs_are_whole(aovs_, entry.path, hash);
  if (entry.skipped) ++report_.skipped["existing frames"];
  return entry.skipped;
}

// Steps the history up to the frame and draws it; false where a signal came before.
bool Run::draw(FrameReport& entry, const std::string& hash, std::shared_ptr<Picture>& picture) {
  if (!drawer_) {
    drawer_.emplace(*scene_, request_, std::move(split_), aovs_, *context_, *timer_);
    if (!request_.state_file.empty())
      drawer_->stepper().read_state(request_.state_file, driver_, scene_->step_of_frame(entry.frame));
  }
  const double began = wall_seconds();
  const auto skipped_before = drawer_->skipped();
  entry.effort = governor_->effort();
  if (entry.effort) drawer_->set_effort(*entry.effort);
  if (!drawer_->advance_to(entry.frame)) return false;
  guarded(entry, [&] { picture = drawer_->draw(entry, hash); });
  for (const auto& [stage, ms] : timer_->collect()) entry.ms[stage] += ms;
  for (const auto& [what, count] : drawer_->skipped()) {
    const auto before = skipped_before.find(what);
    if (before == skipped_before.end() || before->second != count) entry.left_out.push_back(what);
  }
  governor_->drew(drawer_->stepper(), 1e3 * (wall_seconds() - began));
  return true;
}

// Encodes and writes a frame that was drawn; on a thread of the writer.
void Run::write(std::size_t index, const std::string& hash, const std::shared_ptr<Picture>& picture) {
  FrameReport& entry = report_.frames[index];
  if (entry.error.empty()) {
    guarded(entry, [&] {
      const double encode = wall_seconds();
      const auto [bytes, compressed] = picture->png(hash);
      const double write = wall_seconds();
      write_whole_file(entry.path, bytes);
      if (compressed) entry.ms["encode"] = 1e3 * (write - encode);
      entry.ms["write"] = 1e3 * (wall_seconds() - write);
    });
  }
  if (entry.code == ExitCode::no_output) {
    std::lock_guard lock(callback_mutex_);
    full_ = true;
  }
  finished(index);
}

void Run::finished(std::size_t index) {
  std::lock_guard lock(callback_mutex_);
  ++done_;
  if (on_frame_) on_frame_(done_, static_cast<int>(frames_.size()), report_.frames[index]);
}

// With --skip-existing, existing frames are left out. Frames are encoded and written by threads while the
// next one is drawn.
void Run::draw_frames() {
  FrameWriter writer(context_->info().software);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    {
      std::lock_guard lock(callback_mutex_);
      if (full_) break;
    }
    report_.interrupted = interrupted();
    if (report_.interrupted) break;
    FrameReport& entry = report_.frames[i];
    entry.frame = frames_[i];
    entry.time_s = scene_->animation.timeline().time(entry.frame);
    if (!request_.on_picture) entry.path = config::frame_path(scene_->settings.output.path, entry.frame);
    const std::string hash = hash_of(entry.frame);
    if (stands_already(entry, hash)) {
      finished(i);
      continue;
    }
    std::shared_ptr<Picture> picture;
    if (!draw(entry, hash, picture)) {
      entry.frame = 0;
      report_.interrupted = true;
      break;
    }
    if (request_.on_picture) {
      if (entry.error.empty()) request_.on_picture(entry, picture->image());
      finished(i);
    } else {
      writer.submit([this, i, hash, picture] { write(i, hash, picture); });
    }
  }
  writer.finish();
}

void Run::write_state() {
  try {
    drawer_->stepper().write_state(request_.state_file, driver_);
  } catch (const Error& error) {  // the frames are complete nevertheless
    report_.outcome = ExitCode::no_output;
    if (report_.failure.empty()) report_.failure = error.what();
  }
}

RenderReport Run::report() {
  std::erase_if(report_.frames, [](const FrameReport& frame) { return frame.frame == 0; });
  report_.outcome = outcome(report_.frames);
  int drawn = 0;
  for (const FrameReport& frame : report_.frames) {
    if (report_.failure.empty()) report_.failure = frame.error;
    drawn += !frame.skipped && frame.error.empty() ? 1 : 0;
  }
  if (drawer_) {
    report_.skipped.merge(drawer_->skipped());
    report_.saved_s = saved_seconds(report_);
    if (!request_.state_file.empty()) write_state();
  }
  report_.wall_s = wall_seconds() - started_;
  report_.fps = report_.wall_s > 0 ? drawn / report_.wall_s : 0;
  return std::move(report_);
}

}  // namespace

RenderReport render(const RenderRequest& request, const FrameCallback& on_frame) {
  Run run(request, on_frame);
  run.load();         // the scene, and the driver
  run.split();        // its surface, where waves are geometry
  run.draw_frames();  // skin → crush → relax → render → write
  return run.report();
}

}  // namespace plisse::pipeline
