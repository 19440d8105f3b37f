#include "config/scene_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "config/file_reader.h"
#include "config/frames.h"
#include "config/key_table.h"
#include "config/keys.h"
#include "config/panel_file.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;

// What only shows once all keys are known: values that take each other's place.
// `given`: "table.key" → where the file has it.
void check_together(SceneSettings& scene, const Places& given, FileReader& reader) {
  const auto at = [&](const std::string& key) -> const toml::source_position* {
    const auto found = given.find("camera." + key);
    return found == given.end() ? nullptr : &found->second;
  };
  const auto useless = [&](std::initializer_list<const char*> keys, std::string_view beside) {
    for (const char* key : keys) {
      if (const auto* where = at(key)) {
        reader.complain(*where,
                        fmt::format("key '{}': has no effect beside {}; take one of them out", key, beside));
      }
    }
  };
  const auto of_garment = [&](const std::string& key, bool empty) {
    if (!empty && scene.model.garment.empty())
      reader.complain(given.at("model." + key),
                      fmt::format("key '{}': has no effect without 'garment'", key));
  };
  of_garment("pieces", scene.model.pieces.empty());
  of_garment("fabric", scene.model.fabric.empty());
  if (!scene.model.garment.empty() && !scene.model.path.empty()) {
    reader.complain(given.at("model.garment"), "key 'garment': stands beside 'path'; take one of them out");
  }
  std::string bias;  // the key that names the wrinkles of the rest pose; "" stands for none
  for (const auto& [key, path] :
       {std::pair("paint", &scene.bias.paint), {"file", &scene.bias.file}, {"field", &scene.bias.field}}) {
    if (path->empty()) continue;
    if (!bias.empty()) {
      reader.complain(given.at(fmt::format("bias.{}", key)),
                      fmt::format("key '{}': stands beside '{}'; take one of them out", key, bias));
    }
    bias = key;
  }
  if (scene.solve.on && !bias.empty()) {
    reader.complain(given.at(fmt::format("bias.{}", bias)),
                    fmt::format("key '{}': stands beside [solve], whose wrinkles take its place; take one of "
                                "them out",
                                bias));
  }
  if (!scene.solve.fabric.empty() && scene.wrinkles.wavelength > 0) {
    reader.complain(
        given.at("solve.fabric"),
        "key 'fabric': stands beside 'wavelength' of [wrinkles], but a fabric has waves of its own "
        "length; take one of them out");
  }
  if (names_many_files(scene.bias.field) && scene.bias.use != FieldUse::direct) {
    reader.complain(
        given.at("bias.field"),
        "key 'field': one field a frame is carried as it is and needs use = \"direct\" beside it; "
        "what a field is as bias belongs to the one rest pose");
  }
  const auto *eye = at("eye"), *target = at("target");
  if (eye && !target) reader.complain(*eye, "key 'eye': needs 'target' beside it");
  if (target && !eye) reader.complain(*target, "key 'target': needs 'eye' beside it");
  if (!scene.camera.name.empty()) {
    useless({"focal_length", "azimuth", "elevation", "distance", "margin", "eye", "target"}, "'name'");
  } else if (eye && target) {
    useless({"azimuth", "elevation", "distance", "margin"}, "'eye' and 'target'");
    scene.camera.explicit_pose = true;
    if (scene.camera.eye == scene.camera.target)
      reader.complain(*target, "key 'target': is the same point as 'eye'");
  }
}

bool is_empty_array(const toml::node& node) {
  return node.is_array() && node.as_array()->empty();
}

// As comments, in lines that fit beside code.
std::string commented(const std::string& text) {
  std::string lines = "# ";
  for (const char c : wrapped(text, 108)) lines += c == '\n' ? "\n# " : std::string(1, c);
  return lines + "\n";
}

