// plisse wrinkle: amplitude and phase of the wrinkles on a base surface.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/units.h"
#include "bench/wrinkle_cost.h"
#include "cli/arguments.h"
#include "cli/cache_arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cli/size_options.h"
#include "cloth/base_file.h"
#include "cloth/drape_examples.h"
#include "cloth/drape_setup.h"
#include "cloth/fabric_material.h"
#include "cloth/follow_model.h"
#include "cloth/wrinkle_sequence.h"
#include "config/drape_file.h"
#include "config/frames.h"
#include "config/options.h"
#include "config/scene_file.h"
#include "config/suggest.h"
#include "io/sequence.h"
#include "mesh/subdivide.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options) : common(options), solved(options) {
    options.add(
        "input", input, "BASE.ply|BASE_####.ply|SCENE.toml|SETUP.json|MODEL",
        described("A base surface that 'plisse drape' wrote, a drape scene, a set-up of the TFW "
                  "authors (what is not draped yet is draped first); or any animated model, or a scene "
                  "with one, whose base surfaces are found first: -o FOLDER"));
    options.add(
        "--frames", frames, "RANGES",
        described("Of a sequence of base surfaces (base_####.ply, or base.ply with --cache) or a model: "
                  "which; default all. Key frames of all are solved, whichever are asked for."));
    options.add(
        "--follow", follow, "LENGTH",
        described("Of a model: what is shorter than this is handed to the waves; 0: nothing. Default: 8 mean "
                  "edges of the rest shape for simulations and caches, 4 for skins and morphs"));
    options.add(
        "--tension-limit", tension_limit, "X",
        described("Of a model: stretch that counts as the cloth's tension, as twice the Green strain; "
                  "what a rig stretches beyond is none. Default .05; 0: all of it"));
    options.add("--fabric", fabric, "B,E|NAME", "Of a model: its fabric, as for 'plisse size'");
    options.add(
        "--wavelength", wavelength, "LENGTH",
        described("Of a model without --fabric: how long its waves are, in the median; default: three mean "
                  "edges of the rest shape"));
    options.add("--body", bodies, Values::all_given, "MESH|MATERIAL|FILE",
                described("Of a model: what its cloth stays outside of, base surfaces and waves: meshes or "
                          "materials of it, or files of models that move with it"));
    options.add("--rest", rest, "bind|frame:N|uv|FILE", "Of a model: its rest shape, as for 'plisse render'");
    options.add("--clip", clip, "NAME|INDEX", "Of a model: the animation to play");
    options.add("--only", only, Values::all_given, "NAME", "Of a model: only these meshes or materials");
    options.add("--exclude", exclude, Values::all_given, "NAME",
                "Of a model: all but these meshes or materials");
    options.add("--cache", cache, "FILE", "A point cache that moves BASE.ply: .pc2 or .mdd");
    options.add("--fade", fade, "FRAMES",
                described("Over a sequence: how many frames show both fields where the number of waves "
                          "changes (default 6)"));
    options.add("--quality", quality, "draft|final",
                described("Over a sequence: frames between keys are interpolated (draft), or also solved "
                          "(final, the default)"));
    options.add("--example", example, "NAME",
                "A built-in scene instead; 'plisse drape --list-examples' names them");
    options.add("--vertices", vertices, "N", "About how many vertices an example's mesh has");
    options.add("--seed", seed, "S", "Another seed, another mesh of the same example (default 1)");
    options.add("-o,--output", output, "FILE",
                described("field.ply (the default; field_####.ply of a sequence), or NAME_amplitude_REST.txt "
                          "for the authors' three text files; of a model a folder, for base_####.ply, "
                          "field_####.ply and the scene that draws them"));
    options.add("--mesh", mesh, "FILE",
                described("The waves as geometry, too: .ply, .obj or .glb, with normals and uv"));
    options.add("--levels", levels, "N",
                described("Halve the mesh's edges this often for --mesh; default: as often as the waves "
                          "need. Allowed: 0 … 8."));
    options.flag("--mesh-v1", mesh_v1,
                 "Waves of --mesh lean with the surface's curvature (v1), which hardly shows");
    options.add("--wrinkle-free", rule, "paper|authors",
                described("Which faces have no waves: by the paper's rule (the default) or its authors' "
                          "program's"));
    options.flag(
        "--free-held", free_held,
        "Waves also where the surface was held while draping; without it their amplitude is 0 there");
    options.add("--without", without, Values::all_given, "v1|v2|relaxation|chords|noise",
                described("Leave something out, to see what it does: v1 (waves lean with the surface's "
                          "curvature), v2 (waves bulge sideways), relaxation (phases need not close "
                          "where there are no waves), chords (what facets of a curved surface lack in "
                          "length is no compression) or noise (compression below rounding seeds no "
                          "waves); may be given more than once"));
    options.add("--curvature", curvature, "EDGES|mid-edge",
                described("From quadratics fitted over so many edges round a vertex (default 2), or mid-edge "
                          "normals"));
    options.add("--curvature-factor", factor, "X",
                described("Multiplies the curvature term; 1.44 is what the authors' program has"));
    options.add("--frequency", frequency, "X", "Start with waves so many times as dense (default 1)");
    options.flag(
        "--starts", all_starts,
        described(
            "Start with waves .5, .7, 1.4 and 2 times as dense, too, and take the lowest energy, patch by "
            "patch"));
    options.flag(
        "--local-law", local_law,
        described(
            "Wavelengths by Vandeparre's law of the distance from where the surface is held, and nothing "
            "solved, to see what the solve is for"));
    options.flag(
        "--crest-compression", crest_compression,
        described("Let compression along the crests count where there is some both ways, as the paper's "
                  "energy has it; without, it costs nothing"));
    options.add("--cost", cost, "N,N,…",
                described("Solve an example at each of these sizes, separated by commas, three times, and "
                          "plot what it costs: -o cost.svg"));
    options.add("--iterations", iterations, "N", "At most so many Newton steps (default 500)");
    options.add("--evaluate", evaluate, Values::two, "AMPLITUDE DPHI",
                described("Solve nothing: the energy of a field in two text files, an amplitude a vertex and "
                          "a difference of phase an edge"));
  }

  CommonArguments common;
  CacheArguments solved;
  std::string input, frames, cache, fade = "6", quality = "final", example, vertices, seed, output, mesh,
                                    levels, rule = "paper", curvature = "2", factor = "1", frequency = "1",
                                    iterations = "500", cost, follow, tension_limit, fabric, wavelength, rest,
                                    clip;
  std::vector<std::string> without, evaluate, only, exclude, bodies;
  bool free_held = false, mesh_v1 = false, all_starts = false, crest_compression = false, local_law = false;
};

