// plisse render: a scene or model becomes PNG frames.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/heap.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cli/solved_scene.h"
#include "config/frames.h"
#include "mesh/subdivide.h"
#include "passes/aov.h"
#include "pipeline/render.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options)
      : scene(options), solve(options), device(options), common(options) {
    options.add("--aov", aovs, Values::with_commas, "NAMES",
                described("Pictures of data beside each frame, as EXR and PNG: " + passes::aov_list() +
                          ", or several with commas"));
    options.flag(
        "--displace", displace,
        described("Draw the wrinkles as geometry in place of shading: true silhouettes and shadows"));
    options.add("--levels", levels, "N",
                described("With --displace: halve the mesh's edges this often; default: as often as the "
                          "waves need. Allowed: 0 … 8."));
    options.add("--outside", outside, "MESH|FILE",
                described("With --displace: a body that the wrinkles keep out of, a mesh or material of "
                          "the model, or a model of its own with one frame or as many"));
    options.add("--budget", budget, "MS",
                described("Keep a frame, from pose to picture, within so many milliseconds: rounds, interval "
                          "and samples give way, in this order"));
    options.add("--max-error", max_error, "E",
                described("Relax for as many rounds, and as seldom, as keep what one more would move the "
                          "phases by below so many radians"));
    options.add("--state", state, "FILE",
                described("Keep the waves' memory in this file, so that a later run goes on from it"));
    options.flag("--skip-existing", skip_existing,
                 described("Leave frames as they are whose file is whole and came from the same input"));
    options.flag("--overwrite", overwrite, "Write all frames anew; this is the default");
    options.add("--shaders", shaders, "DIR",
                "Take the shaders from this folder instead of the built-in ones");
  }

  pipeline::RenderRequest request() const {
    if (skip_existing && overwrite) {
      throw Error(ExitCode::bad_input, "--skip-existing and --overwrite exclude each other");
    }
    pipeline::RenderRequest request;
    request.scene = scene.settings();
    request.skip_existing = skip_existing;
    request.state_file = state;
    request.aovs = aovs;
    request.displace = displace;
    if (!levels.empty()) {
      if (!displace) throw Error(ExitCode::bad_input, "--levels goes with --displace");
      request.levels = whole_number("--levels", levels, 0, most_levels);
    }
    if (!outside.empty() && !displace) throw Error(ExitCode::bad_input, "--outside goes with --displace");
    request.outside = outside;
    if (!budget.empty()) request.budget_ms = positive_number("--budget", budget);
    if (!max_error.empty()) request.max_error = positive_number("--max-error", max_error);
    request.device = device.device();
    request.shader_folder = shaders;
    return request;
  }

  SceneArguments scene;
  SolveArguments solve;
  DeviceArguments device;
  CommonArguments common;
  std::vector<std::string> aovs;
  std::string state, shaders, levels, outside, budget, max_error;
  bool displace = false;
  bool skip_existing = false, overwrite = false;
};

// An interrupted run leaves the reports of the frames after it empty.
bool was_reached(const pipeline::FrameReport& frame) {
  return frame.frame > 0;
}

ordered_json to_json(const pipeline::FrameReport& frame) {
  ordered_json ms = ordered_json::object();
  for (const char* stage : {"skin", "crush", "relax", "displace", "render", "readback", "encode", "write"}) {
    if (const auto found = frame.ms.find(stage); found != frame.ms.end()) ms[stage] = found->second;
  }
  for (const auto& [stage, time] : frame.ms) ms[stage] = time;
  ordered_json json = {{"frame", frame.frame},
                       {"time_s", frame.time_s},
                       {"path", frame.path},
                       {"ms", ms},
                       {"skipped", frame.skipped}};
  if (!frame.left_out.empty()) json["left_out"] = frame.left_out;
  if (frame.effort)
    json["effort"] = {{"rounds", frame.effort->rounds},
                      {"interval", frame.effort->interval},
                      {"samples", frame.effort->samples}};
  if (!frame.error.empty()) json["error"] = frame.error;
  return json;
}

