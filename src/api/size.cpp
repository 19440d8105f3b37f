// <plisse/size.h>: fabrics and panels.
#include "plisse/size.h"

#include "api/convert.h"
#include "base/error.h"
#include "cloth/size.h"
#include "config/fabric.h"
#include "config/panel_file.h"
#include "sizing/garment.h"
#include "sizing/resolution.h"
#include "sizing/rules.h"

namespace plisse {
namespace {

sizing::Fabric to_sizing(const Fabric& fabric) {
  sizing::Fabric result;
  result.name = "given";
  result.weft = {fabric.weft.bending, fabric.weft.modulus};
  result.warp = {fabric.warp.bending, fabric.warp.modulus};
  result.poisson_ratio = fabric.poisson_ratio;
  return result;
}

sizing::Polyline closed_line(const std::vector<Vector2>& points) {
  sizing::Polyline line;
  line.closed = true;
  for (const Vector2& p : points) line.points.emplace_back(p[0], p[1]);
  return line;
}

config::PanelFile panels_of(const SizeRequest& request) {
  if (request.panels.empty() == request.file.empty())
    throw Error(ExitCode::bad_input, "size_panels: give either panels or a file");
  std::optional<sizing::Fabric> fabric;
  if (request.fabric) fabric = to_sizing(*request.fabric);
  if (!request.file.empty()) return config::load_panels(request.file, fabric ? &*fabric : nullptr);
  config::PanelFile file;
  for (const Panel& given : request.panels) {
    sizing::Panel& panel = file.garment.panels.emplace_back();
    panel.name = given.name;
    panel.fabric = fabric ? *fabric : to_sizing(given.fabric);
    panel.grain = given.grain;
    panel.outline = closed_line(given.outline);
    for (const auto& hole : given.holes) panel.holes.push_back(closed_line(hole));
  }
  return file;
}

MeshedPanel meshed(const std::string& name, const sizing::SizedPanel& sized) {
  MeshedPanel panel;
  panel.name = name;
  panel.edge_length = sized.mesh.sizes;
  panel.edges_within = sized.quality.edges_within;
  panel.least_angle = sized.quality.least_angle;
  panel.mesh.triangles = sized.mesh.triangles;
  for (const glm::dvec2& v : sized.mesh.vertices) panel.mesh.positions.push_back({v.x, v.y, 0});
  for (const Triangle& t : sized.mesh.triangles) {
    auto& uv = panel.mesh.uv.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) uv[c] = {sized.mesh.vertices[t[c]].x, sized.mesh.vertices[t[c]].y};
  }
  return panel;
}

Mesh sewn_mesh(const std::vector<MeshedPanel>& panels, const sizing::SizedGarment& garment) {
  Mesh mesh;
  mesh.positions = api::points_from(garment.positions);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const Mesh& panel = panels[p].mesh;
    mesh.parts.push_back({panels[p].name, "", static_cast<std::uint32_t>(mesh.triangles.size()),
                          static_cast<std::uint32_t>(panel.triangles.size())});
    for (Triangle t : panel.triangles) {
      for (std::uint32_t& v : t) v = garment.sewn[garment.first[p] + v];
      mesh.triangles.push_back(t);
    }
    mesh.uv.insert(mesh.uv.end(), panel.uv.begin(), panel.uv.end());
  }
  return mesh;
}

}  // namespace

Fabric find_fabric(std::string_view text) {
  const sizing::Fabric found = config::parse_fabric(std::string(text));
  return {{found.weft.bending, found.weft.modulus},
          {found.warp.bending, found.warp.modulus},
          found.poisson_ratio};
}

double edge_length(const Stiffness& stiffness) {
  return sizing::fabric_resolution(sizing::resolution_law(), {stiffness.bending, stiffness.modulus});
}

MeshedPanels size_panels(const SizeRequest& request) {
  const log::Scope scope(api::sink_of(request.messages));
  const config::PanelFile file = panels_of(request);
  const sizing::SizedGarment garment = cloth::mesh_panels(file);
  MeshedPanels result;
  for (std::size_t p = 0; p < garment.panels.size(); ++p)
    result.panels.push_back(meshed(garment.made[p].name, *garment.panels[p]));
  if (!file.garment.seams.empty()) result.garment = sewn_mesh(result.panels, garment);
  return result;
}

}  // namespace plisse