double number_in(const std::string& option, const std::string& text, double low, double high) {
  const auto value = parse_number(text);
  if (!value || !(*value >= low && *value <= high))
    throw Error(ExitCode::bad_input,
                fmt::format("{}: '{}' is not a number from {} to {}", option, text, low, high));
  return *value;
}

void one_of(const std::string& option, const std::string& text, const std::vector<std::string>& allowed) {
  if (std::find(allowed.begin(), allowed.end(), text) == allowed.end())
    throw Error(ExitCode::bad_input,
                fmt::format("{}: unknown '{}'{}; there are {}", option, text,
                            config::did_you_mean(text, allowed), fmt::join(allowed, " and ")));
}

cloth::WrinkleScene scene_of(const Arguments& arguments) {
  if (arguments.input.empty() == arguments.example.empty())
    throw Error(
        ExitCode::bad_input,
        "plisse wrinkle: give a BASE.ply, a SCENE.toml, a SETUP.json or --example NAME; see 'plisse wrinkle "
        "--help'");
  if (!arguments.example.empty()) {
    const int vertices =
        arguments.vertices.empty() ? 0 : whole_number("--vertices", arguments.vertices, 20, 1000000);
    const int seed = arguments.seed.empty() ? 1 : whole_number("--seed", arguments.seed, 0, 2147483647);
    return cloth::base_of(cloth::drape_example(arguments.example, vertices, static_cast<std::uint32_t>(seed)),
                          arguments.solved.folder());
  }
  if (!arguments.vertices.empty() || !arguments.seed.empty())
    throw Error(ExitCode::bad_input, "--vertices and --seed are for --example: a file has its own mesh");
  if (std::filesystem::path(arguments.input).extension() == ".ply") return cloth::read_base(arguments.input);
  return cloth::base_of(cloth::load_drape(arguments.input), arguments.solved.folder());
}

