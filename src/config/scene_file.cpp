#include "config/scene_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "config/complaints.h"
#include "config/frames.h"
#include "config/keys.h"
#include "config/suggest.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;
using config::Complaints;
using config::Key;
using config::Problem;

std::vector<std::string> table_names() {
  std::vector<std::string> names;
  for (const config::Table& table : config::tables()) names.push_back(table.name);
  return names;
}

std::vector<std::string> key_names(std::string_view table) {
  std::vector<std::string> names;
  for (const Key& key : config::keys()) {
    if (key.table == table) names.push_back(key.name);
  }
  return names;
}

// Where else a key of this name is at home, in words; or what its name nearly is.
std::string unknown_key(const std::string& table, const std::string& name) {
  std::string elsewhere;
  for (const Key& key : config::keys()) {
    if (key.name == name) elsewhere += fmt::format("{}[{}]", elsewhere.empty() ? "" : " or ", key.table);
  }
  if (!elsewhere.empty())
    return fmt::format("key '{}': unknown in [{}], it belongs to {}", name, table, elsewhere);
  const auto names = key_names(table);
  std::string hint = did_you_mean(name, names);
  if (hint.empty()) {
    for (const Key& key : config::keys()) {
      const std::array<std::string, 1> other = {key.name};
      if (!nearest(name, other).empty()) {
        hint = fmt::format(" (did you mean '{}' of [{}]?)", key.name, key.table);
        break;
      }
    }
  }
  return fmt::format("key '{}': unknown in [{}]; allowed: {}{}", name, table, config::either(names), hint);
}

std::string unknown_table(const std::string& name, const toml::node& node) {
  const auto names = table_names();
  if (node.is_table()) {
    return fmt::format("table [{}]: unknown; allowed: {}{}", name, config::either(names),
                       did_you_mean(name, names));
  }
  std::vector<std::string> all;
  for (const Key& key : config::keys()) all.push_back(key.name);
  const std::string meant = nearest(name, all);
  for (const Key& key : config::keys()) {
    if (key.name == meant) {
      const std::string hint = meant == name ? "" : fmt::format(" (did you mean '{}'?)", meant);
      return fmt::format("key '{}': stands outside a table, '{}' belongs under [{}]{}", name, meant,
                         key.table, hint);
    }
  }
  return fmt::format("key '{}': unknown, and outside a table; tables: {}", name, config::either(names));
}

using Given = std::map<std::string, toml::source_position>;  // "table.key" → where the file has it

// What only shows once all keys are known: values that take each other's place.
void check_together(SceneSettings& scene, const Given& given, Complaints& complaints) {
  const auto at = [&](const std::string& key) -> const toml::source_position* {
    const auto found = given.find("camera." + key);
    return found == given.end() ? nullptr : &found->second;
  };
  const auto useless = [&](std::initializer_list<const char*> keys, std::string_view beside) {
    for (const char* key : keys) {
      if (const auto* where = at(key)) {
        complaints.add(*where,
                       fmt::format("key '{}': has no effect beside {}; take one of them out", key, beside));
      }
    }
  };
  const auto of_garment = [&](const std::string& key, bool empty) {
    if (!empty && scene.model.garment.empty())
      complaints.add(given.at("model." + key), fmt::format("key '{}': has no effect without 'garment'", key));
  };
  of_garment("pieces", scene.model.pieces.empty());
  of_garment("fabric", scene.model.fabric.empty());
  if (!scene.model.garment.empty() && !scene.model.path.empty()) {
    complaints.add(given.at("model.garment"), "key 'garment': stands beside 'path'; take one of them out");
  }
  std::string bias;  // the key that names the wrinkles of the rest pose; "" stands for none
  for (const auto& [key, path] :
       {std::pair("paint", &scene.bias.paint), {"file", &scene.bias.file}, {"field", &scene.bias.field}}) {
    if (path->empty()) continue;
    if (!bias.empty()) {
      complaints.add(given.at(fmt::format("bias.{}", key)),
                     fmt::format("key '{}': stands beside '{}'; take one of them out", key, bias));
    }
    bias = key;
  }
  if (names_many_files(scene.bias.field) && scene.bias.use != FieldUse::direct) {
    complaints.add(given.at("bias.field"),
                   "key 'field': one field a frame is carried as it is and needs use = \"direct\" beside it; "
                   "what a field is as bias belongs to the one rest pose");
  }
  const auto *eye = at("eye"), *target = at("target");
  if (eye && !target) complaints.add(*eye, "key 'eye': needs 'target' beside it");
  if (target && !eye) complaints.add(*target, "key 'target': needs 'eye' beside it");
  if (!scene.camera.name.empty()) {
    useless({"focal_length", "azimuth", "elevation", "distance", "margin", "eye", "target"}, "'name'");
  } else if (eye && target) {
    useless({"azimuth", "elevation", "distance", "margin"}, "'eye' and 'target'");
    scene.camera.explicit_pose = true;
    if (scene.camera.eye == scene.camera.target)
      complaints.add(*target, "key 'target': is the same point as 'eye'");
  }
}

bool is_empty_array(const toml::node& node) {
  return node.is_array() && node.as_array()->empty();
}

