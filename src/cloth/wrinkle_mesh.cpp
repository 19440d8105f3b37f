#include "cloth/wrinkle_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/eigen_glm.h"
#include "base/error.h"
#include "mesh/subdivide.h"
#include "shell/unroll.h"

namespace plisse::cloth {
namespace {

constexpr double most_by_itself = 1e6, most_at_all = 3e7;  // triangles

int checked_levels(std::size_t triangles, int levels) {
  const double fine = static_cast<double>(triangles) * std::exp2(2 * levels);
  if (fine > most_at_all)
    throw Error(ExitCode::bad_input,
                fmt::format("--levels {}: {} faces would become {:.0f}, more than {:.0f}; take fewer levels",
                            levels, triangles, fine, most_at_all));
  return levels;
}

}  // namespace

WrinkleMesh wrinkle_mesh(const std::string& name, const wrinkle::BaseSurface& surface,
                         const wrinkle::CoarseField& field, std::optional<int> levels, bool with_v2,
                         const ClothLook& look, Eigen::Matrix3Xd lean) {
  const std::size_t faces = surface.topology.faces.size();
  const double waves = wrinkle::largest_step(surface, field) / (2 * std::numbers::pi);
  WrinkleMesh result;
  result.levels = levels ? checked_levels(faces, *levels) : levels_for(waves, faces, most_by_itself);
  wrinkle::FineField fine = wrinkle::upsample(
      surface, field, result.levels,
      {std::move(lean), look.uv.empty() ? shell::unrolled(surface.topology, surface.rest) : look.uv});
  const shell::Positions moved = wrinkle::displaced(fine, with_v2);
  io::MeshFile& file = result.file;
  file.positions = points_to_glm(moved);
  file.normals = points_to_glm(wrinkle::vertex_normals(fine.faces, moved));
  // A vertex has as many copies as it has texture coordinates; the first keeps its number.
  constexpr std::uint32_t none = ~std::uint32_t{0};
  const auto count = static_cast<std::uint32_t>(file.positions.size());
  file.vertices.resize(count);
  std::vector<std::uint32_t> next_copy(count, none);
  std::vector<bool> given(count, false);
  const auto add = [&](std::size_t f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = fine.faces[f][c];
      const glm::vec2 uv(fine.uv[f][c].x(), fine.uv[f][c].y());
      std::uint32_t at = v;
      if (!given[v]) {
        given[v] = true;
        file.vertices[v] = {v, v, uv, glm::vec4(1)};
      }
      while (glm::distance(file.vertices[at].uv, uv) > 1e-6F) {
        if (next_copy[at] == none) {
          next_copy[at] = static_cast<std::uint32_t>(file.vertices.size());
          next_copy.push_back(none);
          file.vertices.push_back({v, v, uv, glm::vec4(1)});
        }
        at = next_copy[at];
      }
      file.triangles.push_back(at);
    }
  };
  std::vector<ClothLook::Part> parts = look.parts;
  if (parts.empty()) parts.push_back({name, "cloth"});
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    const auto first = static_cast<std::uint32_t>(file.triangles.size() / 3);
    for (std::size_t f = 0; f < fine.faces.size(); ++f)
      if (look.parts.empty() || look.part[fine.base_face[f]] == p) add(f);
    const auto triangles = static_cast<std::uint32_t>(file.triangles.size() / 3) - first;
    if (triangles > 0)
      file.parts.push_back(
          {parts[p].mesh, parts[p].material, parts[p].base_colour, true, true, false, first, triangles});
  }
  for (std::uint32_t v = 0; v < count; ++v) {
    if (!given[v]) file.vertices[v] = {v, v, glm::vec2(0), glm::vec4(1)};  // of no face
  }
  return result;
}

}  // namespace plisse::cloth
