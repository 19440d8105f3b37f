#include "io/wrinkle_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/units.h"
#include "io/ply.h"

namespace plisse::io {
namespace {

namespace fs = std::filesystem;
constexpr double turn = 2 * std::numbers::pi;

Error bad(const std::string& file, const std::string& what) {
  return {ExitCode::bad_input, fmt::format("{}: {}", file, what)};
}

// Calls `line(number, text)` for every line.
template <typename Function>
void for_lines(const fs::path& path, Function&& line) {
  const auto bytes = read_whole_file(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    line(++number, text.substr(at, end - at));
    at = end + 1;
  }
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(" \t\r"); at < line.size();) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(" \t\r", end);
  }
  return words;
}

double number_of(std::string_view word, const fs::path& path, std::size_t line) {
  const auto value = parse_number(word);
  if (!value || !std::isfinite(*value))
    throw bad(fmt::format("{}:{}", path.string(), line),
              fmt::format("'{}' is no finite number", word.substr(0, 40)));
  return *value;
}

// Only v and f lines: the vertices in the file's own order, which is what text files count.
void read_obj(const fs::path& path, WrinkleField& field) {
  for_lines(path, [&](std::size_t line, std::string_view text) {
    const auto words = words_of(text);
    const std::string where = fmt::format("{}:{}", path.string(), line);
    if (words.empty()) return;
    if (words[0] == "v") {
      if (words.size() < 4) throw bad(where, "a vertex needs three numbers");
      field.positions.emplace_back(number_of(words[1], path, line), number_of(words[2], path, line),
                                   number_of(words[3], path, line));
    } else if (words[0] == "f") {
      if (words.size() != 4) throw bad(where, "a face of a wrinkle field's base surface has three corners");
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t c = 0; c < 3; ++c) {
        const double index = number_of(words[c + 1].substr(0, words[c + 1].find('/')), path, line);
        const double count = static_cast<double>(field.positions.size());
        const double zero_based = index < 0 ? count + index : index - 1;
        if (!(zero_based >= 0 && zero_based < count))
          throw bad(where, fmt::format("there is no vertex {}", index));
        triangle[c] = static_cast<std::uint32_t>(zero_based);
      }
      field.triangles.push_back(triangle);
    }
  });
  if (field.positions.empty() || field.triangles.empty())
    throw bad(path.string(),
              "has no triangles; a wrinkle field's text files need the OBJ of their base surface");
}

// "disk_amplitude_simulated.txt" → "disk_phi_simulated.txt".
fs::path sibling(const fs::path& amplitude, const std::string& word) {
  std::string name = amplitude.filename().string();
  const std::string_view from = "amplitude";
  const std::size_t at = name.rfind(from);
  if (at == std::string::npos) {
    throw bad(
        amplitude.string(),
        "is neither a PLY nor a text file with 'amplitude' in its name, like cloth_amplitude_simulated.txt");
  }
  return amplitude.parent_path() / name.replace(at, from.size(), word);
}

fs::path existing_sibling(const fs::path& amplitude, const std::string& word) {
  const fs::path path = sibling(amplitude, word);
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw bad(amplitude.string(), fmt::format("needs '{}' beside it", path.string()));
  return path;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;  // smaller, larger

std::map<Edge, std::size_t> edges_of(const WrinkleField& field) {
  std::map<Edge, std::size_t> edges;
  for (const auto& t : field.triangles) {
    for (std::size_t c = 0; c < 3; ++c) edges[std::minmax(t[c], t[(c + 1) % 3])] = 0;
  }
  std::size_t count = 0;
  for (auto& [edge, number] : edges) number = count++;
  return edges;
}

WrinkleField read_text(const fs::path& path, const fs::path& mesh) {
  WrinkleField field;
  const fs::path phi_file = existing_sibling(path, "phi"), dphi_file = existing_sibling(path, "dphi");
  read_obj(mesh, field);
  const auto edges = edges_of(field);
  field.amplitude = read_numbers(path, field.positions.size(), "vertices");
  const auto phi = read_numbers(phi_file, field.positions.size(), "vertices");
  const auto dphi = read_numbers(dphi_file, edges.size(), "edges");
  for (const auto& t : field.triangles) {
    std::array<double, 3> phase{phi[t[0]], 0, 0};
    for (std::size_t c = 1; c < 3; ++c) {
      const double forward = dphi[edges.at(std::minmax(t[0], t[c]))];
      const double wanted = phase[0] + (t[0] < t[c] ? forward : -forward);
      phase[c] = phi[t[c]] + turn * std::round((wanted - phi[t[c]]) / turn);
    }
    field.phase.push_back(phase);
  }
  return field;
}

// The three values an item of a list property.
std::vector<std::array<double, 3>> threes(const PlyElement& face,
                                          std::initializer_list<std::string_view> names,
                                          const std::string& file) {
  for (const std::string_view name : names) {
    const PlyProperty* property = face.find(name);
    if (!property || !property->list) continue;
    std::vector<std::array<double, 3>> result;
    for (std::size_t i = 0; i < face.count; ++i) {
      if (property->ends[i] != 3 * (i + 1))
        throw bad(file, fmt::format("face {}: '{}' has to have three values", i, name));
      result.push_back({property->values[3 * i], property->values[3 * i + 1], property->values[3 * i + 2]});
    }
    return result;
  }
  throw bad(file, fmt::format("element 'face' has no list '{}'", *names.begin()));
}

WrinkleField read_ply_field(const fs::path& path) {
  const std::string file = path.string();
  const Ply ply = read_ply(path);
  const PlyElement *vertex = ply.find("vertex"), *face = ply.find("face");
  if (!vertex || !face) throw bad(file, "a wrinkle field needs the elements 'vertex' and 'face'");
  WrinkleField field;
  const auto &x = ply_values(*vertex, {"x"}, file), &y = ply_values(*vertex, {"y"}, file),
             &z = ply_values(*vertex, {"z"}, file);
  for (std::size_t v = 0; v < vertex->count; ++v) field.positions.emplace_back(x[v], y[v], z[v]);
  field.amplitude = ply_values(*vertex, {"amplitude"}, file);
  field.phase = threes(*face, {"phase"}, file);
  for (const auto& given : threes(*face, {"vertex_indices", "vertex_index"}, file)) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(given[c] >= 0 && given[c] < static_cast<double>(vertex->count)))
        throw bad(file, fmt::format("face {}: there is no vertex {}", field.triangles.size(), given[c]));
      triangle[c] = static_cast<std::uint32_t>(given[c]);
    }
    field.triangles.push_back(triangle);
  }
  return field;
}

