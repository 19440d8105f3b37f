// plisse bake: the wrinkles of frames as height and normal maps.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cli/solved_scene.h"
#include "config/suggest.h"
#include "pipeline/bake.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options)
      : scene(options, [](const std::string& option) { return decides_geometry(option); }),
        solve(options),
        device(options),
        common(options) {
    options.add("-o,--output", output, "DIR", "The folder for height_####.exr and .png and normal_####.png");
    options.add("--maps", maps, Values::with_commas, "NAMES",
                "height, normal, or both with a comma, which is the default");
    options.add("--texture-size", texture_size, "N", "Side of the maps in texels, 16 … 16384; default: 2048");
    options.add("--green", green, "up|down",
                described("Which way the normal map's green points: up (Blender, glTF, OpenGL; the default) "
                          "or down (DirectX)"));
    options.add("--outside", outside, "MESH|FILE",
                described("A body that the wrinkles keep out of: a mesh or material of the model, or a "
                          "model of its own with one frame or as many"));
    options.add("--shaders", shaders, "DIR",
                "Take the shaders from this folder instead of the built-in ones");
  }

  pipeline::BakeRequest request() const {
    pipeline::BakeRequest request;
    request.scene = scene.settings();
    request.output = output;
    const std::vector<std::string> names{"height", "normal"};
    for (const std::string& map : maps) {
      if (map != "height" && map != "normal") {
        throw Error(ExitCode::bad_input,
                    fmt::format("--maps {}: there is no such map{}; there are: height, normal", map,
                                config::did_you_mean(map, names)));
      }
    }
    const auto wanted = [&](const char* map) {
      return maps.empty() || std::find(maps.begin(), maps.end(), map) != maps.end();
    };
    request.height = wanted("height");
    request.normal = wanted("normal");
    if (!texture_size.empty()) request.texture_size = whole_number("--texture-size", texture_size, 16, 16384);
    if (green != "up" && green != "down")
      throw Error(ExitCode::bad_input, fmt::format("--green: '{}'; allowed: up or down", green));
    request.green_up = green == "up";
    request.outside = outside;
    request.device = device.device();
    request.shader_folder = shaders;
    return request;
  }

  SceneArguments scene;
  SolveArguments solve;
  DeviceArguments device;
  CommonArguments common;
  std::string output, texture_size, green = "up", outside, shaders;
  std::vector<std::string> maps;
};

ordered_json to_json(const pipeline::BakeReport& report) {
  ordered_json outputs = ordered_json::array();
  for (const auto& output : report.outputs)
    outputs.push_back({{"path", output.path}, {"kind", output.kind}, {"frame", output.frame}});
  return {{"outputs", outputs},
          {"scale_m", report.scale_m},
          {"uv", {{"corner", {report.corner.x, report.corner.y}}, {"side", report.side}}},
          {"covered", report.covered},
          {"overlapping", report.overlapping},
          {"interrupted", report.interrupted},
          {"wall_s", report.wall_s}};
}

int run_bake(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.device.list_wanted()) {
    arguments.device.list();
    return 0;
  }
  pipeline::BakeRequest request = arguments.request();
  install_interrupt_handlers();
  SolvedRun solved = arguments.solve.run(request.scene, arguments.common, [&] {
    pipeline::check(request);
    check_writable(std::filesystem::path(request.output) / "height_0001.png");
  });
  if (solved.interrupted) {
    write_report({{"interrupted", true}}, arguments.common.json());
    return 128 + signal_number();
  }
  request.memory = std::move(solved.memory);
  pipeline::BakeReport report;
  {
    Progress progress(Progress::style_for_stderr(arguments.common.quiet()));
    report = pipeline::bake_maps(request, frame_progress(progress));
  }
  log::notice(fmt::format("{} files in {:.2f} s; black and white of height's PNG are ∓{:.4g} mm → {}",
                          report.outputs.size(), report.wall_s, 1000 * report.scale_m, request.output));
  ordered_json json = to_json(report);
  if (!solved.report.is_null()) json["solve"] = std::move(solved.report);
  write_report(json, arguments.common.json());
  if (report.interrupted) return 128 + signal_number();
  return static_cast<int>(solved.converged ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace

void add_bake(CommandLine& line) {
  CommandOptions& options = line.command(
      "bake", "Write the wrinkles of frames as maps over the model's uv",
      "\nplisse bake scene.toml --frames 48 -o maps --texture-size 4096\n"
      "For the posed mesh without wrinkles: plisse export scene.toml --frames 48 --levels 0 --strength 0 -o "
      "mesh.glb");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_bake(*arguments); };
}

}  // namespace plisse::cli
