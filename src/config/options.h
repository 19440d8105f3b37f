// The command line's options that override keys of a scene, made from the same table as the parser.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/settings.h"

namespace plisse::config {

struct SceneOption {
  std::string name;   // "--wavelength"
  std::string value;  // "L", for --help
  std::string help;
  std::string table;  // the scene's table it belongs to
};
const std::vector<SceneOption>& scene_options();

// Options in the order given, each with its values. Paths are relative to the working directory. Throws
// Error(bad_input) with all that is wrong, one "--option: …" a line.
using GivenOptions = std::vector<std::pair<std::string, std::vector<std::string>>>;
void apply_options(SceneSettings& scene, const GivenOptions& options);

}  // namespace plisse::config
