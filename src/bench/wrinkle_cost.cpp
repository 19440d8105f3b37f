#include "bench/wrinkle_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "io/picture/svg_plot.h"

namespace plisse::bench {
namespace {

double median(std::array<double, 3> three) {
  std::sort(three.begin(), three.end());
  return three[1];
}

}  // namespace

std::vector<WrinkleCost> wrinkle_costs(cloth::WrinkleRequest request,
                                       const std::function<cloth::WrinkleScene(int vertices)>& base,
                                       const std::vector<int>& sizes,
                                       const std::function<void(const WrinkleCost&)>& done) {
  request.output.clear();
  request.mesh.clear();
  request.cache.clear();  // results from the cache would cost nothing
  std::vector<WrinkleCost> costs;
  for (const int size : sizes) {
    WrinkleCost cost;
    try {
      request.scene = base(size);
    } catch (const Error& error) {
      if (interrupted()) break;
      if (error.code != ExitCode::check_failed) throw;
      log::notice(error.what());
      cost.vertices = static_cast<std::size_t>(size);
      costs.push_back(cost);
      continue;
    }
    std::array<double, 3> solve{}, phase{}, wall{}, cpu{};
    for (std::size_t run = 0; run < 3 && !interrupted(); ++run) {
      const double before = cpu_seconds();
      const cloth::WrinkleReport report = cloth::wrinkle_field(request);
      cpu[run] = cpu_seconds() - before;
      wall[run] = report.wall_s;
      solve[run] = report.field.solve_s;
      phase[run] = report.field.phase_s;
      cost.vertices = report.vertices;
      cost.iterations = report.field.iterations;
      cost.converged = report.field.real.converged && report.field.whole.converged;
      cost.waves = report.field.waves;
      cost.max_amplitude = report.max_amplitude;
      cost.energy = report.field.whole.energy;
    }
    if (interrupted()) break;
    cost.solve_s = median(solve);
    cost.phase_s = median(phase);
    cost.wall_s = median(wall);
    cost.cpu_s = median(cpu);
    if (done) done(cost);
    costs.push_back(cost);
  }
  return costs;
}

void plot_costs(const std::filesystem::path& file, const std::string& name,
                const std::vector<WrinkleCost>& costs) {
  io::Plot plot;
  plot.title = fmt::format("plisse wrinkle: {}", name);
  plot.x = {"vertices", true, false};
  plot.y = {"wall-clock time", true, true};
  const std::pair<const char*, double WrinkleCost::*> parts[] = {
      {"all", &WrinkleCost::wall_s},
      {"solver", &WrinkleCost::solve_s},
      {"phases and whole periods", &WrinkleCost::phase_s}};
  for (const auto& [part, seconds] : parts) {
    io::PlotSeries series{part, {}, true};
    for (const WrinkleCost& cost : costs) {
      if (!(cost.wall_s > 0)) continue;
      io::PlotPoint point;
      point.x = static_cast<double>(cost.vertices);
      point.y = cost.*seconds;
      if (seconds == &WrinkleCost::wall_s) point.label = fmt::format("{:.4g} waves", cost.waves);
      series.points.push_back(std::move(point));
    }
    plot.series.push_back(std::move(series));
  }
  write_whole_file(file, io::svg_plot(plot));
}

}  // namespace plisse::bench
