#include "config/keys.h"

namespace plisse::config {
namespace {

struct Scene {
  std::vector<Table> tables;
  Keys<SceneSettings> keys;

  template <typename Group, typename List>
  void operator()(const char* name, Group SceneSettings::*group, const char* doc, const List& list) {
    tables.push_back({name, doc});
    Rows<SceneSettings, Group> rows(keys, name, [=](SceneSettings& scene) -> Group& { return scene.*group; });
    list(rows);
  }
};

const Scene& scene() {
  static const Scene all = [] {
    Scene listed;
    scene_tables(listed);
    return listed;
  }();
  return all;
}

}  // namespace

const std::vector<Table>& tables() {
  return scene().tables;
}

const Keys<SceneSettings>& keys() {
  return scene().keys;
}

Keys<SceneSettings> keys_of(std::string_view table) {
  Keys<SceneSettings> some;
  for (const SceneKey& key : keys())
    if (key.table == table) some.push_back(key);
  return some;
}

const SceneKey* find_key(std::string_view table, std::string_view name) {
  for (const SceneKey& key : keys())
    if (key.table == table && key.name == name) return &key;
  return nullptr;
}

}  // namespace plisse::config
