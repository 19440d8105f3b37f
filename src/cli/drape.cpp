// plisse drape: the static equilibrium of cloth, as base surfaces for wrinkles.

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
#include "base/units.h"
#include "bench/drape_cost.h"
#include "cli/arguments.h"
#include "cli/cache_arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cloth/drape.h"
#include "cloth/drape_examples.h"
#include "cloth/drape_setup.h"
#include "config/suggest.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options) : common(options), cache(options) {
    options.add("input", input, "SCENE.toml|SETUP.json",
                described("A drape scene (docs/drape.md lists its keys), or a set-up of the TFW authors"));
    options.add("--example", example, "NAME", "A built-in scene instead; --list-examples names them");
    options.flag("--list-examples", list, "Print the built-in scenes and end");
    options.add("--vertices", vertices, "N", "About how many vertices an example's mesh has");
    options.add("--seed", seed, "S", "Another seed, another mesh of the same example (default 1)");
    options.add("--model", model, "tension-field|stvk",
                described("tension-field (compression costs nothing; the default) or stvk (a St. "
                          "Venant-Kirchhoff shell, which buckles by itself)"));
    options.add("--residual", residual, "ETA",
                described("Share of its stiffness that slack cloth keeps, 0 to 1: spreads compression "
                          "that tension field theory leaves undetermined; 1e-4 is little"));
    options.add(
        "--perturb", perturb, "LENGTH",
        described("Move the start at random by up to this length, so that what can buckle does; default: "
                  "a tenth of the thickness with stvk, else 0"));
    options.add("--start", start, "FILE", "An OBJ with the positions to start from, vertex by vertex");
    options.add("--frames", frames, "SELECTION",
                described("Frames of a scene that moves: 1-24, 12; default: the last alone"));
    options.add(
        "-o,--output", output, "FILE",
        described("base.ply, or base_####.ply for a file a frame; several frames in one file are the first "
                  "as PLY and all as a point cache (base.pc2) that 'plisse render --cache' reads"));
    options.add("--steps", steps, "N",
                described("In how many frames the load comes on; default: the scene's, an example's 24"));
    options.add(
        "--tolerance", tolerance, "SHARE",
        described("Converged where unbalanced forces are this share of those that meet (default 1e-8)"));
    options.add("--friction", friction, "MU",
                described("Coefficient of friction on obstacles, 0 to 1000 (default: the scene's)"));
    options.add(
        "--cost", cost, "N,N,…",
        described("Solve an example at each of these sizes, separated by commas, each from its start to full "
                  "load in one go, and plot what it costs: -o cost.svg"));
    options.add("--iterations", iterations, "N", "At most so many Newton steps a frame (default 1000)");
  }

  CommonArguments common;
  CacheArguments cache;
  std::string input, example, vertices, seed, model, residual, perturb, start, frames, steps,
      output = "base.ply", tolerance, iterations, friction, cost;
  bool list = false;
};

double number_in(const std::string& option, const std::string& text, double low, double high) {
  const auto value = parse_number(text);
  if (!value || !(*value >= low && *value <= high))
    throw Error(ExitCode::bad_input,
                fmt::format("{}: '{}' is not a number from {} to {}", option, text, low, high));
  return *value;
}

