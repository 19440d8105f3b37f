#include "cli/arguments.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "cli/report.h"
#include "config/options.h"
#include "config/scene_file.h"
#include "gpu/context.h"

namespace plisse::cli {
double positive_number(const std::string& option, const std::string& text) {
  const auto number = parse_number(text);
  if (!number || !std::isfinite(*number) || *number <= 0)
    throw Error(ExitCode::bad_input, fmt::format("{}: '{}' is no number above 0", option, text));
  return *number;
}

int whole_number(const std::string& option, const std::string& text, int low, int high) {
  int value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc{} || stop != end || value < low || value > high) {
    throw Error(ExitCode::bad_input,
                fmt::format("{}: '{}' is no whole number; allowed: {} … {}", option, text, low, high));
  }
  return value;
}

std::vector<int> whole_numbers(const std::string& option, const std::string& text, int low, int high) {
  std::vector<int> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    numbers.push_back(whole_number(option, text.substr(at, comma - at), low, high));
    at = comma + 1;
  }
  return numbers;
}

void refuse_without_effect(std::initializer_list<GivenOption> options, const std::string& why) {
  for (const GivenOption& option : options)
    if (option.given) throw Error(ExitCode::bad_input, fmt::format("{}: has no effect {}", option.name, why));
}

CommonArguments::CommonArguments(CommandOptions& options) {
  options.add("--threads", threads_, "N", "Threads of the CPU to use at most");
  options.flag("-q,--quiet", quiet_, "Errors only");
  options.flag("-v,--verbose", verbose_, "Say more on standard error");
  options.add("--json", json_, "FILE", "Write the report to a file, or to standard output for '-'");
}

void CommonArguments::apply() {
  if (quiet_ && verbose_) throw Error(ExitCode::bad_input, "--quiet and --verbose exclude each other");
  log::set_level(quiet_ ? log::Level::quiet : verbose_ ? log::Level::verbose : log::Level::normal);
  if (threads_.empty()) return;
  const int threads = whole_number("--threads", threads_, 1, 1024);
  thread_limit_ = std::make_shared<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                        static_cast<std::size_t>(threads));
  // llvmpipe starts threads of its own when the context is made; 0 lets it rasterise in the caller's.
  setenv("LP_NUM_THREADS", threads == 1 ? "0" : std::to_string(threads).c_str(), 0);
}

SceneArguments::SceneArguments(CommandOptions& options, const Wanted& wanted) : command_(options.command()) {
  options.add(
      "input", input_, "SCENE.toml|MODEL",
      described("A scene file, or a model: a file, a numbered sequence (drape_####.obj) or its folder; or a "
                "panel file (docs/sizing.md)"));
  std::string table;
  for (const config::SceneOption& option : config::scene_options()) {
    if (!wanted(option.name)) continue;
    if (option.table == "solve" && table != "solve") {
      options.set_headline("[solve], overriding the scene's keys");
      options.flag("--solve", solve_,
                   described("Solve wrinkles before drawing: base surfaces that follow the model, and the "
                             "waves that their cloth takes"));
    }
    table = option.table;
    Given& given = given_.emplace_back(Given{option.name, {}});
    const std::string names = option.name == "--output" ? "-o,--output" : option.name;
    options.set_headline("[" + option.table + "], overriding the scene's keys");
    // One value each time the option is given, so that "--only shirt model.glb" means what it looks like.
    options.add(names, given.values, Values::one_each_time, option.value, described(option.help));
  }
  options.set_headline("");
}

config::SceneSettings SceneArguments::settings() const {
  if (input_.empty()) {
    throw Error(ExitCode::bad_input,
                fmt::format("plisse {0}: give a SCENE.toml or a MODEL; see 'plisse {0} --help'", command_));
  }
  config::SceneSettings scene = config::open_scene(input_);
  config::GivenOptions options;
  for (const Given& given : given_) {
    if (!given.values.empty()) options.emplace_back(given.option, given.values);
  }
  config::apply_options(scene, options);
  scene.solve.on = scene.solve.on || solve_;
  for (const config::SceneOption& option : config::scene_options()) {
    const auto given = std::find_if(options.begin(), options.end(),
                                    [&](const auto& entry) { return entry.first == option.name; });
    if (option.table == "solve" && given != options.end() && !scene.solve.on)
      throw Error(ExitCode::bad_input,
                  fmt::format("{}: goes with --solve, or with the table [solve] of a scene", option.name));
  }
  if (solve_ && !(scene.bias.field.empty() && scene.bias.file.empty() && scene.bias.paint.empty()))
    throw Error(ExitCode::bad_input,
                "--solve: the scene has wrinkles of its own in [bias], whose place solved ones would take");
  if (scene.solve.on && !scene.solve.fabric.empty() && scene.wrinkles.wavelength > 0)
    throw Error(ExitCode::bad_input,
                "--fabric and --wavelength: a fabric has waves of its own length; give one");
  return scene;
}

bool decides_geometry(const std::string& option) {
  constexpr std::string_view of_pictures[] = {"--camera", "--output", "--size", "--samples", "--background"};
  return std::find(std::begin(of_pictures), std::end(of_pictures), option) == std::end(of_pictures);
}

DeviceArguments::DeviceArguments(CommandOptions& options) {
  options.add("--device", device_, "N", "The device to draw with, as --list-devices numbers them");
  options.flag("--list-devices", list_, "List the devices and end");
}

void DeviceArguments::list() const {
  std::string text;
  for (const std::string& line : gpu::list_devices()) text += line + "\n";
  write_stdout(text.empty() ? "EGL names no device\n" : text);
}

int DeviceArguments::device() const {
  return device_.empty() ? -1 : whole_number("--device", device_, 0, 255);
}

pipeline::FrameCallback frame_progress(Progress& progress) {
  return [&progress](int done, int total, const pipeline::FrameReport& frame) {
    std::string what = frame.path.empty() ? fmt::format("frame {}", frame.frame) : frame.path;
    if (!frame.error.empty()) what = fmt::format("frame {} failed: {}", frame.frame, frame.error);
    if (frame.skipped) what += " (skipped)";
    progress.update(done, total, what);
  };
}

}  // namespace plisse::cli
