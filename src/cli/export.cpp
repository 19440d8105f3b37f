// plisse export: the frames of a scene or a model as geometry.

#include <fmt/format.h>

#include <memory>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cli/solved_scene.h"
#include "config/frames.h"
#include "mesh/subdivide.h"
#include "pipeline/export.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options)
      : scene(options, [](const std::string& option) { return decides_geometry(option); }),
        solve(options),
        device(options),
        common(options) {
    options.add("-o,--output", output, "PATTERN|CACHE",
                described("Where to: mesh_####.ply, .obj or .glb, a file a frame; or a point cache .pc2 or "
                          ".mdd, which moves the vertices of an OBJ of the same scene"));
    options.add("--levels", levels, "N",
                described("Halve the mesh's edges this often; default: as often as the waves need. Allowed: "
                          "0 … 8."));
    options.add("--outside", outside, "MESH|FILE",
                described("A body that the wrinkles keep out of: a mesh or material of the model, or a "
                          "model of its own with one frame or as many"));
    options.add("--shaders", shaders, "DIR",
                "Take the shaders from this folder instead of the built-in ones");
  }

  SceneArguments scene;
  SolveArguments solve;
  DeviceArguments device;
  CommonArguments common;
  std::string output, levels, outside, shaders;
};

ordered_json to_json(const pipeline::ExportReport& report) {
  ordered_json outputs = ordered_json::array();
  for (const auto& output : report.outputs) {
    ordered_json entry = {{"path", output.path}, {"kind", output.kind}};
    if (output.frame > 0) entry["frame"] = output.frame;
    outputs.push_back(entry);
  }
  return {{"outputs", outputs},
          {"levels", report.levels},
          {"positions", report.positions},
          {"triangles", report.triangles},
          {"units_m", 1},
          {"up", "y"},
          {"interrupted", report.interrupted},
          {"wall_s", report.wall_s}};
}

int run_export(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.device.list_wanted()) {
    arguments.device.list();
    return 0;
  }
  pipeline::ExportRequest request;
  request.scene = arguments.scene.settings();
  request.output = arguments.output;
  if (!arguments.levels.empty()) request.levels = whole_number("--levels", arguments.levels, 0, most_levels);
  request.outside = arguments.outside;
  request.device = arguments.device.device();
  request.shader_folder = arguments.shaders;
  install_interrupt_handlers();
  SolvedRun solved = arguments.solve.run(request.scene, arguments.common, [&] {
    pipeline::check(request);
    check_writable(config::numbered_path(request.output, 1));
  });
  if (solved.interrupted) {
    write_report({{"interrupted", true}}, arguments.common.json());
    return 128 + signal_number();
  }
  request.memory = std::move(solved.memory);
  pipeline::ExportReport report;
  {
    Progress progress(Progress::style_for_stderr(arguments.common.quiet()));
    report = pipeline::export_geometry(request, frame_progress(progress));
  }
  log::notice(fmt::format("{} file{} in {:.2f} s: {} vertices, {} triangles, edges halved {} times → {}",
                          report.outputs.size(), report.outputs.size() == 1 ? "" : "s", report.wall_s,
                          report.positions, report.triangles, report.levels, request.output));
  ordered_json json = to_json(report);
  if (!solved.report.is_null()) json["solve"] = std::move(solved.report);
  write_report(json, arguments.common.json());
  if (report.interrupted) return 128 + signal_number();
  return static_cast<int>(solved.converged ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace

void add_export(CommandLine& line) {
  CommandOptions& options = line.command(
      "export", "Write the wrinkled frames as meshes or as a point cache",
      "\nplisse export scene.toml --frames 1-48 -o mesh_####.glb\n"
      "plisse export scene.toml --frames 1 -o sleeve.obj && plisse export scene.toml -o sleeve.pc2\n"
      "Metres, y up. With --strength 0 the posed model without its wrinkles.");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_export(*arguments); };
}

}  // namespace plisse::cli
