// Scene files (TOML): reads them into checked settings, writes a commented one, and documents their keys. All
// of it comes from the rows of config/settings.h.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "config/settings.h"

namespace plisse::config {

// The defaults, with this model.
SceneSettings bare_scene(const std::filesystem::path& model);

// Throws Error(bad_input) with all that is wrong with the file, one "file:line:column: key '…': …" a line, in
// the file's order. Paths in the file are relative to its folder.
SceneSettings load_scene(const std::filesystem::path& file);

// The same for a text that stands, or will stand, in `file`; the second for one that need not say which
// model.
SceneSettings parse_scene(std::string_view text, const std::filesystem::path& file);
SceneSettings parse_scene_of_any_model(std::string_view text, const std::filesystem::path& file);

// What commands take for a scene: a scene file, a panel file (both .toml), or else a model.
SceneSettings open_scene(const std::filesystem::path& file);

// A scene with every key: `path` as given (to be read relative to the scene's folder), all others commented
// out at their defaults, so that it means the same as the bare model. Notes are put beside keys
// ("wrinkles.only" → "Materials here: …").
std::string scene_text(const std::string& model_path, const std::map<std::string, std::string>& notes = {});

// docs/scene.md.
std::string scene_reference_markdown();

}  // namespace plisse::config
