// plisse size: how fine the mesh of a fabric must be; for panels, the meshes.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "cli/size_options.h"
#include "cloth/size.h"
#include "config/suggest.h"
#include "sizing/fabric.h"
#include "sizing/resolution.h"

namespace plisse::cli {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  explicit Arguments(CommandOptions& options) : common(options) {
    options.add(
        "panels", panels, "PANEL.toml|PATTERN.json",
        described("A panel file (docs/sizing.md): outlines, fabrics, features, seams; or a GarmentCode "
                  "pattern, with --fabric. Meshes and sizing maps are written"));
    options.add("-o,--output", folder, "DIR",
                "Where the files of a panel file go; by default a folder of its name");
    options.add(
        "--fabric", fabric, "B,E|NAME",
        described("A fabric by name, or bending stiffness and Young's modulus, units allowed: "
                  "\"2e-6,3e5\" (N·m, N/m²), \"0.02 gf·cm²/cm,0.3 MPa\"; four numbers: weft, then warp"));
    options.add("--fabric-range", range, "Bmin,Bmax,Emin,Emax,rmin,rmax",
                described("What a system takes for its extremes; default 1e-9,1e-3,2e3,2e6,2.5mm,50mm"));
    options.flag("--list-fabrics", list, "Print the known fabrics and end");
  }

  CommonArguments common;
  std::string panels, folder, fabric, range;
  bool list = false;
};

ordered_json to_json(const sizing::ResolutionLaw& law, const sizing::FabricRange& range,
                     const sizing::Stiffness& stiffness) {
  const double y = stiffness.bending / stiffness.modulus;
  return {{"resolution_mm", 1e3 * sizing::fabric_resolution(law, stiffness)},
          {"y_m3", y},
          {"c1", law.c1},
          {"c2", law.c2},
          {"in_range", y >= range.ratio_min() && y <= range.ratio_max()}};
}

std::string fabric_list(const sizing::ResolutionLaw& law) {
  std::string text = "fabric          B weft/warp, N·m   E weft/warp, N/m²  r weft/warp, mm  from\n";
  for (const sizing::Fabric& fabric : sizing::fabrics()) {
    const auto pair = [&](double weft, double warp) {
      return fabric.isotropic() ? fmt::format("{:.4g}", weft) : fmt::format("{:.4g}/{:.4g}", weft, warp);
    };
    text += padded(fabric.name, 16) + padded(pair(fabric.weft.bending, fabric.warp.bending), 19) +
            padded(pair(fabric.weft.modulus, fabric.warp.modulus), 19) +
            padded(pair(1e3 * fabric_resolution(law, fabric.weft), 1e3 * fabric_resolution(law, fabric.warp)),
                   17) +
            fabric.source + "\n";
  }
  return text;
}

int size_fabric(const Arguments& arguments, const sizing::FabricRange& range,
                const sizing::ResolutionLaw& law) {
  const sizing::Fabric fabric = fabric_option(arguments.fabric);
  ordered_json report = to_json(law, range, fabric.weft);
  if (!fabric.isotropic()) {
    report["weft"] = to_json(law, range, fabric.weft);
    report["warp"] = to_json(law, range, fabric.warp);
    if (report["warp"]["resolution_mm"] < report["weft"]["resolution_mm"]) report.update(report["warp"]);
    report["ratio"] =
        report["warp"]["resolution_mm"].get<double>() / report["weft"]["resolution_mm"].get<double>();
  }
  if (arguments.common.tables_wanted()) {
    const auto line = [&](const char* what, const ordered_json& of) {
      return fmt::format("{}r = {:.3f} mm   y = B/E = {:.4g} m³{}\n", what, of["resolution_mm"].get<double>(),
                         of["y_m3"].get<double>(),
                         of["in_range"].get<bool>() ? ""
                                                    : fmt::format("   outside the range {:.4g} to {:.4g} m³",
                                                                  range.ratio_min(), range.ratio_max()));
    };
    std::string text;
    if (fabric.isotropic()) {
      text = line("", report);
    } else {
      text = line("weft  ", report["weft"]) + line("warp  ", report["warp"]);
    }
    write_stdout(text + fmt::format("c₁ = {:.6g} m⁻³, c₂ = {:.6g} m⁻¹\n", law.c1, law.c2));
  }
  write_report(report, arguments.common.json());
  return 0;
}

ordered_json to_json(const cloth::SizeReport::Panel& panel) {
  ordered_json features = ordered_json::array();
  for (const cloth::SizeReport::Feature& feature : panel.features) {
    features.push_back(
        {{"name", feature.name}, {"rule", feature.rule}, {"resolution_mm", 1e3 * feature.resolution}});
  }
  return {{"name", panel.name},
          {"resolution_mm",
           {{"weft", 1e3 * panel.fabric_resolution.x}, {"warp", 1e3 * panel.fabric_resolution.y}}},
          {"features", features},
          {"vertices", panel.vertices},
          {"triangles", panel.triangles},
          {"expected_vertices", panel.quality.expected_vertices},
          {"uniform_vertices", panel.uniform_vertices},
          {"edges_within_half_and_double", panel.quality.edges_within},
          {"min_angle_deg", panel.quality.least_angle},
          {"exempt_triangles", panel.quality.exempt},
          {"mean_edge", panel.quality.mean_edge},
          {"edge_length_ratio", panel.quality.length_ratio},
          {"lost_m", panel.quality.lost},
          {"map_s", panel.seconds.map},
          {"sample_s", panel.seconds.sample},
          {"triangulate_s", panel.seconds.triangulate},
          {"improve_s", panel.seconds.improve}};
}

