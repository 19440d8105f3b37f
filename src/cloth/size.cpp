#include "cloth/size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/atomic_file.h"
#include "base/log.h"
#include "cloth/size_picture.h"
#include "config/panel_file.h"
#include "io/png.h"
#include "sizing/sample.h"

namespace plisse::cloth {
namespace {

using sizing::Panel;
using sizing::SizedPanel;

// In OBJ names a space ends the name.
std::string one_word(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n'; }, '_');
  return text;
}

// Vertices in the plane z = 0, metres; uv are panel coordinates. Lines of the outline and of each feature are
// groups of line elements.
std::string obj_text(const Panel& panel, const SizedPanel& sized) {
  std::string text =
      fmt::format("# plisse size: metres; uv = panel coordinates\no {}\n", one_word(panel.name));
  for (const auto& v : sized.mesh.vertices)
    fmt::format_to(std::back_inserter(text), "v {:.9g} {:.9g} 0\n", v.x, v.y);
  for (const auto& v : sized.mesh.vertices)
    fmt::format_to(std::back_inserter(text), "vt {:.9g} {:.9g}\n", v.x, v.y);
  for (const auto& [a, b, c] : sized.mesh.triangles)
    fmt::format_to(std::back_inserter(text), "f {0}/{0} {1}/{1} {2}/{2}\n", a + 1, b + 1, c + 1);
  const auto group = [&](const std::string& name, const auto& wanted) {
    std::string lines;
    for (const auto& edge : sized.mesh.line_edges) {
      if (wanted(sized.domain.lines[edge.line]))
        fmt::format_to(std::back_inserter(lines), "l {} {}\n", edge.a + 1, edge.b + 1);
    }
    if (!lines.empty()) text += fmt::format("g {}\n{}", one_word(name), lines);
  };
  group("outline", [](const auto& line) { return line.boundary; });
  for (std::size_t f = 0; f < panel.features.size(); ++f) {
    group(panel.features[f].name, [&](const auto& line) {
      return std::find(line.features.begin(), line.features.end(), static_cast<int>(f)) !=
             line.features.end();
    });
  }
  return text;
}

// The mesh with the sizing map at its vertices: resolution in weft and warp, and the map's colour.
std::string ply_text(const SizedPanel& sized, const SizeScale& scale) {
  const auto& mesh = sized.mesh;
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\ncomment plisse size: metres; s, t = panel coordinates; weft, warp = edge "
      "length wanted\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\nproperty double "
      "s\nproperty double t\n"
      "property float weft\nproperty float warp\nproperty uchar red\nproperty uchar green\nproperty uchar "
      "blue\n"
      "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto& v = mesh.vertices[i];
    const glm::dvec2 r = sized.map->resolution(sized.domain.to_working * v);
    const auto colour = scale.colour(mesh.sizes[i]);
    fmt::format_to(std::back_inserter(text),
                   "{0:.9g} {1:.9g} 0 {0:.9g} {1:.9g} {2:.6g} {3:.6g} {4} {5} {6}\n", v.x, v.y, r.x, r.y,
                   colour[0], colour[1], colour[2]);
  }
  for (const auto& [a, b, c] : mesh.triangles)
    fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", a, b, c);
  return text;
}

// Panels as groups of faces, seams as groups of lines.
std::string garment_text(const sizing::Garment& garment, const sizing::SizedGarment& sewn) {
  std::string text = "# plisse size: panels sewn to one mesh; metres; uv = panel coordinates\no garment\n";
  const auto out = std::back_inserter(text);
  for (const glm::dvec3& p : sewn.positions) fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
  for (const auto& panel : sewn.panels)
    for (const glm::dvec2& p : panel->mesh.vertices) fmt::format_to(out, "vt {:.9g} {:.9g}\n", p.x, p.y);
  for (std::size_t p = 0; p < sewn.panels.size(); ++p) {
    fmt::format_to(out, "g {}\n", one_word(garment.panels[p].name));
    for (const auto& triangle : sewn.panels[p]->mesh.triangles) {
      text += 'f';
      for (const std::uint32_t corner : triangle) {
        const std::uint32_t uv = sewn.first[p] + corner;
        fmt::format_to(out, " {}/{}", sewn.sewn[uv] + 1, uv + 1);
      }
      text += '\n';
    }
  }
  for (std::size_t s = 0; s < sewn.seam_edges.size(); ++s) {
    fmt::format_to(out, "g {}\n", one_word(garment.seams[s].name));
    for (const auto& [a, b] : sewn.seam_edges[s]) fmt::format_to(out, "l {} {}\n", a + 1, b + 1);
  }
  return text;
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

SizeReport size_panels(const SizeRequest& request) {
  const config::PanelFile file =
      config::load_panels(request.panels, request.fabric ? &*request.fabric : nullptr);
  const bool sewn = !file.garment.seams.empty();
  sizing::SizedGarment garment;
  if (sewn) garment = sizing::mesh_garment(file.garment, file.options);
  SizeReport report;
  for (std::size_t p = 0; p < file.garment.panels.size(); ++p) {
    const Panel& panel = sewn ? garment.made[p] : file.garment.panels[p];
    const auto alone = sewn ? nullptr : sizing::mesh_panel(panel, file.options);
    const SizedPanel* const sized = sewn ? garment.panels[p].get() : alone.get();
    for (const std::string& warning : sized->domain.warnings) log::warn(warning);
    report.panels.push_back(figures(panel, *sized));

    const SizeScale scale(*sized);
    io::PngOptions small;
    small.level = 6;  // once a panel, and smooth maps pack well
    const auto path = [&](const char* suffix) {
      return report.files.emplace_back(request.folder / (panel.name + suffix));
    };
    write_whole_file(path(".obj"), obj_text(panel, *sized));
    write_whole_file(path(".ply"), ply_text(*sized, scale));
    io::write_png(path("_map.png"), draw_size_map(panel, *sized, scale), small);
    io::write_png(path("_mesh.png"), draw_size_mesh(panel, *sized, scale), small);
  }
  if (sewn) {
    report.garment = {garment.vertices, 0, garment.joins};
    for (const auto& panel : garment.panels) report.garment->triangles += panel->mesh.triangles.size();
    write_whole_file(report.files.emplace_back(request.folder / "garment.obj"),
                     garment_text(file.garment, garment));
  }
  return report;
}

}  // namespace plisse::cloth