ordered_json to_json(const pipeline::RenderReport& report) {
  ordered_json frames = ordered_json::array();
  for (const pipeline::FrameReport& frame : report.frames) {
    if (was_reached(frame)) frames.push_back(to_json(frame));
  }
  ordered_json objects = ordered_json::array();
  for (const auto& object : report.objects)
    objects.push_back({{"mesh", object.mesh}, {"material", object.material}});
  return {{"gl", cli::to_json(report.gl)},
          {"vertices", {{"render", report.render_vertices}, {"welded", report.welded_vertices}}},
          {"triangles", report.triangles},
          {"objects", objects},
          {"wavelength_m", report.wavelength_m},
          {"timer", report.timer},
          {"frames", frames},
          {"fps", report.fps},
          {"wall_s", report.wall_s},
          {"skipped", report.skipped},
          {"saved_s", report.saved_s},
          {"interrupted", report.interrupted}};
}

// Says how it went.
void summarise(const pipeline::RenderReport& report, const std::string& where) {
  int reached = 0, failed = 0, skipped = 0;
  for (const pipeline::FrameReport& frame : report.frames) {
    reached += was_reached(frame) ? 1 : 0;
    skipped += frame.skipped ? 1 : 0;
    if (!frame.error.empty() && ++failed <= 10 && report.outcome == ExitCode::some_frames)
      log::warn(fmt::format("frame {}: {}", frame.frame, frame.error));
  }
  const int written = reached - skipped - failed;
  log::notice(fmt::format("{} frame{} in {:.2f} s ({:.1f} fps){}{} → {}", written, written == 1 ? "" : "s",
                          report.wall_s, report.fps, skipped > 0 ? fmt::format(", {} skipped", skipped) : "",
                          failed > 0 ? fmt::format(", {} failed", failed) : "", where));
}

int run_render(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.device.list_wanted()) {
    arguments.device.list();
    return 0;
  }
  pipeline::RenderRequest request = arguments.request();
  install_interrupt_handlers();

  if (!arguments.common.json().empty() && arguments.common.json() != "-")
    check_writable(arguments.common.json());
  SolvedRun solved = arguments.solve.run(request.scene, arguments.common, [&] {
    check_writable(config::frame_path(request.scene.output.path, 1));
  });
  if (solved.interrupted) {
    write_report({{"interrupted", true}}, arguments.common.json());
    return 128 + signal_number();
  }
  request.memory = std::move(solved.memory);
  pipeline::RenderReport report;
  {
    Progress progress(Progress::style_for_stderr(arguments.common.quiet()));
    share_heap();
    report = pipeline::render(request, frame_progress(progress));
  }
  summarise(report, request.scene.output.path);
  ordered_json json = to_json(report);
  if (!solved.report.is_null()) json["solve"] = std::move(solved.report);
  write_report(json, arguments.common.json());
  if (report.interrupted) {
    log::notice("interrupted; the frames written so far are whole");
    return 128 + signal_number();
  }
  if (report.outcome == ExitCode::no_output || report.outcome == ExitCode::try_again)
    throw Error(report.outcome, report.failure);
  if (report.outcome == ExitCode::fine && !solved.converged) return static_cast<int>(ExitCode::check_failed);
  return static_cast<int>(report.outcome);
}

}  // namespace

void add_render(CommandLine& line) {
  CommandOptions& options = line.command(
      "render", "Render a scene or a model to PNG frames",
      "\nplisse render Fox.glb                              every frame, camera and wavelength fitted, into "
      "frames/\n"
      "plisse render scene.toml --frames 1-48x2 -o out_####.png\n"
      "plisse render shirt.fbx --wavelength \"12 mm\" --exclude Face --camera 30,10,85");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_render(*arguments); };
}

}  // namespace plisse::cli
