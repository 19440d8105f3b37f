#include "cloth/base_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "base/colour.h"
#include "base/eigen_glm.h"
#include "io/ply.h"
#include "shell/unroll.h"

namespace plisse::cloth {
namespace {

using io::PlyProperty;

// MeshLab's uv of corners.
void add_uv(const std::vector<std::array<Eigen::Vector2d, 3>>& uv, io::PlyElement& triangles) {
  std::vector<double> values;
  values.reserve(6 * uv.size());
  for (const auto& corners : uv)
    for (const Eigen::Vector2d& at : corners) values.insert(values.end(), {at.x(), at.y()});
  triangles.add_lists("texcoord", PlyProperty::Type::float32, 6, std::move(values));
}

// And its number of the picture; sRGB colours where not all are white.
void add_parts(const ClothLook& look, bool pictures, io::PlyElement& triangles) {
  const auto of_faces = [&](const char* name, PlyProperty::Type type, const auto& value) {
    PlyProperty& property = triangles.properties.emplace_back(PlyProperty{name, type});
    for (const std::uint32_t part : look.part) property.values.push_back(value(look.parts[part]));
  };
  if (pictures)
    of_faces("texnumber", PlyProperty::Type::int32, [](const auto& part) { return double(part.picture); });
  if (std::ranges::all_of(look.parts, [](const auto& part) { return part.base_colour == glm::vec4(1); }))
    return;
  constexpr const char* channels[] = {"red", "green", "blue", "alpha"};
  for (int c = 0; c < 4; ++c)
    of_faces(channels[c], PlyProperty::Type::uint8, [c](const auto& part) {
      const double value = std::clamp(double(part.base_colour[c]), 0.0, 1.0);
      return std::round(255 * (c < 3 ? linear_to_srgb(value) : value));
    });
}

}  // namespace

void write_base(const std::filesystem::path& path, const std::string& title, const WrinkleScene& base,
                const std::string& stopped, const std::vector<std::string>& pictures) {
  const shell::Material& material = base.material;
  const std::vector<shell::Face>& faces = base.surface.topology.faces;
  io::Ply ply;
  ply.comments = {title, fmt::format("young {}", material.young), fmt::format("poisson {}", material.poisson),
                  fmt::format("thickness {}", material.thickness),
                  fmt::format("density {}", material.density)};
  if (!base.chords) ply.comments.push_back("chords none");
  if (base.tension_limit > 0) ply.comments.push_back(fmt::format("tension_limit {}", base.tension_limit));
  for (const std::string& picture : pictures) ply.comments.push_back("TextureFile " + picture);
  if (!stopped.empty()) ply.comments.push_back("not converged: " + stopped);
  io::PlyElement vertices{"vertex", static_cast<std::size_t>(base.surface.positions.cols())},
      triangles{"face", faces.size()};
  vertices.add_vectors("", PlyProperty::Type::float64, points_to_glm(base.surface.positions));
  PlyProperty& holds = vertices.properties.emplace_back(PlyProperty{"held", PlyProperty::Type::uint8});
  for (const bool is_held : base.held) holds.values.push_back(is_held ? 1 : 0);
  if (!base.room.empty()) {
    constexpr double endless = 1e6;  // m: files have finite numbers
    PlyProperty& room = vertices.properties.emplace_back(PlyProperty{"room", PlyProperty::Type::float64});
    for (const double most : base.room) room.values.push_back(std::min(most, endless));
  }
  std::vector<double> corners, flat;
  for (const shell::Face& face : faces) corners.insert(corners.end(), face.begin(), face.end());
  for (const shell::RestFace& face : base.surface.rest)
    flat.insert(flat.end(), {0, 0, face.edges(0, 0), face.edges(1, 0), face.edges(0, 1), face.edges(1, 1)});
  triangles.add_lists("vertex_indices", PlyProperty::Type::int32, 3, std::move(corners));
  triangles.add_lists("rest", PlyProperty::Type::float64, 6, std::move(flat));
  if (base.look && !base.look->uv.empty())
    add_uv(base.look->uv, triangles);
  else
    add_uv(shell::unrolled(base.surface.topology, base.surface.rest), triangles);
  if (base.look) add_parts(*base.look, !pictures.empty(), triangles);
  ply.elements = {std::move(vertices), std::move(triangles)};
  io::write_ply(path, ply);
}

bool is_base(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  constexpr int most_lines = 1000;  // of a header
  std::string line;
  bool faces = false;
  for (int n = 0; n < most_lines && std::getline(file, line); ++n) {
    if (line.starts_with("end_header")) return !faces;
    faces = faces || line.starts_with("element face");
    if (line.starts_with("property list ") && line.find(" rest") != std::string::npos) return true;
  }
  return true;
}

}  // namespace plisse::cloth
