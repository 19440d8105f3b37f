#include <fmt/format.h>

#include <algorithm>

#include "bench/write.h"
#include "io/picture/svg_plot.h"

namespace plisse::bench {
namespace {

struct Kind {
  std::string scene, error_of, error_unit, seconds_of;
  bool operator==(const Kind&) const = default;
};

Kind kind_of(const Row& row) {
  return {row.scene, row.error_of, row.error_unit, row.seconds_of};
}

std::string file_name(const SuiteReport& suite, const Kind& kind, std::size_t number) {
  std::string name = fmt::format("plot_{}_{}_{}_{}.svg", suite.name, kind.scene, kind.error_of, number);
  for (char& c : name) c = c == ' ' || c == '/' ? '-' : c;
  return name;
}

}  // namespace

std::vector<RowPlot> plots(const SuiteReport& suite) {
  std::vector<Kind> kinds;
  for (const Row& row : suite.rows) {
    if (!row.detail && std::find(kinds.begin(), kinds.end(), kind_of(row)) == kinds.end())
      kinds.push_back(kind_of(row));
  }
  std::vector<RowPlot> result;
  for (const Kind& kind : kinds) {
    io::Plot plot;
    plot.title = fmt::format("{}: time against error ({})", kind.scene, kind.error_of);
    plot.y.label = kind.error_unit;
    plot.mark_name = "front";
    std::size_t points = 0;
    for (const Row& row : suite.rows) {
      if (kind_of(row) != kind) continue;
      plot.x = {fmt::format("{} for {}", row.clock == Clock::cpu ? "CPU time" : "time", row.seconds_of), true,
                true};
      auto series = std::find_if(plot.series.begin(), plot.series.end(),
                                 [&](const io::PlotSeries& known) { return known.name == row.series; });
      if (series == plot.series.end()) {
        plot.series.push_back({row.series, {}, true});
        series = std::prev(plot.series.end());
      }
      series->points.push_back(
          {row.seconds.median, row.error, row.seconds.low, row.seconds.high, row.label, row.on_front});
      ++points;
    }
    if (points < 2) continue;
    // A label that is the same for all points goes into the title.
    const std::string& label = plot.series.front().points.front().label;
    const bool same = std::all_of(plot.series.begin(), plot.series.end(), [&](const io::PlotSeries& series) {
      return std::all_of(series.points.begin(), series.points.end(),
                         [&](const io::PlotPoint& point) { return point.label == label; });
    });
    if (same && !label.empty()) {
      plot.title = fmt::format("{}: {}", kind.scene, label);
      for (io::PlotSeries& series : plot.series)
        for (io::PlotPoint& point : series.points) point.label.clear();
    }
    result.push_back({file_name(suite, kind, result.size() + 1), io::svg_plot(plot)});
  }
  return result;
}

}  // namespace plisse::bench