void read_table(const std::string& table, const toml::table& values, const fs::path& folder,
                SceneSettings& scene, Given& given, Complaints& complaints) {
  for (const auto& [toml_key, node] : values) {
    const std::string name(toml_key.str());
    const Key* key = config::find_key(table, name);
    if (!key) {
      complaints.add(toml_key.source().begin, unknown_key(table, name));
      continue;
    }
    try {
      key->kind.set(scene, node, folder);
    } catch (const Problem& problem) {
      complaints.add(toml_key.source().begin, fmt::format("key '{}': {}; allowed: {}{}", name, problem.what,
                                                          key->kind.allowed, problem.hint));
    }
    if (!is_empty_array(node))
      given[table + "." + name] = toml_key.source().begin;  // [] stands for "not given"
  }
}

// As comments, in lines that fit beside code.
std::string commented(const std::string& text) {
  std::string lines = "# ";
  for (const char c : wrapped(text, 108)) lines += c == '\n' ? "\n# " : std::string(1, c);
  return lines + "\n";
}

// "|" would end a cell.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return escaped;
}

}  // namespace

SceneSettings bare_scene(const fs::path& model) {
  SceneSettings scene;
  scene.model.path = model;
  return scene;
}

SceneSettings load_scene(const fs::path& file) {
  return parse_scene(read_whole_text(file), file);
}

SceneSettings parse_scene(std::string_view text, const fs::path& file) {
  Complaints complaints(file);
  const toml::table root = config::parse_toml(text, file);

  SceneSettings scene;
  scene.file = file;
  const fs::path folder = file.parent_path();
  if (!folder.empty()) scene.output.path = (folder / scene.output.path).string();

  Given given;
  toml::source_position model_table{1, 1};
  const auto tables = table_names();
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    const bool known = std::find(tables.begin(), tables.end(), name) != tables.end();
    if (known && node.is_table()) {
      if (name == "model") model_table = key.source().begin;
      read_table(name, *node.as_table(), folder, scene, given, complaints);
    } else if (known) {
      complaints.add(key.source().begin,
                     fmt::format("key '{0}': is a table; write [{0}] and its keys below", name));
    } else {
      complaints.add(key.source().begin, unknown_table(name, node));
    }
  }
  const bool garment = !root["model"]["garment"].value_or(std::string()).empty();  // right or wrong
  if (!given.contains("model.path") && !garment) {
    complaints.add(model_table, fmt::format("key 'path': missing in [model]; allowed: {}; or 'garment'",
                                            config::find_key("model", "path")->kind.allowed));
  }
  for (const auto& [key, position] : given) scene.places[key] = config::place_in(file, position);
  check_together(scene, given, complaints);
  complaints.throw_if_any();
  return scene;
}

std::string scene_text(const std::string& model_path, const std::map<std::string, std::string>& notes) {
  const SceneSettings scene = bare_scene(model_path);
  std::string text =
      "# A scene for plisse: plisse render THIS_FILE\n"
      "# Keys that are commented out stand at their defaults. Paths start from this file's folder. Lengths "
      "are\n"
      "# metres, or texts like \"12 mm\"; angles are degrees; colours are \"#rrggbb\" or [r, g, b], sRGB.\n";
  for (const config::Table& table : config::tables()) {
    text += fmt::format("\n{}[{}]\n", commented(table.doc), table.name);
    for (const Key& key : config::keys()) {
      if (key.table != table.name) continue;
      text += fmt::format("\n{}", commented(fmt::format("{} Allowed: {}.", key.doc, key.kind.allowed)));
      const auto note = notes.find(key.table + "." + key.name);
      if (note != notes.end() && !note->second.empty()) text += commented(note->second);
      const bool matters = key.table == "model" && key.name == "path";
      text += fmt::format("{}{} = {}\n", matters ? "" : "#", key.name, key.kind.show(scene));
    }
  }
  return text;
}

std::string scene_reference_markdown() {
  const SceneSettings defaults;
  std::string text =
      "# Scene files\n\n"
      "Made by `plisse init --keys-markdown` from the table in `src/config/keys.cpp`; a test holds the two "
      "together.\n\n"
      "A scene is a TOML file; `plisse init MODEL` writes one with every key and its default. Paths start "
      "from the\n"
      "scene's folder. Lengths are metres, or texts with a unit such as `\"12 mm\"`. Options of the command "
      "line override\n"
      "keys. Unknown keys, wrong types and values out of range are errors, all of a file's reported at "
      "once.\n";
  for (const config::Table& table : config::tables()) {
    text += fmt::format(
        "\n## [{}]\n{}\n\n| key | type | default | allowed | what it does | option "
        "|\n|---|---|---|---|---|---|\n",
        table.name, table.doc);
    for (const Key& key : config::keys()) {
      if (key.table != table.name) continue;
      const bool needed = key.table == "model" && key.name == "path";
      text += fmt::format(
          "| `{}` | {} | {} | {} | {} | {} |\n", key.name, key.kind.type,
          needed ? "must be given, or `garment`" : fmt::format("`{}`", key.kind.show(defaults)),
          cell(key.kind.allowed), cell(key.doc), key.option.empty() ? "" : fmt::format("`{}`", key.option));
    }
  }
  return text;
}

}  // namespace plisse::config
