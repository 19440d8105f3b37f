#include "config/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string_view>

#include "base/error.h"
#include "base/units.h"
#include "config/given.h"
#include "config/keys.h"

namespace plisse::config {
namespace {

constexpr std::string_view camera_forms =
    "a camera of the model (name or index), \"azimuth,elevation[,focal]\" in degrees and mm, or "
    "\"eye=x,y,z;target=x,y,z\" in lengths, y up";

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    parts.emplace_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

// A value of the command line as TOML would have it: a number where the key wants one and it is one, else a
// text.
std::unique_ptr<toml::node> as_toml(const std::string& text, bool textual) {
  if (!textual) {
    std::int64_t whole = 0;
    const char* const end = text.data() + text.size();
    if (const auto [stop, failure] = std::from_chars(text.data(), end, whole);
        failure == std::errc{} && stop == end) {
      return std::make_unique<toml::value<std::int64_t>>(whole);
    }
    if (const auto number = parse_number(text)) return std::make_unique<toml::value<double>>(*number);
  }
  return std::make_unique<toml::value<std::string>>(text);
}

bool takes_several(const KeyText& key) {
  return key.type == "names";
}

void expect_one(const std::vector<std::string>& texts) {
  if (texts.size() > 1) throw Problem{fmt::format("given {} times", texts.size())};
}

void set(SceneSettings& scene, const SceneKey& key, const std::vector<std::string>& texts) {
  if (!takes_several(key)) expect_one(texts);
  if (texts.size() == 1) {
    key.set(scene, Given{*as_toml(texts.front(), key.textual)});
    return;
  }
  toml::array array;
  for (const std::string& text : texts) array.push_back(text);
  key.set(scene, Given{array});
}

// Sets one key of [camera] and says which part of the option was wrong.
void set_camera(SceneSettings& scene, std::string_view name, const toml::node& value) {
  const SceneKey& key = *config::find_key("camera", name);
  try {
    key.set(scene, Given{value});
  } catch (const Problem& problem) {
    throw Problem{fmt::format("{}: {}, not {}", name, problem.what, key.allowed), problem.hint};
  }
}

void set_eye_and_target(SceneSettings& scene, const std::string& text) {
  bool eye = false, target = false;
  for (const std::string& part : split(text, ';')) {
    const auto equals = part.find('=');
    const std::string name = part.substr(0, equals);
    bool* const seen = name == "eye" ? &eye : name == "target" ? &target : nullptr;
    if (!seen || *seen || equals == std::string::npos) {
      throw Problem{fmt::format("'{}' is neither one eye nor one target", part)};
    }
    *seen = true;
    toml::array point;
    for (const std::string& item : split(part.substr(equals + 1), ',')) {
      if (const auto number = parse_number(item)) {
        point.push_back(*number);
      } else {
        point.push_back(item);
      }
    }
    set_camera(scene, name, point);
  }
  if (!eye || !target) throw Problem{fmt::format("the {} is missing", eye ? "target" : "eye")};
  if (scene.camera.eye == scene.camera.target) throw Problem{"eye and target are the same point"};
  scene.camera.name.clear();
  scene.camera.explicit_pose = true;
}

void set_camera_option(SceneSettings& scene, const std::string& text) {
  if (text.starts_with("eye=") || text.starts_with("target=")) return set_eye_and_target(scene, text);
  std::vector<double> numbers;
  for (const std::string& part : split(text, ',')) {
    if (const auto number = parse_number(part)) numbers.push_back(*number);
  }
  const std::size_t parts = split(text, ',').size();
  if (parts > 1 && numbers.size() == parts) {
    if (parts > 3) throw Problem{fmt::format("{} numbers are too many", parts)};
    constexpr std::string_view names[] = {"azimuth", "elevation", "focal_length"};
    for (std::size_t i = 0; i < parts; ++i) set_camera(scene, names[i], toml::value<double>{numbers[i]});
    scene.camera.name.clear();
    scene.camera.explicit_pose = false;
    return;
  }
  if (text.empty()) throw Problem{"the name is empty"};
  set_camera(scene, "name", toml::value<std::string>{text});
  scene.camera.explicit_pose = false;
}

}  // namespace

const std::vector<SceneOption>& scene_options() {
  static const std::vector<SceneOption> all = [] {
    std::vector<SceneOption> options;
    bool camera = false;
    for (const SceneKey& key : config::keys()) {
      if (key.table == "camera" && !std::exchange(camera, true)) {
        options.push_back({"--camera", "CAMERA", fmt::format("The view: {}.", camera_forms), key.table});
      }
      if (key.extras.option.empty()) continue;
      const bool told =
          key.extras.option_value.find('|') != std::string::npos;  // the value's name says what is allowed
      const std::string help = takes_several(key) ? key.doc + " May be given several times."
                               : told             ? key.doc
                                                  : fmt::format("{} Allowed: {}.", key.doc, key.allowed);
      options.push_back({key.extras.option, key.extras.option_value, help, key.table});
    }
    return options;
  }();
  return all;
}

void apply_options(SceneSettings& scene, const GivenOptions& options) {
  std::string wrong;
  const auto complain = [&](const std::string& option, const Problem& problem, std::string_view allowed) {
    wrong += fmt::format("{}{}: {}; allowed: {}{}", wrong.empty() ? "" : "\n", option, problem.what, allowed,
                         problem.hint);
  };
  for (const auto& [option, texts] : options) {
    if (option == "--camera") {
      try {
        expect_one(texts);
        set_camera_option(scene, texts.front());
      } catch (const Problem& problem) {
        complain(option, problem, camera_forms);
      }
      continue;
    }
    for (const SceneKey& key : config::keys()) {
      if (key.extras.option != option) continue;
      try {
        set(scene, key, texts);
      } catch (const Problem& problem) {
        complain(option, problem, key.allowed);
      }
    }
  }
  if (!wrong.empty()) throw Error(ExitCode::bad_input, wrong);
}

}  // namespace plisse::config
