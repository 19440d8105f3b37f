#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmark/sections.h"
#include "sizing/mesh_panel.h"

namespace plisse::benchmark {

// A square of cloth with one curved shirring line, larger and larger; one thread does all.
void measure_sizing(Report& report, const Effort& effort) {
  Table table{"Meshing a panel (plisse size)",
              "A square with a curved shirring line (ρ 0.6), from outline to finished mesh on one core; "
              "shares of its wall clock. "
              "The last column is CPU time over n log₂ n against the first row's: 1 is growth as n log n.",
              {"vertices", "CPU s", "map", "samples", "triangulation", "smoothing and refinement", "n log n"},
              {}};
  double first = 0;
  for (const double wanted : {1e3, 1e4, 1e5, 1e6}) {
    if (wanted > 10 * static_cast<double>(effort.grid_vertices)) break;
    sizing::Panel panel;
    panel.fabric = *sizing::find_fabric("wine-style");
    const double r = 7.826e-3, side = std::sqrt(wanted * std::sqrt(3) / 2) * r;
    panel.outline = {{{0, 0}, {side, 0}, {side, side}, {0, side}}, true};
    sizing::Feature line;
    line.name = "line";
    line.ratio = 0.6;
    line.line = sizing::spline_through(
        {{0.1 * side, 0.2 * side}, {0.4 * side, 0.5 * side}, {0.8 * side, 0.6 * side}}, false);
    panel.features = {line};
    std::vector<double> seconds, totals;
    sizing::MeshTimes shares;
    double vertices = 0;
    for (int run = 0; run < std::clamp(static_cast<int>(3e5 / wanted), 1, std::min(effort.samples, 5));
         ++run) {
      const Sample begin = now();
      const auto sized = sizing::mesh_panel(panel, {});
      seconds.push_back((now() - begin).cpu_s);
      shares = sized->seconds;
      vertices = static_cast<double>(sized->mesh.vertices.size());
    }
    const Distribution time = distribution(seconds);
    const double all = shares.map + shares.sample + shares.triangulate + shares.improve;
    const auto share = [&](double part) { return Cell(fmt::format("{:.0f} %", 100 * part / all)); };
    const double growth = time.median / (vertices * std::log2(vertices));
    if (first == 0) first = growth;
    table.rows.push_back({Cell(vertices, 0), Cell(time, 3), share(shares.map), share(shares.sample),
                          share(shares.triangulate), share(shares.improve), Cell(growth / first, 2)});
    if (wanted == 1e5) report.targets.push_back({"seconds to mesh 100,000 vertices", 5, time});
  }
  report.tables.push_back(table);
}

}  // namespace plisse::benchmark