// The panels one by one, and over all of them the keys that docs/contract.md promises.
ordered_json to_json(const cloth::SizeReport& report) {
  ordered_json panels = ordered_json::array(), features = ordered_json::array(),
               outputs = ordered_json::array();
  std::size_t vertices = 0, triangles = 0;
  double expected = 0, within = 1, angle = 180, map = 0, sample = 0, triangulate = 0;
  for (const cloth::SizeReport::Panel& panel : report.panels) {
    panels.push_back(to_json(panel));
    for (const ordered_json& feature : panels.back()["features"]) features.push_back(feature);
    vertices += panel.vertices;
    triangles += panel.triangles;
    expected += panel.quality.expected_vertices;
    within = std::min(within, panel.quality.edges_within);
    angle = std::min(angle, panel.quality.least_angle);
    map += panel.seconds.map;
    sample += panel.seconds.sample;
    triangulate += panel.seconds.triangulate + panel.seconds.improve;
  }
  for (const auto& file : report.files)
    outputs.push_back({{"path", file.string()}, {"kind", file.extension().string()}});
  ordered_json garment = nullptr;
  if (report.garment) {
    ordered_json seams = ordered_json::array();
    for (const auto& seam : report.garment->seams)
      seams.push_back({{"name", seam.name},
                       {"length_a_m", seam.length_a},
                       {"length_b_m", seam.length_b},
                       {"edges", seam.edges},
                       {"gap_m", seam.gap}});
    garment = {
        {"vertices", report.garment->vertices}, {"triangles", report.garment->triangles}, {"seams", seams}};
  }
  return {{"features", features},
          {"vertices", vertices},
          {"triangles", triangles},
          {"expected_vertices", expected},
          {"edges_within_half_and_double", within},
          {"min_angle_deg", angle},
          {"map_s", map},
          {"sample_s", sample},
          {"triangulate_s", triangulate},
          {"panels", panels},
          {"garment", garment},
          {"outputs", outputs}};
}

std::string table(const cloth::SizeReport& report) {
  std::string text;
  for (const cloth::SizeReport::Panel& panel : report.panels) {
    text += fmt::format("{}{}: {} vertices, {} triangles; {:.0f} with {:.3g} mm everywhere\n",
                        text.empty() ? "" : "\n", panel.name, panel.vertices, panel.triangles,
                        panel.uniform_vertices, 1e3 * panel.finest);
    const glm::dvec2 r = 1e3 * panel.fabric_resolution;
    text += padded("  fabric", 28) + (r.x == r.y ? fmt::format("{:.3f} mm\n", r.x)
                                                 : fmt::format("{:.3f} mm weft, {:.3f} mm warp\n", r.x, r.y));
    for (const cloth::SizeReport::Feature& feature : panel.features)
      text += padded(fmt::format("  {} ({})", feature.name, feature.rule), 28) +
              fmt::format("{:.3f} mm\n", 1e3 * feature.resolution);
    text += fmt::format(
        "  edges within half and double {:.2f} %, least angle {:.1f} degrees, {:.3f} of the vertices "
        "expected\n",
        100 * panel.quality.edges_within, panel.quality.least_angle,
        static_cast<double>(panel.vertices) / panel.quality.expected_vertices);
  }
  if (report.garment) {
    text += fmt::format("\ngarment: {} vertices, {} triangles\n", report.garment->vertices,
                        report.garment->triangles);
    for (const auto& seam : report.garment->seams)
      text += padded(fmt::format("  {}", seam.name), 28) +
              fmt::format("{} edges; {:.1f} mm sewn to {:.1f} mm\n", seam.edges, 1e3 * seam.length_a,
                          1e3 * seam.length_b);
  }
  return text;
}

int mesh_panels(const Arguments& arguments) {
  cloth::SizeRequest request{arguments.panels, arguments.folder};
  if (arguments.folder.empty()) request.folder = std::filesystem::path(arguments.panels).stem();
  if (!arguments.fabric.empty()) request.fabric = fabric_option(arguments.fabric);
  const cloth::SizeReport report = cloth::size_panels(request);
  if (arguments.common.tables_wanted()) write_stdout(table(report));
  write_report(to_json(report), arguments.common.json());
  // What the mesher promises (docs/sizing.md); an outline smaller than its own mesh size cannot hold it.
  bool holds = true;
  for (const cloth::SizeReport::Panel& panel : report.panels) {
    if (panel.quality.lost == 0 && panel.quality.edges_within >= 0.99 && panel.quality.least_angle >= 25)
      continue;
    log::warn(fmt::format(
        "panel '{}': the mesh is worse than promised: {:.1f} % of edges within half and double, least angle "
        "{:.1f} degrees, {:.3g} m of lines lost",
        panel.name, 100 * panel.quality.edges_within, panel.quality.least_angle, panel.quality.lost));
    holds = false;
  }
  return holds ? 0 : static_cast<int>(ExitCode::check_failed);
}

int run_size(Arguments& arguments) {
  arguments.common.apply();
  const sizing::FabricRange range = range_option(arguments.range);
  const sizing::ResolutionLaw law = sizing::resolution_law(range);
  if (arguments.list) {
    write_stdout(fabric_list(law));
    return 0;
  }
  if (arguments.panels.empty() && arguments.fabric.empty()) {
    throw Error(ExitCode::bad_input,
                "plisse size: give --fabric B,E or a PANEL.toml, one of them; see 'plisse size --help'");
  }
  if (!arguments.panels.empty()) return mesh_panels(arguments);
  return size_fabric(arguments, range, law);
}

}  // namespace

void add_size(CommandLine& line) {
  CommandOptions& options =
      line.command("size", "Tell how fine the mesh of a fabric must be, and mesh panels so");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_size(*arguments); };
}

}  // namespace plisse::cli
