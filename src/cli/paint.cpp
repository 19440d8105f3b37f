// plisse paint: wrinkles of the rest pose from a file of strokes.

#include <fmt/format.h>

#include <memory>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "config/paint_file.h"
#include "pipeline/paint.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options) : device(options), common(options) {
    options.add("input", input, "PAINT.toml", described("A paint file; docs/paint.md lists its keys"));
    options.add(
        "-o,--output", folder, "DIR",
        described("The folder for bias.ply, bias.png (the uv texture) and preview.png; default: painted"));
    options.add("--shaders", shaders, "DIR",
                "Take the shaders from this folder instead of the built-in ones");
  }

  DeviceArguments device;
  CommonArguments common;
  std::string input, folder = "painted", shaders;
};

ordered_json to_json(const pipeline::PaintReport& report) {
  ordered_json outputs = ordered_json::array();
  for (const auto& output : report.outputs) outputs.push_back({{"path", output.path}, {"kind", output.kind}});
  ordered_json json = {{"vertices", report.vertices},
                       {"painted_vertices", report.painted_vertices},
                       {"largest", report.largest},
                       {"outputs", outputs}};
  for (const auto& step : report.steps) json["field_error"][step.step] = step.error;
  json["wall_s"] = report.wall_s;
  return json;
}

int run_paint(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.device.list_wanted()) {
    arguments.device.list();
    return 0;
  }
  if (arguments.input.empty())
    throw Error(ExitCode::bad_input, "plisse paint: give a PAINT.toml; see 'plisse paint --help'");
  pipeline::PaintRequest request;
  request.paint = config::load_paint(arguments.input);
  request.folder = arguments.folder;
  request.device = arguments.device.device();
  request.shader_folder = arguments.shaders;
  const pipeline::PaintReport report = pipeline::paint_wrinkles(request);
  log::notice(fmt::format("{} of {} vertices painted, the strongest {:.2f}, in {:.2f} s → {}",
                          report.painted_vertices, report.vertices, report.largest, report.wall_s,
                          request.folder));
  for (const auto& step : report.steps)
    log::notice(
        fmt::format("heights at rest against the field drawn directly, {}: {:.2f} % (root mean square)",
                    step.step == "clip"      ? "after the clip's frames"
                    : step.step == "texture" ? "from bias.png"
                                             : "from bias.ply",
                    100 * step.error));
  write_report(to_json(report), arguments.common.json());
  return 0;
}

}  // namespace

void add_paint(CommandLine& line) {
  CommandOptions& options = line.command(
      "paint", "Paint wrinkles onto the rest pose, from a file of strokes",
      "\nplisse paint sleeve.paint.toml -o painted          bias.ply, bias.png, preview.png\n"
      "A scene takes it up with [bias] file = \"painted/bias.ply\", or paints itself with [bias] paint = "
      "\"sleeve.paint.toml\".");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_paint(*arguments); };
}

}  // namespace plisse::cli