bool is_sequence(const Arguments& arguments) {
  return !arguments.cache.empty() || (config::is_frame_pattern(arguments.input) &&
                                      std::filesystem::path(arguments.input).extension() == ".ply");
}

// But for the scene.
cloth::WrinkleRequest request_of(const Arguments& arguments) {
  cloth::WrinkleRequest request;
  one_of("--wrinkle-free", arguments.rule, {"paper", "authors"});
  request.rule =
      arguments.rule == "paper" ? wrinkle::WrinkleFreeRule::paper : wrinkle::WrinkleFreeRule::authors;
  for (const std::string& term : arguments.without) {
    one_of("--without", term, {"v1", "v2", "relaxation", "chords", "noise"});
    (term == "v1"           ? request.v1
     : term == "v2"         ? request.v2
     : term == "relaxation" ? request.relaxed_integrability
     : term == "chords"     ? request.chords
                            : request.noise) = false;
  }
  if (arguments.curvature == "mid-edge")
    request.curvature.kind = wrinkle::CurvatureFit::mid_edge;
  else
    request.curvature.edges = whole_number("--curvature", arguments.curvature, 1, 20);
  request.curvature_factor = number_in("--curvature-factor", arguments.factor, 0, 1e6);
  request.options.frequency = number_in("--frequency", arguments.frequency, 1e-3, 1e3);
  request.options.solve.max_iterations = whole_number("--iterations", arguments.iterations, 0, 1000000);
  request.options.all_starts = arguments.all_starts;
  request.options.local_law = arguments.local_law;
  if (arguments.local_law && (is_sequence(arguments) || arguments.free_held))
    throw Error(ExitCode::bad_input,
                "--local-law is for one surface, and counts from where it is held: leave out the sequence "
                "and --free-held");
  request.crest_compression = arguments.crest_compression;
  request.pin_held = !arguments.free_held;
  request.output = !arguments.output.empty() ? arguments.output
                   : is_sequence(arguments)  ? "field_####.ply"
                                             : "field.ply";
  request.mesh = arguments.mesh;
  request.cache = arguments.solved.folder();
  if (request.mesh.empty() && (arguments.mesh_v1 || !arguments.levels.empty()))
    throw Error(ExitCode::bad_input, "--levels and --mesh-v1 are for geometry: name its file with --mesh");
  if (!arguments.levels.empty()) request.levels = whole_number("--levels", arguments.levels, 0, most_levels);
  request.mesh_v1 = arguments.mesh_v1;
  return request;
}

ordered_json to_json(const cloth::WrinkleReport& report) {
  const wrinkle::Field& field = report.field;
  ordered_json trace = ordered_json::array(), starts = ordered_json::array(), outputs = ordered_json::array();
  for (const wrinkle::FieldStart& start : field.starts)
    starts.push_back({{"frequency", start.frequency},
                      {"energy_start_J", start.start_energy},
                      {"energy_J", start.energy},
                      {"iterations", start.iterations},
                      {"converged", start.converged}});
  for (const wrinkle::SolveStep& step : field.trace)
    trace.push_back({{"iteration", step.iteration}, {"seconds", step.seconds}, {"energy_J", step.energy}});
  for (const cloth::WrinkleOutput& output : report.outputs)
    outputs.push_back({{"path", output.path.string()}, {"kind", output.kind}});
  return {{"vertices", report.vertices},
          {"faces", report.faces},
          {"wrinkle_free_faces", report.wrinkle_free_faces},
          {"released_faces", report.released_faces},
          {"energy_start_J", field.real.start_energy},
          {"energy_J", field.real.energy},
          {"energy_whole_periods_J", field.whole.energy},
          {"kkt_scaled", field.real.kkt},
          {"iterations", field.iterations},
          {"solves", field.solves},
          {"factorisations", field.factorisations},
          {"converged", field.real.converged && field.whole.converged},
          {"reason", field.real.converged ? field.whole.reason : field.real.reason},
          {"max_amplitude_m", report.max_amplitude},
          {"wrinkled_vertices", report.wrinkled_vertices},
          {"waves", field.waves},
          {"waves_round", field.count.round},
          {"waves_length_m", field.count.length},
          {"waves_above_tenth", field.above_tenth.waves},
          {"wavelength_m", field.wavelength},
          {"periods", field.whole.waves.period.size()},
          {"phase_residual", field.phase_residual},
          {"solve_s", field.solve_s},
          {"phase_s", field.phase_s},
          {"upsample_s", report.upsample_s},
          {"wall_s", report.wall_s},
          {"outputs", outputs},
          {"starts", starts},
          {"trace", trace}};
}

