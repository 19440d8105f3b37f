// --cache-dir of the commands that solve, and what their reports say of it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command_line.h"

namespace plisse::cli {

// Where solved base surfaces and fields are kept.
class CacheArguments {
 public:
  explicit CacheArguments(CommandOptions& options);
  std::filesystem::path folder() const;  // empty: nowhere
  bool given() const { return !folder_.empty(); }

 private:
  std::string folder_;
};

// `skipped` and `saved_s` of a run that may have taken answers from there.
nlohmann::ordered_json reused_json(int answers, double saved_s);

}  // namespace plisse::cli
