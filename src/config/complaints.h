// What is wrong with a file that people write, gathered so that one look at the output mends the whole file.
#pragma once

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace plisse::config {

class Complaints {
 public:
  explicit Complaints(const std::filesystem::path& file) : file_(file.string()) {}

  void add(const toml::source_position& at, const std::string& text) {
    const auto line = std::max<toml::source_index>(at.line, 1),
               column = std::max<toml::source_index>(at.column, 1);
    lines_.push_back({line, column, fmt::format("{}:{}:{}: {}", file_, line, column, text)});
  }

  // Throws Error(bad_input), a line a complaint in the file's order.
  void throw_if_any() {
    if (lines_.empty()) return;
    std::stable_sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) {
      return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    });
    std::string text;
    for (const Line& line : lines_) text += (text.empty() ? "" : "\n") + line.text;
    throw Error(ExitCode::bad_input, text);
  }

 private:
  struct Line {
    toml::source_index line, column;
    std::string text;
  };
  std::string file_;
  std::vector<Line> lines_;
};

}  // namespace plisse::config
