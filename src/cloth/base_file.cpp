#include "cloth/base_file.h"

#include <fmt/format.h>

#include <fstream>

#include "base/eigen_glm.h"
#include "io/ply.h"

namespace plisse::cloth {

void write_base(const std::filesystem::path& path, const std::string& title, const WrinkleScene& base,
                const std::string& stopped) {
  using io::PlyProperty;
  const shell::Material& material = base.material;
  const std::vector<shell::Face>& faces = base.surface.topology.faces;
  io::Ply ply;
  ply.comments = {title, fmt::format("young {}", material.young), fmt::format("poisson {}", material.poisson),
                  fmt::format("thickness {}", material.thickness),
                  fmt::format("density {}", material.density)};
  if (!base.chords) ply.comments.push_back("chords none");
  if (base.tension_limit > 0) ply.comments.push_back(fmt::format("tension_limit {}", base.tension_limit));
  if (!stopped.empty()) ply.comments.push_back("not converged: " + stopped);
  io::PlyElement vertices{"vertex", static_cast<std::size_t>(base.surface.positions.cols())},
      triangles{"face", faces.size()};
  vertices.add_vectors("", PlyProperty::Type::float64, points_to_glm(base.surface.positions));
  PlyProperty& holds = vertices.properties.emplace_back(PlyProperty{"held", PlyProperty::Type::uint8});
  for (const bool is_held : base.held) holds.values.push_back(is_held ? 1 : 0);
  std::vector<double> corners, flat;
  for (const shell::Face& face : faces) corners.insert(corners.end(), face.begin(), face.end());
  for (const shell::RestFace& face : base.surface.rest)
    flat.insert(flat.end(), {0, 0, face.edges(0, 0), face.edges(1, 0), face.edges(0, 1), face.edges(1, 1)});
  triangles.add_lists("vertex_indices", PlyProperty::Type::int32, 3, std::move(corners));
  triangles.add_lists("rest", PlyProperty::Type::float64, 6, std::move(flat));
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
