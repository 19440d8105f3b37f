#include "scene/load_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "base/log.h"
#include "config/fabric.h"
#include "config/panel_file.h"
#include "io/import.h"
#include "io/point_cache.h"
#include "sizing/garment.h"

namespace plisse::scene {
namespace {

// Panels without a placement, in a row: a tenth of the widest apart, with their lower edges at the same
// height.
std::vector<sizing::Placement> row_of(const std::vector<sizing::Panel>& panels) {
  std::vector<glm::dvec2> lows, sizes;
  double widest = 0;
  for (const sizing::Panel& panel : panels) {
    glm::dvec2 low = panel.outline.points.front(), high = low;
    for (const glm::dvec2& point : panel.outline.points) {
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
    lows.push_back(low);
    sizes.push_back(high - low);
    widest = std::max(widest, high.x - low.x);
  }
  std::vector<sizing::Placement> row;
  double x = 0;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    row.push_back({glm::dmat3(1), {x - lows[p].x, -lows[p].y, 0}});
    x += sizes[p].x + 0.1 * widest;
  }
  return row;
}

void warn_of_gaps(const std::filesystem::path& file, const sizing::SizedGarment& sewn) {
  const sizing::SizedGarment::Join* widest = nullptr;
  for (const auto& join : sewn.joins)
    if (widest == nullptr || join.gap > widest->gap) widest = &join;
  if (widest != nullptr && widest->gap > 1e-3 * std::max(widest->length_a, widest->length_b))
    log::notice(fmt::format(
        "{}: seam '{}' is drawn together over {:.3g} m, which stretches the rest pose beside it; where a "
        "cache moves the garment, rest = \"frame:1\" is better",
        file.string(), widest->name, widest->gap));
}

io::Model garment_model(const config::SceneSettings& scene) {
  const config::ModelSettings& settings = scene.model;
  std::optional<sizing::Fabric> fabric;
  if (!settings.fabric.empty()) fabric = config::parse_fabric(settings.fabric);
  config::PanelFile file = config::load_panels(settings.garment, fabric ? &*fabric : nullptr);
  config::keep_pieces(file, settings.pieces);
  sizing::Garment& garment = file.garment;
  if (garment.placements.empty() && garment.seams.empty()) garment.placements = row_of(garment.panels);
  const sizing::SizedGarment sewn = sizing::mesh_garment(garment, file.options);
  warn_of_gaps(settings.garment, sewn);

  io::Model model;
  model.path = settings.garment;
  model.file_vertex_count = sewn.vertices;
  io::Node& node = model.nodes.emplace_back();
  node.name = settings.garment.stem().string();
  for (std::size_t p = 0; p < sewn.panels.size(); ++p) {
    const sizing::PanelMesh& sized = sewn.panels[p]->mesh;
    for (const std::string& warning : sewn.panels[p]->domain.warnings) log::warn(warning);
    io::Mesh& mesh = model.meshes.emplace_back();
    mesh.name = garment.panels[p].name;
    for (std::size_t v = 0; v < sized.vertices.size(); ++v) {
      const std::uint32_t joined = sewn.sewn[sewn.first[p] + v];
      mesh.positions.push_back(sewn.positions[joined]);
      mesh.uvs.emplace_back(sized.vertices[v]);
      mesh.file_vertices.push_back(joined);
    }
    for (const auto& triangle : sized.triangles)
      mesh.triangles.insert(mesh.triangles.end(), triangle.begin(), triangle.end());
    node.meshes.push_back(static_cast<int>(p));
  }
  return model;
}

}  // namespace

io::ImportOptions import_options(const config::SceneSettings& scene) {
  io::ImportOptions options;
  if (scene.model.metres_per_unit > 0) options.metres_per_unit = scene.model.metres_per_unit;
  options.up = scene.model.up;
  options.cache = scene.model.cache;
  options.limits = scene.limits;
  return options;
}

io::Model load_model(const config::SceneSettings& scene) {
  const config::ModelSettings& settings = scene.model;
  const io::ImportOptions options = import_options(scene);
  if (settings.garment.empty()) return io::import_model(settings.path, options);
  const auto place = scene.places.find("model.garment");
  const std::string who = place == scene.places.end() ? settings.garment.string() : place->second;
  if (options.metres_per_unit || !options.up.empty())
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: a panel file says its own unit, and y is up; leave 'units' and 'up' out", who));
  io::Model model;
  try {
    model = garment_model(scene);
  } catch (const Error& error) {
    throw Error(error.code, fmt::format("{}: {}", who, error.what()));
  }
  io::validate(model, options.limits);
  if (!options.cache.empty()) {
    model.cache = io::read_point_cache(options.cache, model);
    io::validate(model, options.limits);
  }
  return model;
}

}  // namespace plisse::scene