void validate(const WrinkleField& field, const std::string& file) {
  for (std::size_t v = 0; v < field.amplitude.size(); ++v) {
    if (!(field.amplitude[v] >= 0))
      throw bad(file, fmt::format("vertex {}: the amplitude is {:.4g}; it has to be 0 or more", v,
                                  field.amplitude[v]));
  }
  // Only what shows: where the amplitude is 0 a phase means nothing.
  constexpr double tolerance =
      1e-3;  // radians; fields are written with seven digits or more, of phases up to 1e3
  std::vector<double> first(field.amplitude.size(), NAN);
  for (std::size_t t = 0; t < field.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = field.triangles[t][c];
      if (std::isnan(first[v])) first[v] = field.phase[t][c];
      const double difference = std::remainder(field.phase[t][c] - first[v], turn);
      if (field.amplitude[v] > 0 && std::abs(difference) > tolerance) {
        throw bad(file,
                  fmt::format(
                      "face {}: the phase of vertex {} differs by {:.4g} from that of another face, which is "
                      "no multiple of 2π",
                      t, v, difference));
      }
    }
  }
}

}  // namespace

std::vector<double> read_numbers(const fs::path& path, std::size_t wanted, std::string_view of_what) {
  std::vector<double> values;
  for_lines(path, [&](std::size_t line, std::string_view text) {
    const auto words = words_of(text);
    if (words.empty()) return;
    if (words.size() > 1)
      throw bad(fmt::format("{}:{}", path.string(), line), "more than one number in a line");
    values.push_back(number_of(words[0], path, line));
  });
  if (values.size() != wanted) {
    throw bad(path.string(),
              fmt::format("has {} numbers, the base surface has {} {}", values.size(), wanted, of_what));
  }
  return values;
}

WrinkleField read_wrinkle_field(const fs::path& path, const fs::path& mesh) {
  const bool ply = path.extension() == ".ply" || path.extension() == ".PLY";
  WrinkleField field = ply ? read_ply_field(path) : read_text(path, mesh);
  validate(field, path.string());
  return field;
}

void write_wrinkle_texts(const fs::path& amplitude, const std::vector<double>& amplitudes,
                         const std::vector<double>& phase, const std::vector<double>& one_form) {
  const auto write = [](const fs::path& path, const std::vector<double>& values) {
    std::string text;
    for (const double value : values) text += fmt::format("{:.17g}\n", value);
    write_whole_file(path, text);
  };
  const fs::path phi = sibling(amplitude, "phi"), dphi = sibling(amplitude, "dphi");
  write(amplitude, amplitudes);
  write(phi, phase);
  write(dphi, one_form);
}

void write_wrinkle_field(const fs::path& path, const WrinkleField& field,
                         const std::vector<std::string>& comments) {
  using Type = PlyProperty::Type;
  PlyElement vertex{"vertex", field.positions.size()}, face{"face", field.triangles.size()};
  for (int i = 0; i < 3; ++i) {
    PlyProperty axis{std::string(1, "xyz"[i]), Type::float64};
    for (const glm::dvec3& x : field.positions) axis.values.push_back(x[i]);
    vertex.properties.push_back(std::move(axis));
  }
  vertex.properties.push_back({"amplitude", Type::float64, false, field.amplitude});
  PlyProperty indices{"vertex_indices", Type::uint32, true}, phase{"phase", Type::float64, true};
  auto edges = edges_of(field);
  std::vector<double> omega(edges.size(), 0.0);
  for (std::size_t t = 0; t < field.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = field.triangles[t][c], b = field.triangles[t][(c + 1) % 3];
      indices.values.push_back(a);
      phase.values.push_back(field.phase[t][c]);
      const double difference = field.phase[t][(c + 1) % 3] - field.phase[t][c];
      omega[edges.at(std::minmax(a, b))] = a < b ? difference : -difference;
    }
    indices.ends.push_back(3 * (t + 1));
    phase.ends.push_back(3 * (t + 1));
  }
  face.properties = {std::move(indices), std::move(phase)};
  PlyElement edge{"edge", edges.size()};
  PlyProperty first{"vertex1", Type::uint32}, second{"vertex2", Type::uint32};
  for (const auto& [ends, number] : edges) {
    first.values.push_back(ends.first);
    second.values.push_back(ends.second);
  }
  edge.properties = {std::move(first), std::move(second), {"omega", Type::float64, false, std::move(omega)}};
  std::vector<std::string> lines{"plisse: wrinkle field, height = amplitude cos(phase)"};
  lines.insert(lines.end(), comments.begin(), comments.end());
  write_ply(path, {std::move(lines), {vertex, face, edge}});
}

}  // namespace plisse::io
