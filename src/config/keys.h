// The one table of all keys that a scene file has. The parser, docs/scene.md, the scene that `init` writes
// and the command line's options are all made from it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/kinds.h"

namespace plisse::config {

struct Table {
  std::string name;
  std::string doc;
};

struct Key {
  std::string table, name;
  Kind kind;
  std::string doc;                // one sentence; a line break starts a new line of a scene's comment
  std::string option = {};        // the option of the command line that overrides it, where there is one
  std::string option_value = {};  // as --help names its value
};

const std::vector<Table>& tables();
const std::vector<Key>& keys();

const Key* find_key(std::string_view table, std::string_view name);

}  // namespace plisse::config
