// plisse verify: the shaders against the reference in double precision, pass by pass.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cli/solved_scene.h"
#include "pipeline/render.h"
#include "pipeline/verify.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options)
      : scene(options, [](const std::string& option) { return option != "--output"; }),
        solve(options),
        device(options),
        common(options) {
    options.add("--shaders", shaders, "DIR",
                "Take the shaders from this folder instead of the built-in ones");
  }

  SceneArguments scene;
  SolveArguments solve;
  DeviceArguments device;
  CommonArguments common;
  std::string shaders;
};

// "crush.r" stands with "crush", and the passes stand in the order they run in.
std::vector<std::string> pass_order(const pipeline::VerifyReport& report) {
  constexpr std::array<std::string_view, 5> order = {"skin", "crush", "relax", "displacement", "render"};
  const auto rank = [&](const std::string& name) {
    return std::find(order.begin(), order.end(), std::string_view(name).substr(0, name.find('.'))) -
           order.begin();
  };
  std::vector<std::string> names;
  for (const auto& [name, comparison] : report.passes) names.push_back(name);
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  return names;
}

ordered_json to_json(const pipeline::VerifyReport& report) {
  ordered_json passes = ordered_json::object();
  for (const std::string& name : pass_order(report)) {
    const pipeline::PassComparison& pass = report.passes.at(name);
    passes[name] = {{"max_abs", pass.max_abs}, {"rms", pass.rms},   {"tolerance", pass.tolerance},
                    {"ok", pass.ok},           {"unit", pass.unit}, {"compared", pass.compared}};
  }
  passes["render"]["fraction_within_4"] = report.fraction_within_4;
  passes["render"]["mean_flip"] = report.mean_flip;
  passes["render"]["silhouette_fraction"] = report.silhouette_fraction;
  return {{"ok", report.interrupted ? ordered_json() : ordered_json(report.ok)},
          {"interrupted", report.interrupted},
          {"gl", cli::to_json(report.gl)},
          {"frames", report.frames},
          {"passes", passes},
          {"chain",
           {{"phase_rms", report.chain_phase_rms},
            {"phase_tolerance", report.chain_phase_tolerance},
            {"image_flip", report.chain_image_flip},
            {"flip_tolerance", report.chain_flip_tolerance},
            {"ok", report.chain_ok}}},
          {"failures", report.failures}};
}

std::string table(const pipeline::VerifyReport& report) {
  std::string text = fmt::format("{} ({})\nframes {}\n\n", report.gl.renderer, report.gl.version,
                                 fmt::join(report.frames, ", "));
  text += fmt::format("{:<20} {:>9} {:>11} {:>11} {:>11}\n", "pass", "compared", "max", "rms", "tolerance");
  for (const std::string& name : pass_order(report)) {
    const pipeline::PassComparison& pass = report.passes.at(name);
    text += fmt::format("{:<20} {:>9} {:>11.3e} {:>11.3e} {:>11.3e}  {:<6} {}\n", name, pass.compared,
                        pass.max_abs, pass.rms, pass.tolerance, pass.ok ? "ok" : "FAILED", pass.unit);
  }
  text += fmt::format(
      "\nimage: {:.3f} % of pixels within 4/255, mean FLIP {:.5f}, silhouettes {:.3f} % of pixels\n",
      100 * report.fraction_within_4, report.mean_flip, 100 * report.silhouette_fraction);
  text += fmt::format("chain: phase rms {:.3e} rad, image FLIP {:.5f}  {}\n", report.chain_phase_rms,
                      report.chain_image_flip, report.chain_ok ? "ok" : "FAILED");
  for (const std::string& failure : report.failures) text += failure + "\n";
  if (report.interrupted) return text + "interrupted: no verdict\n";
  return text + (report.ok ? "ok\n" : "FAILED\n");
}

int run_verify(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.device.list_wanted()) {
    arguments.device.list();
    return 0;
  }
  pipeline::RenderRequest request;
  request.scene = arguments.scene.settings();
  request.device = arguments.device.device();
  request.shader_folder = arguments.shaders;
  install_interrupt_handlers();
  SolvedRun solved = arguments.solve.run(request.scene, arguments.common);
  if (solved.interrupted) {
    write_report({{"interrupted", true}}, arguments.common.json());
    return 128 + signal_number();
  }
  request.memory = std::move(solved.memory);
  pipeline::VerifyReport report;
  {
    Progress progress(Progress::style_for_stderr(arguments.common.quiet()));
    report = pipeline::verify(request, frame_progress(progress));
  }
  if (arguments.common.tables_wanted()) write_stdout(table(report));
  ordered_json json = to_json(report);
  if (!solved.report.is_null()) json["solve"] = std::move(solved.report);
  write_report(json, arguments.common.json());
  if (report.interrupted) return 128 + signal_number();
  return static_cast<int>(report.ok && solved.converged ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace

void add_verify(CommandLine& line) {
  CommandOptions& options = line.command(
      "verify", "Compare the shaders with the reference, pass by pass",
      "\nWithout --frames at most eight frames spread over the clip. Exit code 1 where a tolerance is "
      "exceeded or nothing is in view.");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_verify(*arguments); };
}

}  // namespace plisse::cli
