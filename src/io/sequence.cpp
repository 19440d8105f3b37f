// Numbered OBJ or PLY files (see sequence.h).
#include "io/sequence.h"

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
#include "base/hash.h"
#include "base/text.h"
#include "io/import_place.h"
#include "io/obj.h"
#include "io/ply.h"
#include "io/read_model.h"

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

bool is_ply(const fs::path& path) {
  return lower_case(path.extension().string()) == ".ply";
}

// The one sequence of OBJ or PLY files that a folder holds.
Pattern pattern_of_folder(const fs::path& folder) {
  std::set<Pattern> patterns;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (lower_case(entry.path().extension().string()) != ".obj" && !is_ply(entry.path())) continue;
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
    throw Error(ExitCode::bad_input,
                fmt::format("{}: a folder without numbered OBJ or PLY files (such as drape_0001.obj)",
                            folder.string()));
  if (patterns.size() > 1) {
    std::vector<std::string> names;
    for (const Pattern& pattern : patterns)
      names.push_back(pattern.before + std::string(pattern.digits, '#') + pattern.after);
    throw Error(ExitCode::bad_input, fmt::format("{}: a folder with several sequences; name one of them: {}",
                                                 folder.string(), fmt::join(names, ", ")));
  }
  return *patterns.begin();
}

// What the frames of a sequence have in common or not.
struct FileMesh {
  std::vector<glm::dvec3> positions;
  std::size_t triangles = 0;
  std::string faces;  // fingerprint of which vertices they join
};

// Polygons as fans here: a later frame, whose polygons would be cut differently, has the first one's
// triangles.
FileMesh read_mesh(const fs::path& path) {
  FileMesh mesh;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (is_ply(path)) {
    const Ply file = read_ply(path, {"x", "y", "z", "vertex_indices", "vertex_index"});
    triangles = file.triangles(Ply::Polygons::fans);
    mesh.positions = file.vectors("vertex");
  } else {
    ObjFile file = read_obj(path);
    triangles = file.faces();
    mesh.positions = std::move(file.positions);
  }
  mesh.triangles = triangles.size();
  Hash hash;
  for (const auto& triangle : triangles)
    for (const std::uint32_t corner : triangle) hash.add(corner);
  mesh.faces = hash.hex();
  return mesh;
}

class SequenceFrames : public FrameSource {
 public:
  SequenceFrames(const Model& model, std::vector<fs::path> files, const Limits& limits)
      : files_(std::move(files)), limits_(limits), world_(file_to_world(model.up, model.metres_per_unit)) {
    for (const Mesh& mesh : model.meshes)
      sources_.insert(sources_.end(), mesh.file_vertices.begin(), mesh.file_vertices.end());
    FileMesh first = read_mesh(files_.front());
    first_ = {{}, first.triangles, std::move(first.faces)};
    vertices_ = first.positions.size();
  }

  std::size_t count() const override { return files_.size(); }

  std::vector<glm::dvec3> read(std::size_t frame) const override {
    const fs::path& path = files_.at(frame);
    check_model_file(path, limits_);
    const FileMesh mesh = read_mesh(path);
    if (mesh.positions.size() != vertices_ || mesh.triangles != first_.triangles)
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: {} vertices and {} triangles, but {} has {} and {}; a sequence must keep its mesh",
                      path.string(), mesh.positions.size(), mesh.triangles, files_.front().string(),
                      vertices_, first_.triangles));
    if (mesh.faces != first_.faces)
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: its faces join other vertices than those of {}; a sequence must keep its mesh",
                      path.string(), files_.front().string()));
    std::vector<glm::dvec3> positions;
    positions.reserve(sources_.size());
    for (const std::uint32_t source : sources_)
      positions.emplace_back(world_ * glm::dvec4(mesh.positions.at(source), 1));
    return positions;
  }

 private:
  std::vector<fs::path> files_;
  Limits limits_;
  glm::dmat4 world_;
  std::vector<std::uint32_t> sources_;  // number in the file of each vertex of the model
  FileMesh first_;                      // without positions
  std::size_t vertices_ = 0;
};

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

VertexCache sequence_cache(const Model& model, const std::vector<fs::path>& files, const Limits& limits) {
  return VertexCache(std::make_shared<SequenceFrames>(model, files, limits), 24);
}

}  // namespace plisse::io
