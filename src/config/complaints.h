// Collects the errors of a file that users write, so that they can correct all of them at once.
#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <string>
#include <vector>

namespace plisse::config {

class Complaints {
 public:
  explicit Complaints(const std::filesystem::path& file) : file_(file.string()) {}

  void add(const toml::source_position& at, const std::string& text);
  std::size_t count() const { return lines_.size(); }
  // Error(bad_input) with one "file:line:column: text" a line, in the file's order.
  void throw_if_any();

 private:
  struct Line {
    toml::source_index line, column;
    std::string text;
  };
  std::string file_;
  std::vector<Line> lines_;
};

// A place in a file as messages name it: "file:line:column".
std::string place_in(const std::filesystem::path& file, const toml::source_position& at);

// The file's content as TOML; a syntax error is thrown as the file's only complaint.
toml::table parse_toml(std::string_view text, const std::filesystem::path& file);

}  // namespace plisse::config
