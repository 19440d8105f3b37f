// Scenes with [solve]: their wrinkles are solved before a command draws, bakes, exports or verifies them.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "cli/arguments.h"
#include "cli/cache_arguments.h"
#include "scene/in_memory.h"

namespace plisse::cli {

struct SolvedRun {
  scene::InMemory memory;         // empty where the scene has no [solve]
  nlohmann::ordered_json report;  // null where it has none: the value of the report's key "solve"
  bool converged = true;
  bool interrupted = false;
};

class SolveArguments {
 public:
  explicit SolveArguments(CommandOptions& options) : cache_(options) {}
  // Tells of frames that did not converge. Throws Error. before: what is called where there is something to
  // solve, to find early what would be wrong after that long part.
  SolvedRun run(
      const config::SceneSettings& scene, const CommonArguments& common,
      const std::function<void()>& before = [] {}) const;

 private:
  CacheArguments cache_;
};

}  // namespace plisse::cli
