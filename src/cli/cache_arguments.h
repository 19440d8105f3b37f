// --cache-dir of the commands that solve, and what their reports say of it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace plisse::cli {

// Where solved base surfaces and fields are kept.
class CacheArguments {
 public:
  explicit CacheArguments(CLI::App& app);
  std::filesystem::path folder() const;  // empty: nowhere
  bool given() const { return !folder_.empty(); }

 private:
  std::string folder_;
};

// `skipped` and `saved_s` of a run that may have taken answers from there.
nlohmann::ordered_json reused_json(int answers, double saved_s);

}  // namespace plisse::cli
