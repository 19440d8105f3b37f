#include "config/complaints.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace plisse::config {
namespace {

toml::source_position real(const toml::source_position& at) {
  return {std::max<toml::source_index>(at.line, 1), std::max<toml::source_index>(at.column, 1)};
}

}  // namespace

std::string place_in(const std::filesystem::path& file, const toml::source_position& at) {
  return fmt::format("{}:{}:{}", file.string(), real(at).line, real(at).column);
}

void Complaints::add(const toml::source_position& at, const std::string& text) {
  lines_.push_back({real(at).line, real(at).column, fmt::format("{}: {}", place_in(file_, at), text)});
}

void Complaints::throw_if_any() {
  if (lines_.empty()) return;
  std::stable_sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  std::string text;
  for (const Line& line : lines_) text += (text.empty() ? "" : "\n") + line.text;
  throw Error(ExitCode::bad_input, text);
}

toml::table parse_toml(std::string_view text, const std::filesystem::path& file) {
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    Complaints complaints(file);
    complaints.add(error.source().begin, fmt::format("not TOML: {}", error.description()));
    complaints.throw_if_any();
  }
  return {};
}

}  // namespace plisse::config
