#include "bench/drape_cost.h"

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "cloth/drape.h"
#include "io/picture/svg_plot.h"
#include "shell/carry.h"

namespace plisse::bench {

std::vector<DrapeCost> drape_costs(const std::function<cloth::DrapeScene(int vertices)>& made,
                                   const std::vector<int>& sizes,
                                   const std::function<void(const DrapeCost&)>& done) {
  std::vector<DrapeCost> costs;
  for (const int size : sizes) {
    const cloth::DrapeScene scene = made(size);
    const shell::Shell shell = cloth::shell_of(scene);
    const shell::Conditions conditions = scene.conditions(1);
    shell::Loads loads = scene.loads;
    if (scene.obstacles) loads.obstacles = scene.obstacles(1);
    if (scene.growing_forces.size() > 0) {
      if (loads.forces.size() == 0) loads.forces = shell::Positions::Zero(3, scene.start.cols());
      loads.forces += scene.growing_forces;
    }
    const auto start = cloth::perturbed(
        scene, loads, conditions,
        loads.obstacles.empty() ? shell::carried(shell, conditions, scene.start) : scene.start);
    DrapeCost cost;
    const double cpu = cpu_seconds();
    const double began = wall_seconds();
    const shell::Equilibrium e = shell::find_equilibrium(
        shell, conditions, loads, start, scene.newton,
        [](const shell::NewtonStep&, const shell::Positions&) { return !interrupted(); });
    cost.wall_s = wall_seconds() - began;
    cost.cpu_s = cpu_seconds() - cpu;
    cost.vertices = shell.topology.vertex_count;
    cost.iterations = e.iterations;
    cost.converged = e.converged;
    cost.energy = e.energy;
    cost.analysis_s = e.analysis_s;
    cost.assembly_s = e.assembly_s;
    cost.factor_s = e.factor_s;
    cost.line_search_s = e.line_search_s;
    cost.factor_nonzeros = e.factor_nonzeros;
    if (interrupted() && !e.converged) break;
    if (done) done(cost);
    costs.push_back(cost);
    if (interrupted()) break;
  }
  return costs;
}

void plot_costs(const std::filesystem::path& file, const std::string& name,
                const std::vector<DrapeCost>& costs) {
  io::Plot plot;
  plot.title = fmt::format("plisse drape: {}, flat to full load", name);
  plot.x = {"vertices", true, false};
  plot.y = {"wall-clock time", true, true};
  const std::pair<const char*, double DrapeCost::*> parts[] = {
      {"all", &DrapeCost::wall_s},
      {"factorisation and solution", &DrapeCost::factor_s},
      {"assembly", &DrapeCost::assembly_s},
      {"line search", &DrapeCost::line_search_s},
      {"analysis, once", &DrapeCost::analysis_s}};
  for (const auto& [part, seconds] : parts) {
    io::PlotSeries series{part, {}, true};
    for (const DrapeCost& cost : costs) {
      io::PlotPoint point;
      point.x = static_cast<double>(cost.vertices);
      point.y = cost.*seconds;
      // Of the two that matter, their shares.
      if (seconds == &DrapeCost::factor_s || seconds == &DrapeCost::assembly_s)
        point.label = fmt::format("{:.0f} %", 100 * point.y / cost.wall_s);
      series.points.push_back(std::move(point));
    }
    plot.series.push_back(std::move(series));
  }
  write_whole_file(file, io::svg_plot(plot));
}

}  // namespace plisse::bench
