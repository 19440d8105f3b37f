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
#include "base/text.h"
#include "base/units.h"
#include "io/obj.h"
#include "io/ply.h"

namespace plisse::io {
namespace {

namespace fs = std::filesystem;
constexpr double turn = 2 * std::numbers::pi;

Error bad(const std::string& file, const std::string& what) {
  return {ExitCode::bad_input, fmt::format("{}: {}", file, what)};
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
  const fs::path phi_file = existing_sibling(path, "phi"), dphi_file = existing_sibling(path, "dphi");
  // The vertices in the file's own order, which is what text files count.
  ObjFile obj = read_obj(mesh, {.polygons = ObjWanted::Polygons::refused});
  if (obj.triangles.empty())
    throw bad(mesh.string(),
              "has no triangles; a wrinkle field's text files need the OBJ of their base surface");
  WrinkleField field;
  field.positions = std::move(obj.positions);
  field.triangles = obj.faces();
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

WrinkleField read_ply_field(const fs::path& path) {
  const Ply ply = read_ply(path, {"x", "y", "z", "amplitude", "vertex_indices", "vertex_index", "phase"});
  WrinkleField field;
  field.positions = ply.vectors("vertex");
  field.amplitude = ply.numbers("vertex", {"amplitude"});
  field.triangles = ply.triangles(Ply::Polygons::refused);
  const std::vector<double>& phase = ply.lists("face", "phase", 3);
  for (std::size_t i = 0; i < phase.size(); i += 3)
    field.phase.push_back({phase[i], phase[i + 1], phase[i + 2]});
  return field;
}

}  // namespace

void check_field(const WrinkleField& field, const std::string& file) {
  for (std::size_t v = 0; v < field.amplitude.size(); ++v) {
    if (!(field.amplitude[v] >= 0 && std::isfinite(field.amplitude[v])))
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
      if (!std::isfinite(field.phase[t][c]))
        throw bad(file, fmt::format("face {}: the phase of vertex {} is not finite", t, v));
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

std::vector<double> read_numbers(const fs::path& path, std::size_t wanted, std::string_view of_what) {
  std::vector<double> values;
  for_each_line(read_whole_text(path), [&](std::string_view line, std::size_t number) {
    const auto words = words_of(line);
    if (words.empty()) return;
    const std::string where = fmt::format("{}:{}", path.string(), number);
    if (words.size() > 1) throw bad(where, "more than one number in a line");
    const auto value = parse_number(words[0]);
    if (!value || !std::isfinite(*value))
      throw bad(where, fmt::format("'{}' is no finite number", words[0].substr(0, 40)));
    values.push_back(*value);
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
  check_field(field, path.string());
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
  vertex.add_vectors("", Type::float64, field.positions);
  vertex.properties.push_back({"amplitude", Type::float64, false, field.amplitude});
  std::vector<double> corners, phases;
  auto edges = edges_of(field);
  std::vector<double> omega(edges.size(), 0.0);
  for (std::size_t t = 0; t < field.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = field.triangles[t][c], b = field.triangles[t][(c + 1) % 3];
      corners.push_back(a);
      phases.push_back(field.phase[t][c]);
      const double difference = field.phase[t][(c + 1) % 3] - field.phase[t][c];
      omega[edges.at(std::minmax(a, b))] = a < b ? difference : -difference;
    }
  }
  face.add_lists("vertex_indices", Type::uint32, 3, std::move(corners));
  face.add_lists("phase", Type::float64, 3, std::move(phases));
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
