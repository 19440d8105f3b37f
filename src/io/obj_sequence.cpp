// Numbered OBJ files (see obj_sequence.h).
#include "io/obj_sequence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "base/error.h"
#include "io/import_obj.h"
#include "io/import_place.h"

namespace plisse::io {
namespace {

namespace fs = std::filesystem;

// A file name with a hole for the number.
struct Pattern {
  std::string before, after;
  std::size_t digits = 1;  // at least so many, zeros in front

  std::string name(std::uint64_t number) const {
    return fmt::format("{}{:0{}}{}", before, number, digits, after);
  }
  bool operator<(const Pattern& other) const {
    return std::tie(before, after) < std::tie(other.before, other.after);
  }
};

// The digits between `from` and `to` of a spelled-out hole, as in %04d: "04" is 4, nothing is 1.
std::optional<std::size_t> width_in(const std::string& name, std::size_t from, std::size_t to) {
  if (from == to) return 1;
  std::size_t width = 0;
  const char* last = name.data() + to;
  const auto [end, error] = std::from_chars(name.data() + from, last, width);
  if (error != std::errc{} || end != last || width > 18) return std::nullopt;
  return width;
}

std::optional<Pattern> parse_pattern(const std::string& name) {
  if (const std::size_t hash = name.find('#'); hash != std::string::npos) {
    const std::size_t end = std::min(name.find_first_not_of('#', hash), name.size());
    return Pattern{name.substr(0, hash), name.substr(end), end - hash};
  }
  const auto spelled = [&](std::string_view opening, std::string_view closing) -> std::optional<Pattern> {
    const std::size_t start = name.find(opening);
    if (start == std::string::npos) return std::nullopt;
    const std::size_t end = name.find(closing, start + opening.size());
    if (end == std::string::npos) return std::nullopt;
    const std::optional<std::size_t> width = width_in(name, start + opening.size(), end);
    if (!width) return std::nullopt;
    return Pattern{name.substr(0, start), name.substr(end + closing.size()), *width};
  };
  if (auto pattern = spelled("%", "d")) return pattern;
  if (auto pattern = spelled("{frame:", "}")) return pattern;
  return spelled("{frame", "}");
}

// The number in `name` where it fits the pattern.
std::optional<std::uint64_t> number_in(const std::string& name, const Pattern& pattern) {
  if (name.size() <= pattern.before.size() + pattern.after.size()) return std::nullopt;
  if (!name.starts_with(pattern.before) || !name.ends_with(pattern.after)) return std::nullopt;
  const std::string digits =
      name.substr(pattern.before.size(), name.size() - pattern.before.size() - pattern.after.size());
  if (digits.size() < pattern.digits || digits.size() > 18) return std::nullopt;
  if (!std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
    return std::nullopt;
  return std::stoull(digits);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The one sequence of OBJ files that a folder holds.
Pattern pattern_of_folder(const fs::path& folder) {
  std::set<Pattern> patterns;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (lower(entry.path().extension().string()) != ".obj") continue;
    const std::string stem = entry.path().stem().string();
    const std::size_t digits = stem.size() - std::min(stem.find_last_not_of("0123456789") + 1, stem.size());
    if (digits == 0) continue;
    Pattern pattern{stem.substr(0, stem.size() - digits), entry.path().extension().string(), digits};
    const auto known = patterns.find(pattern);
    if (known != patterns.end()) {
      // 9.obj and 10.obj: the shortest number says how wide the hole is at least.
      pattern.digits = std::min(pattern.digits, known->digits);
      patterns.erase(known);
    }
    patterns.insert(pattern);
  }
  if (patterns.empty())
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: a folder without numbered OBJ files (such as drape_0001.obj)", folder.string()));
  if (patterns.size() > 1) {
    std::vector<std::string> names;
    for (const Pattern& pattern : patterns)
      names.push_back(pattern.before + std::string(pattern.digits, '#') + pattern.after);
    throw Error(ExitCode::bad_input, fmt::format("{}: a folder with several sequences; name one of them: {}",
                                                 folder.string(), fmt::join(names, ", ")));
  }
  return *patterns.begin();
}

bool same_faces(const ObjFile& a, const ObjFile& b) {
  return std::equal(a.triangles.begin(), a.triangles.end(), b.triangles.begin(), b.triangles.end(),
                    [](const auto& left, const auto& right) {
                      for (std::size_t c = 0; c < 3; ++c)
                        if (left[c].position != right[c].position) return false;
                      return true;
                    });
}

}  // namespace

bool is_sequence_pattern(const fs::path& path) {
  return parse_pattern(path.filename().string()).has_value();
}

std::vector<fs::path> sequence_files(const fs::path& pattern_or_folder) {
  const bool is_folder = fs::is_directory(pattern_or_folder);
  fs::path folder = is_folder ? pattern_or_folder : pattern_or_folder.parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::is_directory(folder))
    throw Error(ExitCode::bad_input, fmt::format("{}: no such folder", folder.string()));
  const std::optional<Pattern> pattern =
      is_folder ? pattern_of_folder(folder) : parse_pattern(pattern_or_folder.filename().string());
  if (!pattern)
    throw Error(ExitCode::bad_input,
                fmt::format("{}: no place for a frame number; write ####, %04d or {{frame:04}}",
                            pattern_or_folder.string()));

  std::map<std::uint64_t, fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::optional<std::uint64_t> number = number_in(entry.path().filename().string(), *pattern);
    if (!number) continue;
    const auto [known, added] = files.emplace(*number, entry.path());
    if (!added)
      throw Error(ExitCode::bad_input,
                  fmt::format("{} and {}: two files with the number {}", known->second.string(),
                              entry.path().filename().string(), *number));
  }
  if (files.empty())
    throw Error(ExitCode::bad_input, fmt::format("{}: no file fits this pattern",
                                                 (folder / pattern_or_folder.filename()).string()));
  std::vector<fs::path> result;
  for (std::uint64_t number = files.begin()->first; const auto& [found, path] : files) {
    if (found != number)
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: missing from the sequence {} … {}", (folder / pattern->name(number)).string(),
                      files.begin()->second.filename().string(), files.rbegin()->second.filename().string()));
    result.push_back(path);
    ++number;
  }
  return result;
}

Model import_obj_sequence(const std::vector<fs::path>& files, const ImportOptions& options) {
  const ObjFile first = read_obj_file(files.at(0));
  std::vector<std::uint32_t> sources;
  Model model = model_of(first, options, sources);
  const glm::dmat4 world = file_to_world(model.up, model.metres_per_unit);
  for (const fs::path& path : files) {
    const ObjFile file = &path == &files.front() ? first : read_obj_file(path);
    if (file.positions.size() != first.positions.size() || file.triangles.size() != first.triangles.size())
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: {} vertices and {} triangles, but {} has {} and {}; a sequence must keep its mesh",
                      path.string(), file.positions.size(), file.triangles.size(), first.path.string(),
                      first.positions.size(), first.triangles.size()));
    if (!same_faces(file, first))
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: its faces join other vertices than those of {}; a sequence must keep its mesh",
                      path.string(), first.path.string()));
    std::vector<glm::dvec3>& frame = model.cache.frames.emplace_back();
    frame.reserve(sources.size());
    for (const std::uint32_t source : sources)
      frame.emplace_back(world * glm::dvec4(file.positions[source], 1));
    model.cache.names.push_back(path.string());
  }
  return model;
}

}  // namespace plisse::io