std::string_view name_of(wrinkle::FrameKind kind) {
  switch (kind) {
    case wrinkle::FrameKind::flat:
      return "flat";
    case wrinkle::FrameKind::anchor:
      return "anchor";
    case wrinkle::FrameKind::key:
      return "key";
    case wrinkle::FrameKind::between:
      return "between";
    case wrinkle::FrameKind::still:
      break;
  }
  return "still";
}

ordered_json to_json(const cloth::WrinkleSequenceReport& report) {
  ordered_json outputs = ordered_json::array(), frames = ordered_json::array(),
               changes = ordered_json::array();
  for (const auto& output : report.outputs)
    outputs.push_back({{"path", output.path.string()}, {"kind", output.kind}, {"frame", output.frame}});
  for (const cloth::WrinkleSequenceFrame& frame : report.frames) {
    const wrinkle::SequenceFrame& solved = frame.solved;
    if (solved.waves_before)
      changes.push_back({{"frame", frame.frame}, {"from", *solved.waves_before}, {"to", solved.waves}});
    frames.push_back({{"frame", frame.frame},
                      {"waves", solved.waves},
                      {"kind", name_of(solved.kind)},
                      {"share", solved.share},
                      {"strain_change", solved.change},
                      {"phase_step_rad", frame.phase_step ? ordered_json(*frame.phase_step) : ordered_json()},
                      {"max_amplitude_m", frame.max_amplitude},
                      {"compression", frame.taken.compression},
                      {"untaken", frame.taken.untaken},
                      {"crest_angle_deg", 180 / std::numbers::pi * frame.taken.crest_angle},
                      {"where_compressed", frame.taken.where_compressed},
                      {"wavelength_m", frame.taken.wavelength},
                      {"wrinkle_free_faces", frame.wrinkle_free_faces},
                      {"energy_J", solved.energy},
                      {"excess_over_alone", solved.excess ? ordered_json(*solved.excess) : ordered_json()},
                      {"iterations", solved.iterations},
                      {"converged", solved.converged},
                      {"reason", solved.reason},
                      {"solve_s", solved.solve_s},
                      {"upsample_s", frame.upsample_s}});
  }
  return {{"vertices", report.vertices},
          {"faces", report.faces},
          {"converged", report.converged},
          {"interrupted", report.interrupted},
          {"keys", report.keys},
          {"spans", report.spans},
          {"changes", changes},
          {"frames", frames},
          {"wall_s", report.wall_s},
          {"outputs", outputs}};
}

cloth::WrinkleSequenceRequest sequence_request_of(const Arguments& arguments, cloth::WrinkleRequest each) {
  cloth::WrinkleSequenceRequest request;
  request.each = std::move(each);
  request.fade = whole_number("--fade", arguments.fade, 0, 1000);
  if (arguments.quality != "draft" && arguments.quality != "final")
    throw Error(ExitCode::bad_input,
                fmt::format("--quality: '{}' is neither draft nor final", arguments.quality));
  request.quality = arguments.quality == "draft" ? wrinkle::Quality::draft : wrinkle::Quality::final;
  return request;
}

