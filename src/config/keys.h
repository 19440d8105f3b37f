// All keys that a scene file has, in the order of its documents: the rows of config/settings.h. The parser,
// docs/scene.md, the scene that `init` writes and the command line's options are all made from them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/key.h"
#include "config/settings.h"

namespace plisse::config {

struct Table {
  std::string name;
  std::string doc;
};

using SceneKey = Key<SceneSettings>;

const std::vector<Table>& tables();
const Keys<SceneSettings>& keys();
Keys<SceneSettings> keys_of(std::string_view table);

const SceneKey* find_key(std::string_view table, std::string_view name);

}  // namespace plisse::config
