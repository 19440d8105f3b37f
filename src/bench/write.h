// A bench report as files: a table for programs, a page for a repository, plots, and one page for a browser.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bench.h"

namespace plisse::bench {

// Time against error of a suite's rows that are comparable: a plot for every scene and kind of error that has
// two rows or more.
struct RowPlot {
  std::string file;  // plot_SUITE_SCENE_ERROR.svg
  std::string svg;
};
std::vector<RowPlot> plots(const SuiteReport& suite);

std::string rows_csv(const BenchReport& report);         // RFC 4180, a row each
std::string report_markdown(const BenchReport& report);  // tables, with the plots
std::string report_page(const BenchReport& report);      // HTML: plots inside, pictures beside it
nlohmann::ordered_json to_json(const BenchReport& report);

// "12.3 ms"; quartiles as "12.1–12.9 ms".
std::string duration_text(double seconds);
std::string spread_text(const Distribution& seconds);
// A value to three digits: "0.0123", "1.2e-07", "0".
std::string error_text(double error);
std::string effort_text(Effort effort);

}  // namespace plisse::bench