cloth::WrinkleSequenceReport solve_sequence(const Arguments& arguments,
                                            cloth::WrinkleSequenceRequest& request) {
  install_interrupt_handlers();
  cloth::WrinkleSequenceReport report;
  {
    Progress progress(Progress::style_for_stderr(arguments.common.quiet()));
    request.progress = [&](bool keys, int done, int of) {
      progress.update(done, of, keys ? "key frames solved" : "solved");
    };
    report = cloth::wrinkle_sequence(request);
  }
  for (const cloth::WrinkleSequenceFrame& frame : report.frames) {
    const wrinkle::SequenceFrame& solved = frame.solved;
    if (!solved.converged)
      log::notice(fmt::format("frame {}: NOT CONVERGED: {}", frame.frame, solved.reason));
    if (solved.waves_before)
      log::notice(fmt::format("frame {}: {:.4g} waves become {:.4g}", frame.frame, *solved.waves_before,
                              solved.waves));
  }
  if (report.frames.empty()) return report;  // interrupted while the keys were solved
  const auto& last = report.frames.back();
  log::notice(fmt::format("{} frames in {:.2f} s; {} vertices, at last {:.4g} waves, at most {:.4g} mm high",
                          report.frames.size(), report.wall_s, report.vertices, last.solved.waves,
                          1e3 * last.max_amplitude));
  return report;
}

int run_sequence(const Arguments& arguments, cloth::WrinkleRequest each) {
  if (!arguments.example.empty() || !arguments.evaluate.empty())
    throw Error(ExitCode::bad_input, "--example and --evaluate are for one base surface, not for a sequence");
  cloth::WrinkleSequenceRequest request = sequence_request_of(arguments, std::move(each));
  request.bases = arguments.input;
  request.cache = arguments.cache;
  request.frames = arguments.frames;
  const cloth::WrinkleSequenceReport report = solve_sequence(arguments, request);
  write_report(to_json(report), arguments.common.json());
  if (report.interrupted) return 128 + signal_number();
  return static_cast<int>(report.converged ? ExitCode::fine : ExitCode::check_failed);
}

// Of the scene's own keys, as 'plisse render' has them.
config::GivenOptions scene_options_of(const Arguments& arguments) {
  config::GivenOptions given;
  for (const auto& [name, value] : {std::pair{"--rest", &arguments.rest},
                                    {"--clip", &arguments.clip},
                                    {"--cache", &arguments.cache},
                                    {"--frames", &arguments.frames},
                                    {"--follow", &arguments.follow},
                                    {"--tension-limit", &arguments.tension_limit},
                                    {"--wavelength", &arguments.wavelength},
                                    {"--fabric", &arguments.fabric}})
    if (!value->empty()) given.emplace_back(name, std::vector<std::string>{*value});
  if (!arguments.only.empty()) given.emplace_back("--only", arguments.only);
  if (!arguments.exclude.empty()) given.emplace_back("--exclude", arguments.exclude);
  if (!arguments.bodies.empty()) given.emplace_back("--body", arguments.bodies);
  return given;
}

cloth::FollowRequest follow_request_of(const Arguments& arguments) {
  cloth::FollowRequest request;
  request.scene = config::open_scene(arguments.input);
  config::apply_options(request.scene, scene_options_of(arguments));
  if (!arguments.fabric.empty()) {
    if (!arguments.wavelength.empty())
      throw Error(ExitCode::bad_input,
                  "--fabric and --wavelength: a fabric has waves of its own length; give one");
    request.scene.wrinkles.wavelength = 0;
  }
  request.cache = arguments.solved.folder();
  return request;
}