SceneSettings parse(std::string_view text, const fs::path& file, bool needs_model) {
  FileReader reader(text, file);
  append(reader.all, keys());
  SceneSettings scene;
  scene.file = file;
  const fs::path folder = file.parent_path();
  if (!folder.empty()) scene.output.path = (folder / scene.output.path).string();

  Places given;
  toml::source_position model_table{1, 1};
  std::vector<FileTable> all;
  for (const Table& table : tables()) {
    all.push_back({table.name, false, [&, title = table.name](const toml::table& values, const auto& at) {
                     if (title == "model") model_table = at;
                     if (title == "solve") scene.solve.on = true;
                     for (const auto& [name, place] :
                          reader.read(keys_of(title), values, "[" + title + "]", scene))
                       if (!is_empty_array(*values.get(name)))  // [] stands for "not given"
                         given[title + "." + name] = place;
                   }});
  }
  reader.read_tables(all);
  const bool garment = !reader.root()["model"]["garment"].value_or(std::string()).empty();  // right or wrong
  if (needs_model && !given.contains("model.path") && !garment) {
    reader.complain(model_table, fmt::format("key 'path': missing in [model]; allowed: {}; or 'garment'",
                                             find_key("model", "path")->allowed));
  }
  for (const auto& [key, position] : given) scene.places[key] = reader.place(position);
  check_together(scene, given, reader);
  reader.finish();
  return scene;
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

SceneSettings open_scene(const fs::path& file) {
  if (lower_case(file.extension().string()) != ".toml") return bare_scene(file);
  if (!is_panel_file(file)) return load_scene(file);
  SceneSettings scene;
  scene.model.garment = file;
  return scene;
}

SceneSettings parse_scene(std::string_view text, const fs::path& file) {
  return parse(text, file, true);
}

SceneSettings parse_scene_of_any_model(std::string_view text, const fs::path& file) {
  return parse(text, file, false);
}

std::string scene_text(const std::string& model_path, const std::map<std::string, std::string>& notes) {
  const SceneSettings scene = bare_scene(model_path);
  std::string text =
      "# A scene for plisse: plisse render THIS_FILE\n"
      "# Keys that are commented out stand at their defaults. Paths start from this file's folder. Lengths "
      "are\n"
      "# metres, or texts like \"12 mm\"; angles are degrees; colours are \"#rrggbb\" or [r, g, b], sRGB.\n";
  for (const Table& table : tables()) {
    // An empty [solve] has a meaning.
    text += fmt::format("\n{}{}[{}]\n", commented(table.doc), table.name == "solve" ? "#" : "", table.name);
    for (const SceneKey& key : keys_of(table.name)) {
      text += fmt::format("\n{}", commented(fmt::format("{} Allowed: {}.", key.doc, key.allowed)));
      const auto note = notes.find(key.table + "." + key.name);
      if (note != notes.end() && !note->second.empty()) text += commented(note->second);
      const bool matters = key.table == "model" && key.name == "path";
      text += fmt::format("{}{} = {}\n", matters ? "" : "#", key.name, key.show(scene));
    }
  }
  return text;
}

std::string scene_reference_markdown() {
  const SceneSettings defaults;
  std::string text =
      "# Scene files\n\n"
      "Made by `plisse init --keys-markdown` from the rows below the settings in `src/config`; a test holds "
      "them together.\n\n"
      "A scene is a TOML file; `plisse init MODEL` writes one with every key and its default. Paths start "
      "from the\n"
      "scene's folder. Lengths are metres, or texts with a unit such as `\"12 mm\"`. Options of the command "
      "line override\n"
      "keys. Unknown keys, wrong types and values out of range are errors, all of a file's reported at "
      "once.\n";
  const std::vector<Column> columns = {
      name_column(),
      {"type", [](const KeyText& key) { return key.type; }},
      {"default",
       [&](const KeyText& key) {
         return key.table == "model" && key.name == "path"
                    ? std::string("must be given, or `garment`")
                    : fmt::format("`{}`", find_key(key.table, key.name)->show(defaults));
       }},
      allowed_column(),
      doc_column(),
      {"option",
       [](const KeyText& key) {
         return key.extras.option.empty() ? std::string() : fmt::format("`{}`", key.extras.option);
       }},
  };
  for (const Table& table : tables()) {
    std::vector<KeyText> rows;
    append(rows, keys_of(table.name));
    text += fmt::format("\n## [{}]\n{}\n\n{}", table.name, table.doc, key_table(rows, columns));
  }
  return text;
}

}  // namespace plisse::config
