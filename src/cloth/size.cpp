#include "cloth/size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/log.h"
#include "cloth/size_picture.h"
#include "config/panel_file.h"
#include "io/obj.h"
#include "io/picture/png.h"
#include "io/ply.h"
#include "sizing/sample.h"

namespace plisse::cloth {
namespace {

using sizing::Panel;
using sizing::SizedPanel;

io::ObjFile::Corner corner(std::size_t position, std::size_t uv) {
  return {static_cast<std::int32_t>(position), static_cast<std::int32_t>(uv)};
}

// Vertices in the plane z = 0, metres; uv are panel coordinates. Lines of the outline and of each feature are
// groups of line elements.
void write_obj(const std::filesystem::path& path, const Panel& panel, const SizedPanel& sized) {
  io::ObjWriter obj("plisse size: metres; uv = panel coordinates", panel.name);
  for (const auto& v : sized.mesh.vertices) obj.position({v, 0});
  for (const auto& v : sized.mesh.vertices) obj.uv(v);
  for (const auto& [a, b, c] : sized.mesh.triangles) obj.face({corner(a, a), corner(b, b), corner(c, c)});
  const auto group = [&](const std::string& name, const auto& wanted) {
    bool named = false;
    for (const auto& edge : sized.mesh.line_edges) {
      if (!wanted(sized.domain.lines[edge.line])) continue;
      if (!named) obj.group(name);
      named = true;
      obj.line(edge.a, edge.b);
    }
  };
  group("outline", [](const auto& line) { return line.boundary; });
  for (std::size_t f = 0; f < panel.features.size(); ++f) {
    group(panel.features[f].name, [&](const auto& line) {
      return std::find(line.features.begin(), line.features.end(), static_cast<int>(f)) !=
             line.features.end();
    });
  }
  obj.write(path);
}

// The mesh with the sizing map at its vertices: resolution in weft and warp, and the map's colour.
void write_ply(const std::filesystem::path& path, const SizedPanel& sized, const SizeScale& scale) {
  using Type = io::PlyProperty::Type;
  const auto& mesh = sized.mesh;
  io::PlyElement vertex{"vertex",
                        mesh.vertices.size(),
                        {{"x"},
                         {"y"},
                         {"z"},
                         {"s"},
                         {"t"},
                         {"weft", Type::float32},
                         {"warp", Type::float32},
                         {"red", Type::uint8},
                         {"green", Type::uint8},
                         {"blue", Type::uint8}}};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto& v = mesh.vertices[i];
    const glm::dvec2 r = sized.map->resolution(sized.domain.to_working * v);
    const auto colour = scale.colour(mesh.sizes[i]);
    const double values[] = {v.x,
                             v.y,
                             0,
                             v.x,
                             v.y,
                             r.x,
                             r.y,
                             static_cast<double>(colour[0]),
                             static_cast<double>(colour[1]),
                             static_cast<double>(colour[2])};
    for (std::size_t p = 0; p < vertex.properties.size(); ++p)
      vertex.properties[p].values.push_back(values[p]);
  }
  std::vector<double> corners;
  for (const auto& triangle : mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  io::PlyElement face{"face", mesh.triangles.size()};
  face.add_lists("vertex_indices", Type::uint32, 3, std::move(corners));
  io::write_ply(path,
                {{"plisse size: metres; s, t = panel coordinates; weft, warp = edge length wanted"},
                 {std::move(vertex), std::move(face)}},
                io::PlyFormat::ascii);
}

// Panels as groups of faces, seams as groups of lines.
void write_garment(const std::filesystem::path& path, const sizing::Garment& garment,
                   const sizing::SizedGarment& sewn) {
  io::ObjWriter obj("plisse size: panels sewn to one mesh; metres; uv = panel coordinates", "garment");
  for (const glm::dvec3& p : sewn.positions) obj.position(p);
  for (const auto& panel : sewn.panels)
    for (const glm::dvec2& p : panel->mesh.vertices) obj.uv(p);
  for (std::size_t p = 0; p < sewn.panels.size(); ++p) {
    obj.group(garment.panels[p].name);
    const auto at = [&](std::uint32_t v) { return corner(sewn.sewn[sewn.first[p] + v], sewn.first[p] + v); };
    for (const auto& [a, b, c] : sewn.panels[p]->mesh.triangles) obj.face({at(a), at(b), at(c)});
  }
  for (std::size_t s = 0; s < sewn.seam_edges.size(); ++s) {
    obj.group(garment.seams[s].name);
    for (const auto& [a, b] : sewn.seam_edges[s]) obj.line(a, b);
  }
  obj.write(path);
}

double area_of(const Panel& panel) {
  double area = std::abs(signed_area(panel.outline));
  for (const auto& hole : panel.holes) area -= std::abs(signed_area(hole));
  return area;
}

SizeReport::Panel figures(const Panel& panel, const SizedPanel& sized) {
  SizeReport::Panel report;
  report.name = panel.name;
  report.fabric_resolution = sized.domain.resolution;
  report.vertices = sized.mesh.vertices.size();
  report.triangles = sized.mesh.triangles.size();
  report.quality = sized.quality;
  report.seconds = sized.seconds;
  report.finest = std::min(sized.domain.resolution.x, sized.domain.resolution.y);
  for (std::size_t f = 0; f < panel.features.size(); ++f) {
    double resolution = std::min(sized.domain.resolution.x, sized.domain.resolution.y);
    for (const sizing::Source& source : sized.sources) {
      if (source.feature == static_cast<int>(f))
        resolution = std::min({resolution, source.weft.source, source.warp.source});
    }
    report.features.push_back({panel.features[f].name, name_of(panel.features[f].rule), resolution});
    report.finest = std::min(report.finest, resolution);
  }
  report.uniform_vertices = sizing::vertex_density * area_of(panel) / (report.finest * report.finest) +
                            panel.outline.length() / report.finest / 2 + 1;
  return report;
}

}  // namespace

sizing::SizedGarment mesh_panels(const config::PanelFile& file) {
  sizing::SizedGarment garment;
  if (file.garment.seams.empty()) {
    garment.made = file.garment.panels;
    for (const Panel& panel : garment.made) garment.panels.push_back(sizing::mesh_panel(panel, file.options));
  } else {
    garment = sizing::mesh_garment(file.garment, file.options);
  }
  for (const auto& sized : garment.panels)
    for (const std::string& warning : sized->domain.warnings) log::warn(warning);
  return garment;
}

SizeReport size_panels(const SizeRequest& request) {
  const config::PanelFile file =
      config::load_panels(request.panels, request.fabric ? &*request.fabric : nullptr);
  const sizing::SizedGarment garment = mesh_panels(file);
  SizeReport report;
  for (std::size_t p = 0; p < garment.panels.size(); ++p) {
    const Panel& panel = garment.made[p];
    const SizedPanel* const sized = garment.panels[p].get();
    report.panels.push_back(figures(panel, *sized));

    const SizeScale scale(*sized);
    io::PngOptions small;
    small.level = io::PngLevel::small;  // once a panel, and smooth maps pack well
    const auto path = [&](const char* suffix) {
      return report.files.emplace_back(request.folder / (panel.name + suffix));
    };
    write_obj(path(".obj"), panel, *sized);
    write_ply(path(".ply"), *sized, scale);
    io::write_png(path("_map.png"), draw_size_map(panel, *sized, scale), small);
    io::write_png(path("_mesh.png"), draw_size_mesh(panel, *sized, scale), small);
  }
  if (!file.garment.seams.empty()) {
    report.garment = {garment.vertices, 0, garment.joins};
    for (const auto& panel : garment.panels) report.garment->triangles += panel->mesh.triangles.size();
    write_garment(report.files.emplace_back(request.folder / "garment.obj"), file.garment, garment);
  }
  return report;
}

}  // namespace plisse::cloth
