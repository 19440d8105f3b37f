#include "benchmark/effort.h"

#include "config/scene_file.h"
#include "support/files.h"

namespace plisse::benchmark {

config::SceneSettings scene_settings(const std::string& name, const Effort& effort) {
  config::SceneSettings settings = config::load_scene(test::asset(name + ".toml").string());
  settings.output.width = effort.width;
  settings.output.height = effort.height;
  return settings;
}

Subject scene_subject(const std::string& name, const Effort& effort) {
  pipeline::LoadedScene scene(scene_settings(name, effort));
  return subject_of(scene, name);
}

}  // namespace plisse::benchmark