cloth::DrapeScene scene_of(const Arguments& arguments) {
  if (arguments.input.empty() == arguments.example.empty())
    throw Error(ExitCode::bad_input,
                "plisse drape: give a SCENE.toml, a SETUP.json or --example NAME; see 'plisse drape --help'");
  cloth::DrapeScene scene;
  if (!arguments.example.empty()) {
    const int vertices =
        arguments.vertices.empty() ? 0 : whole_number("--vertices", arguments.vertices, 20, 1000000);
    const int seed = arguments.seed.empty() ? 1 : whole_number("--seed", arguments.seed, 0, 2147483647);
    scene = cloth::drape_example(arguments.example, vertices, static_cast<std::uint32_t>(seed));
  } else {
    if (!arguments.vertices.empty() || !arguments.seed.empty())
      throw Error(ExitCode::bad_input,
                  "--vertices and --seed are for --example: a scene file has its own mesh");
    scene = cloth::load_drape(arguments.input);
  }
  if (!arguments.model.empty()) {
    const std::vector<std::string> models = {"tension-field", "stvk"};
    if (arguments.model != models[0] && arguments.model != models[1])
      throw Error(ExitCode::bad_input,
                  fmt::format("--model: unknown model '{}'{}; there are tension-field and stvk",
                              arguments.model, config::did_you_mean(arguments.model, models)));
    const bool stvk = arguments.model == "stvk";
    scene.stretching = stvk ? shell::Stretching::stvk : shell::Stretching::tension_field;
    scene.bending = stvk ? shell::Bending::midedge : shell::Bending::quadratic;
  }
  if (scene.stretching == shell::Stretching::stvk) scene.perturb = 0.1 * scene.material.thickness;
  if (!arguments.perturb.empty()) {
    const auto length = parse_length(arguments.perturb);
    if (!length || !(*length >= 0 && *length <= 1e6))
      throw Error(ExitCode::bad_input,
                  fmt::format("--perturb: '{}' is no length; allowed: 0 or more, in metres or with {}",
                              arguments.perturb, length_units));
    scene.perturb = *length;
  }
  if (!arguments.residual.empty() && scene.stretching == shell::Stretching::stvk)
    throw Error(ExitCode::bad_input,
                "--residual is for tension fields: a stvk shell has all of its stiffness when it is slack");
  if (!arguments.residual.empty()) scene.residual = number_in("--residual", arguments.residual, 0, 1);
  if (!arguments.friction.empty())
    scene.loads.friction = number_in("--friction", arguments.friction, 0, 1000);
  if (!arguments.tolerance.empty())
    scene.newton.tolerance = number_in("--tolerance", arguments.tolerance, 1e-14, 1);
  if (!arguments.iterations.empty())
    scene.newton.max_iterations = whole_number("--iterations", arguments.iterations, 1, 1000000);
  if (!arguments.steps.empty()) scene.frames = whole_number("--steps", arguments.steps, 1, 1000000);
  if (!arguments.start.empty()) scene.start = cloth::read_start(arguments.start, scene);
  return scene;
}

ordered_json to_json(const cloth::DrapeFrame& frame) {
  const shell::Equilibrium& e = frame.equilibrium;
  ordered_json trace = ordered_json::array();
  for (const shell::NewtonStep& step : e.trace)
    trace.push_back({{"iteration", step.iteration},
                     {"seconds", step.seconds},
                     {"energy_J", step.energy},
                     {"gradient_inf", step.gradient_inf},
                     {"step", step.step}});
  ordered_json json = {{"frame", frame.frame},
                       {"load", frame.load},
                       {"path", frame.path},
                       {"energy_J", e.energy},
                       {"gradient_inf", e.gradient_inf},
                       {"force_scale_N", e.force_scale},
                       {"iterations", e.iterations},
                       {"converged", e.converged},
                       {"reason", e.reason},
                       {"measures", ordered_json(frame.measures)},
                       {"analysis_s", e.analysis_s},
                       {"assembly_s", e.assembly_s},
                       {"factor_s", e.factor_s},
                       {"line_search_s", e.line_search_s},
                       {"factor_nonzeros", e.factor_nonzeros},
                       {"trace", trace}};
  if (frame.contact)
    json.update({{"friction_J", e.friction},
                 {"inside", frame.contact->inside},
                 {"deepest_m", frame.contact->deepest},
                 {"nearest_m", frame.contact->nearest}});
  return json;
}

ordered_json to_json(const cloth::DrapeReport& report, const std::string& model) {
  ordered_json frames = ordered_json::array(), outputs = ordered_json::array();
  for (const cloth::DrapeFrame& frame : report.frames) frames.push_back(to_json(frame));
  for (const auto& path : report.outputs)
    outputs.push_back({{"path", path.string()}, {"kind", path.extension() == ".pc2" ? "cache" : "base"}});
  ordered_json json = {{"vertices", report.vertices}, {"faces", report.faces}, {"model", model}};
  if (!frames.empty()) {  // the last one speaks for the run
    for (const char* key : {"energy_J", "gradient_inf", "iterations"}) json[key] = frames.back()[key];
    json["converged"] = report.converged;
    json["reason"] = frames.back()["reason"];
    json["measures"] = frames.back()["measures"];
  }
  json["interrupted"] = report.interrupted;
  if (!report.failure.empty()) json["failure"] = report.failure;
  json["wall_s"] = report.wall_s;
  json["peak_rss_MiB"] = report.peak_rss_MiB;
  json.update(reused_json(report.from_cache, report.saved_s));
  json["outputs"] = outputs;
  json["frames"] = frames;
  return json;
}