// An animated model: base surfaces that follow it, then fields on them.
int run_model(const Arguments& arguments, cloth::WrinkleRequest each) {
  refuse_without_effect({{"--vertices", !arguments.vertices.empty()},
                         {"--seed", !arguments.seed.empty()},
                         {"--example", !arguments.example.empty()},
                         {"--evaluate", !arguments.evaluate.empty()},
                         {"--local-law", arguments.local_law},
                         {"--free-held", arguments.free_held}},
                        "for a model, of which nothing is draped or held");
  const std::filesystem::path folder = arguments.output, scene = folder / "scene.toml";
  const std::vector<std::string> files = {".ply", ".txt", ".obj", ".glb", ".svg", ".png", ".toml"};
  const bool a_file = std::filesystem::exists(folder)
                          ? !std::filesystem::is_directory(folder)
                          : std::find(files.begin(), files.end(), folder.extension().string()) != files.end();
  if (folder.empty() || a_file)
    throw Error(
        ExitCode::bad_input,
        fmt::format(
            "-o {}: of a model base surfaces and fields are written into a folder, and this is {}: name "
            "one, such as 'waves'",
            folder.empty() ? "is missing" : "'" + folder.string() + "'", folder.empty() ? "none" : "a file"));
  if (!each.mesh.empty() && !config::is_frame_pattern(each.mesh.string()))
    throw Error(
        ExitCode::bad_input,
        fmt::format("--mesh {}: one file for all frames of a model; give it a place for the number: '{}'",
                    each.mesh.string(),
                    each.mesh.stem().string() + "_####" + each.mesh.extension().string()));
  // All that can be wrong with what was asked for is told before the long part.
  cloth::WrinkleSequenceRequest request = sequence_request_of(arguments, std::move(each));
  cloth::FollowRequest follow = follow_request_of(arguments);
  if (follow.scene.solve.quality == config::SolveQuality::draft) request.quality = wrinkle::Quality::draft;
  if (follow.scene.solve.method != config::SolveMethod::direct)
    log::warn("method of [solve] has no effect on 'plisse wrinkle', which writes fields");
  check_writable(scene);
  install_interrupt_handlers();
  cloth::FollowReport followed;
  {
    Progress progress(Progress::style_for_stderr(arguments.common.quiet()));
    follow.progress = [&](int done, int of) { progress.update(done, of, "followed"); };
    followed = cloth::follow_model(follow);
  }
  if (followed.interrupted) return 128 + signal_number();
  const cloth::WrinkleScene& first = followed.first;
  log::notice(fmt::format(
      "{} vertices in {} shell{}: {} shorter than {:.3g} m is handed to waves; cloth of {:.3g} mm",
      first.surface.topology.vertex_count, followed.shells, followed.shells == 1 ? "" : "s",
      followed.follow > 0 ? "what is" : "nothing", followed.follow, 1e3 * first.material.thickness));
  request.each.scene = first;
  request.each.output = folder / "field_####.ply";
  // Frames between those picked are written as well, so that the folder can be played.
  const std::vector<int> picked =
      config::select_frames(follow.scene.model.frames, static_cast<int>(followed.frames.size()));
  request.frames = fmt::format("{}-{}", picked.front(), picked.back());
  if (!first.look->lost.empty())
    log::warn(fmt::format("files of base surfaces do not keep the model's {}; 'plisse render --solve' does",
                          fmt::join(first.look->lost, " and ")));
  ordered_json outputs = ordered_json::array();
  const std::vector<std::string> pictures = cloth::write_pictures(*first.look, folder);
  for (const std::string& picture : pictures)
    outputs.push_back({{"path", (folder / picture).string()}, {"kind", "picture"}});
  bool converged = true;
  for (int number = picked.front(); number <= picked.back(); ++number) {
    const auto n = static_cast<std::size_t>(number - 1);
    const cloth::FollowedFrame& frame = followed.frames[n];
    converged = converged && frame.converged;
    if (!frame.converged) log::warn(fmt::format("frame {}: its base surface did not converge", frame.frame));
    const auto path =
        std::filesystem::path(config::numbered_path((folder / "base_####.ply").string(), frame.frame));
    request.each.scene.surface.positions = followed.bases[n];
    if (!followed.room.empty()) request.each.scene.room = followed.room[n];
    cloth::write_base(
        path, fmt::format("plisse wrinkle {} frame {}", first.name, frame.frame), request.each.scene,
        frame.converged ? "" : "no step lowers its energy any more, or too many were needed", pictures);
    outputs.push_back({{"path", path.string()}, {"kind", "base"}, {"frame", frame.frame}});
  }
  if (followed.strained != followed.bases)
    log::warn(
        "shells that are scaled as a whole are strained in files of base surfaces; 'plisse render --solve' "
        "leaves that out");
  request.poses = std::move(followed.bases);
  request.room = std::move(followed.room);
  const cloth::WrinkleSequenceReport report = solve_sequence(arguments, request);
  if (report.interrupted) return 128 + signal_number();
  std::size_t others = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool ours = std::any_of(outputs.begin(), outputs.end(), [&](const ordered_json& output) {
      return std::filesystem::path(output["path"].get<std::string>()).filename() == name;
    });
    if (name.starts_with("base_") && name.ends_with(".ply") && !ours) ++others;
  }
  if (others > 0)
    log::warn(fmt::format(
        "{}: {} base surfaces of other frames or runs lie there already, and its scene draws them "
        "as well",
        folder.string(), others));
  write_whole_file(scene, "# plisse render " + scene.string() +
                              " -o frames\n[model]\npath = \"base_####.ply\"\n[bias]\nfield = "
                              "\"field_####.ply\"\nuse = \"direct\"\n");
  log::notice(fmt::format("→ {}", scene.string()));
  ordered_json json = to_json(report);
  for (const ordered_json& output : json["outputs"]) outputs.push_back(output);
  outputs.push_back({{"path", scene.string()}, {"kind", "scene"}});
  json["outputs"] = outputs;
  json["converged"] = converged && report.converged;
  json["shells"] = followed.shells;
  json["follow_m"] = followed.follow;
  json["thickness_m"] = first.material.thickness;
  for (ordered_json& entry : json["frames"]) {
    const cloth::FollowedFrame& frame =
        followed.frames[static_cast<std::size_t>(entry["frame"].get<int>() - 1)];
    entry["moved_rms_m"] = frame.moved_rms;
    entry["moved_most_m"] = frame.moved_most;
    entry["length_kept"] = frame.length_kept;
    entry["follow_iterations"] = frame.iterations;
    entry["follow_converged"] = frame.converged;
    if (frame.nearest_body > 0) {
      entry["nearest_body_m"] = frame.nearest_body;
      entry["brought_out"] = frame.brought_out;
    }
    entry["follow_s"] = frame.seconds;
  }
  write_report(json, arguments.common.json());
  return static_cast<int>(converged && report.converged ? ExitCode::fine : ExitCode::check_failed);
}

