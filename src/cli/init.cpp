// plisse init: a commented scene file for a model, which renders as the bare model does.

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "config/scene_file.h"
#include "io/import.h"
#include "scene/animation.h"
#include "scene/wrinkles.h"

namespace plisse::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options) : common(options) {
    options.add("model", model, "MODEL",
                described("A model: a file, a numbered sequence (drape_####.obj) or its folder"));
    options.add("-o,--output", output, "SCENE.toml",
                "The scene file to write; by default the model's name with .toml, here");
    options.flag("--overwrite", overwrite, "Replace a scene file that exists");
    options.add("--limits", import_options.limits.factor, 1e-6, 1e6, "FACTOR",
                "Factor on what the model's file may ask for, as in a scene");
    options.hidden_flag("--keys-markdown", keys_markdown);  // makes docs/scene.md; not for users
  }

  CommonArguments common;
  std::string model, output;
  io::ImportOptions import_options;
  bool overwrite = false, keys_markdown = false;
};

// "models/Fox.glb" → "Fox.toml", "run/drape_####.obj" → "drape.toml", "run/" → "run.toml".
fs::path default_output(const std::string& model) {
  fs::path name = fs::path(model).lexically_normal();
  if (!name.has_filename()) name = name.parent_path();
  std::string stem = name.stem().string();
  stem = stem.substr(0, stem.find_first_of("#%{"));
  while (!stem.empty() && std::string("_-. ").find(stem.back()) != std::string::npos) stem.pop_back();
  return (stem.empty() ? "scene" : stem) + ".toml";
}

// The way from the scene's folder to the model; the absolute path where there is none.
std::string path_from_scene(const fs::path& model, const fs::path& scene) {
  std::error_code failure;
  // Absolute: the folder may not be there yet, and then a relative one leads nowhere.
  const fs::path folder = fs::absolute(scene).parent_path();
  const fs::path relative = fs::relative(model, folder, failure);
  return (failure || relative.empty() ? fs::absolute(model) : relative).generic_string();
}

// A name in quotes, without what a TOML comment must not hold.
std::string in_quotes(const std::string& name) {
  std::string text = ordered_json(name).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  for (char& c : text) c = c == '\x7f' ? '?' : c;
  return text;
}

template <typename Items, typename Describe>
std::string listed(const char* what, const Items& items, const Describe& describe) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!items[i].name.empty()) text += (text.empty() ? "" : ", ") + describe(i, items[i]);
  }
  return text.empty() ? "" : fmt::format("{} here: {}.", what, text);
}

// What this model has to choose from, beside the keys that choose.
std::map<std::string, std::string> notes_on(const io::Model& model) {
  std::map<std::string, std::string> notes;
  const scene::Animation animation(model, {});
  const auto named = [](std::size_t, const auto& item) { return in_quotes(item.name); };
  const auto numbered = [](std::size_t i, const auto& item) {
    return fmt::format("{} {}", i, in_quotes(item.name));
  };
  notes["model.clip"] = listed("Clips", model.clips, numbered);
  notes["camera.name"] = listed("Cameras", model.cameras, numbered);
  notes["wrinkles.only"] = listed("Meshes", model.meshes, named);
  notes["wrinkles.exclude"] = listed("Materials", model.materials, named);
  notes["model.frames"] = fmt::format("Frames here: 1 to {}.", animation.timeline().frame_count);
  notes["wrinkles.wavelength"] =
      fmt::format("From this mesh: {:.4g}.", scene::default_wavelength(animation.surface()));
  return notes;
}

int run_init(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.keys_markdown) {
    write_stdout(config::scene_reference_markdown());
    return 0;
  }
  const double start = wall_seconds();
  if (arguments.model.empty()) {
    throw Error(ExitCode::bad_input, "plisse init: give a MODEL; see 'plisse init --help'");
  }
  const fs::path scene =
      arguments.output.empty() ? default_output(arguments.model) : fs::path(arguments.output);
  if (lower_case(scene.extension().string()) != ".toml") {
    throw Error(ExitCode::bad_input,
                fmt::format("--output: '{}' is no scene file; end it in .toml", scene.string()));
  }
  std::error_code ignored;
  if (!arguments.overwrite && fs::exists(scene, ignored)) {
    throw Error(ExitCode::no_output,
                fmt::format("{}: stands there already; --overwrite replaces it", scene.string()));
  }
  const io::Model model = io::import_model(arguments.model, arguments.import_options);
  const std::string text = config::scene_text(path_from_scene(arguments.model, scene), notes_on(model));
  // A name that TOML cannot hold is to fail here, not at the next command. The model is looked up through the
  // scene's folder; where that cannot be made, writing says why.
  if (scene.has_parent_path()) fs::create_directories(scene.parent_path(), ignored);
  if (!ignored) config::parse_scene(text, scene);
  write_whole_file(scene, text);

  if (arguments.common.tables_wanted()) write_stdout(fmt::format("{}\n", scene.string()));
  write_report(
      {{"outputs", {{{"path", scene.string()}, {"kind", "scene"}}}}, {"wall_s", wall_seconds() - start}},
      arguments.common.json());
  return 0;
}

}  // namespace

void add_init(CommandLine& line) {
  CommandOptions& options =
      line.command("init", "Write a commented scene file for a model",
                   "\nThe scene renders as the bare model does; every key stands in it with its default.");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_init(*arguments); };
}

}  // namespace plisse::cli