int run_costs(Arguments arguments) {
  const std::vector<int> sizes = whole_numbers("--cost", arguments.cost, 20, 1000000);
  const std::filesystem::path output = arguments.output;
  if (arguments.example.empty() || output.extension() != ".svg")
    throw Error(ExitCode::bad_input,
                "--cost solves an --example at sizes of its own, and writes -o FILE.svg");
  refuse_without_effect({{"--vertices", !arguments.vertices.empty()},
                         {"--start", !arguments.start.empty()},
                         {"--frames", !arguments.frames.empty()},
                         {"--steps", !arguments.steps.empty()},
                         {"--cache-dir", arguments.cache.given()}},
                        "beside --cost, which solves anew at sizes of its own, from the example's start to "
                        "full load in one go");
  check_writable(output);
  install_interrupt_handlers();
  const auto costs = bench::drape_costs(
      [&](int vertices) {
        arguments.vertices = std::to_string(vertices);
        return scene_of(arguments);
      },
      sizes,
      [](const bench::DrapeCost& cost) {
        log::notice(fmt::format(
            "{} vertices: {} steps, {:.3g} s ({:.3g} s of CPU time), assembly {:.0f} %, "
            "factorisation {:.0f} %{}",
            cost.vertices, cost.iterations, cost.wall_s, cost.cpu_s, 100 * cost.assembly_s / cost.wall_s,
            100 * cost.factor_s / cost.wall_s, cost.converged ? "" : ", NOT CONVERGED"));
      });
  if (interrupted()) return 128 + signal_number();
  bench::plot_costs(output, arguments.example, costs);
  log::notice(fmt::format("→ {}", output.string()));
  ordered_json json = {{"example", arguments.example}, {"costs", ordered_json::array()}};
  bool converged = true;
  for (const bench::DrapeCost& cost : costs) {
    converged = converged && cost.converged;
    json["costs"].push_back({{"vertices", cost.vertices},
                             {"iterations", cost.iterations},
                             {"converged", cost.converged},
                             {"energy_J", cost.energy},
                             {"wall_s", cost.wall_s},
                             {"cpu_s", cost.cpu_s},
                             {"analysis_s", cost.analysis_s},
                             {"assembly_s", cost.assembly_s},
                             {"factor_s", cost.factor_s},
                             {"line_search_s", cost.line_search_s},
                             {"factor_nonzeros", cost.factor_nonzeros}});
  }
  json["outputs"] = {{{"path", output.string()}, {"kind", "plot"}}};
  write_report(json, arguments.common.json());
  return static_cast<int>(converged ? ExitCode::fine : ExitCode::check_failed);
}

int run_drape(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.list) {
    std::string text;
    for (const cloth::DrapeExample& example : cloth::drape_examples())
      text += padded(example.name, 27) + padded(fmt::format("{} vertices", example.vertices), 16) +
              example.what + "\n";
    write_stdout(text);
    return 0;
  }
  if (!arguments.cost.empty()) return run_costs(arguments);
  cloth::DrapeRequest request{
      scene_of(arguments), arguments.frames, arguments.output, {}, arguments.cache.folder()};
  const std::string model = request.scene.stretching == shell::Stretching::stvk ? "stvk" : "tension-field";
  install_interrupt_handlers();
  Progress progress(Progress::style_for_stderr(arguments.common.quiet()) == Progress::Style::bar
                        ? Progress::Style::bar
                        : Progress::Style::none);
  request.progress = [&](int frame, int frames, const shell::NewtonStep& step) {
    progress.update(frame - 1, frames, fmt::format("step {}: {:.9g} J", step.iteration, step.energy));
    log::info(
        fmt::format("frame {} step {}: {:.12g} J, unbalanced {:.2e} N, {:.3g} of the Newton step, {:.2f} s",
                    frame, step.iteration, step.energy, step.gradient_inf, step.step, step.seconds));
  };
  const cloth::DrapeReport report = cloth::drape(request);
  for (const cloth::DrapeFrame& frame : report.frames) {
    std::string measures;
    for (const auto& [name, value] : frame.measures) measures += fmt::format(", {} {:.6g}", name, value);
    log::notice(fmt::format("{}frame {}: {} vertices, {:.9g} J after {} steps ({}){}",
                            frame.equilibrium.converged ? "" : "NOT CONVERGED, ", frame.frame,
                            report.vertices, frame.equilibrium.energy, frame.equilibrium.iterations,
                            frame.equilibrium.reason, measures));
  }
  for (const auto& path : report.outputs) log::notice(fmt::format("→ {}", path.string()));
  write_report(to_json(report, model), arguments.common.json());
  if (!report.failure.empty()) throw Error(report.failure_code, report.failure);
  if (report.interrupted) return 128 + signal_number();
  return static_cast<int>(report.converged ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace

void add_drape(CommandLine& line) {
  CommandOptions& options = line.command(
      "drape", "Solve the equilibrium of cloth: base surfaces for wrinkles",
      "\nplisse drape --example twisted-cylinder --vertices 1309 -o base.ply\n"
      "plisse drape --example curtain --frames 1-24 -o curtain.ply    curtain.ply and curtain.pc2, for\n"
      "                                                               'plisse render curtain.ply --cache "
      "curtain.pc2'");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_drape(*arguments); };
}

}  // namespace plisse::cli