// Whether the input is an animated model, or a scene with one, and no base surface or drape scene.
bool is_model(const Arguments& arguments) {
  if (arguments.input.empty()) return false;
  const std::filesystem::path input = arguments.input;
  std::string ending = input.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending == ".json") return false;
  if (ending == ".toml") return !config::is_drape_file(input);
  if (ending == ".ply")
    return !cloth::is_base(config::is_frame_pattern(input.string()) ? io::sequence_files(input).front()
                                                                    : input);
  return true;
}

int run_costs(Arguments arguments, const cloth::WrinkleRequest& request) {
  const std::vector<int> sizes = whole_numbers("--cost", arguments.cost, 20, 1000000);
  if (arguments.example.empty() || request.output.extension() != ".svg")
    throw Error(ExitCode::bad_input,
                "--cost solves an --example at sizes of its own, and writes -o FILE.svg");
  refuse_without_effect({{"--vertices", !arguments.vertices.empty()},
                         {"--frames", !arguments.frames.empty()},
                         {"--cache", !arguments.cache.empty()},
                         {"--fade", arguments.fade != "6"},
                         {"--quality", arguments.quality != "final"},
                         {"--mesh", !arguments.mesh.empty()},
                         {"--evaluate", !arguments.evaluate.empty()},
                         {"--cache-dir", arguments.solved.given()}},
                        "beside --cost, which solves anew at sizes of its own");
  check_writable(request.output);
  install_interrupt_handlers();
  const auto costs = bench::wrinkle_costs(
      request,
      [&](int vertices) {
        arguments.vertices = std::to_string(vertices);
        return scene_of(arguments);
      },
      sizes,
      [](const bench::WrinkleCost& cost) {
        log::notice(fmt::format("{} vertices: {:.4g} waves, {} steps, {:.3g} s ({:.3g} s of CPU time){}",
                                cost.vertices, cost.waves, cost.iterations, cost.wall_s, cost.cpu_s,
                                cost.converged ? "" : ", NOT CONVERGED"));
      });
  if (interrupted()) return 128 + signal_number();
  bench::plot_costs(request.output, arguments.example, costs);
  log::notice(fmt::format("→ {}", request.output.string()));
  ordered_json json = {{"example", arguments.example}, {"costs", ordered_json::array()}};
  bool converged = true;
  for (const bench::WrinkleCost& cost : costs) {
    converged = converged && cost.converged;
    json["costs"].push_back({{"vertices", cost.vertices},
                             {"waves", cost.waves},
                             {"max_amplitude_m", cost.max_amplitude},
                             {"energy_whole_periods_J", cost.energy},
                             {"iterations", cost.iterations},
                             {"converged", cost.converged},
                             {"solve_s", cost.solve_s},
                             {"phase_s", cost.phase_s},
                             {"wall_s", cost.wall_s},
                             {"cpu_s", cost.cpu_s}});
  }
  json["outputs"] = {{{"path", request.output.string()}, {"kind", "plot"}}};
  write_report(json, arguments.common.json());
  return static_cast<int>(converged ? ExitCode::fine : ExitCode::check_failed);
}

int run_wrinkle(Arguments& arguments) {
  arguments.common.apply();
  cloth::WrinkleRequest request = request_of(arguments);
  if (!arguments.cost.empty()) return run_costs(arguments, request);
  if (is_model(arguments)) return run_model(arguments, std::move(request));
  refuse_without_effect({{"--follow", !arguments.follow.empty()},
                         {"--tension-limit", !arguments.tension_limit.empty()},
                         {"--fabric", !arguments.fabric.empty()},
                         {"--wavelength", !arguments.wavelength.empty()},
                         {"--rest", !arguments.rest.empty()},
                         {"--clip", !arguments.clip.empty()},
                         {"--only", !arguments.only.empty()},
                         {"--exclude", !arguments.exclude.empty()},
                         {"--body", !arguments.bodies.empty()}},
                        "on a base surface or a drape scene: they are for models");
  if (is_sequence(arguments)) return run_sequence(arguments, std::move(request));
  if (!arguments.frames.empty())
    throw Error(ExitCode::bad_input, "--frames is for sequences: base_####.ply, or base.ply with --cache");
  request.scene = scene_of(arguments);
  if (!arguments.evaluate.empty()) {
    const cloth::WrinkleEvaluation evaluation =
        cloth::evaluate_field(request, arguments.evaluate[0], arguments.evaluate[1]);
    log::notice(fmt::format("{:.10g} J, scaled residual {:.3g}, largest curl {:.3g} rad", evaluation.energy,
                            evaluation.kkt, evaluation.curl_max));
    write_report(
        {{"energy_J", evaluation.energy}, {"kkt_scaled", evaluation.kkt}, {"curl_max", evaluation.curl_max}},
        arguments.common.json());
    return 0;
  }
  const cloth::WrinkleReport report = cloth::wrinkle_field(request);
  const wrinkle::Field& field = report.field;
  const bool converged = field.real.converged && field.whole.converged;
  log::notice(
      fmt::format("{}{} vertices, {} of {} faces without waves: {:.4g} waves, at most {:.4g} mm high, "
                  "{:.9g} J after {} steps ({}) in {:.3f} s",
                  converged ? "" : "NOT CONVERGED, ", report.vertices, report.wrinkle_free_faces,
                  report.faces, field.waves, 1e3 * report.max_amplitude, field.whole.energy, field.iterations,
                  field.real.reason, report.wall_s));
  if (report.max_amplitude == 0) log::notice("nothing wrinkles: no face is compressed enough");
  for (const cloth::WrinkleOutput& output : report.outputs)
    log::notice(fmt::format("→ {}", output.path.string()));
  ordered_json json = to_json(report);
  json.update(reused_json(report.from_cache ? 1 : 0, report.saved_s));
  write_report(json, arguments.common.json());
  return static_cast<int>(converged ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace

void add_wrinkle(CommandLine& line) {
  CommandOptions& options = line.command(
      "wrinkle", "Solve amplitude and phase of the wrinkles on a base surface",
      "\nplisse drape --example twisted-cylinder -o base.ply && plisse wrinkle base.ply -o field.ply\n"
      "A scene whose model is base.ply takes it up with [bias] field = \"field.ply\", use = \"direct\".\n"
      "plisse wrinkle base_####.ply -o field_####.ply --mesh waves_####.ply    over time: waves glide, not "
      "pop");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_wrinkle(*arguments); };
}

}  // namespace plisse::cli
