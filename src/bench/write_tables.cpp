#include <fmt/format.h>

#include <cmath>

#include "bench/write.h"

namespace plisse::bench {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

const char* name_of(Clock clock) {
  return clock == Clock::cpu ? "cpu" : "wall";
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds >= 100) return fmt::format("{:.0f} s", seconds);
  if (seconds >= 1) return fmt::format("{:.3g} s", seconds);
  if (seconds >= 1e-3) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return fmt::format("{:.3g} µs", 1e6 * seconds);
}

std::string spread_text(const Distribution& seconds) {
  if (seconds.low == seconds.high) return "one run";
  return duration_text(seconds.low) + " – " + duration_text(seconds.high);
}

std::string error_text(double error) {
  return fmt::format("{:.3g}", error);
}

std::string effort_text(Effort effort) {
  return effort == Effort::smoke ? "smoke" : effort == Effort::quick ? "quick" : "full";
}

std::string rows_csv(const BenchReport& report) {
  std::string text =
      "suite,scene,setting,seconds,seconds_lower_quartile,seconds_upper_quartile,clock,seconds_of,error_of,"
      "error,"
      "error_unit,truth,on_front\r\n";
  for (const SuiteReport& suite : report.suites) {
    for (const Row& row : suite.rows) {
      text += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{},{},{},{:.6g},{},{},{}\r\n", quoted(row.suite),
                          quoted(row.scene), quoted(row.setting()), row.seconds.median, row.seconds.low,
                          row.seconds.high, name_of(row.clock), quoted(row.seconds_of), quoted(row.error_of),
                          row.error, quoted(row.error_unit), quoted(row.truth), row.on_front ? 1 : 0);
    }
  }
  return text;
}

std::string report_markdown(const BenchReport& report) {
  std::string text = fmt::format("# plisse bench {}\n\n", effort_text(report.effort));
  for (const auto& [name, value] : report.machine) text += fmt::format("- {}: {}\n", name, value);
  text +=
      "\nTimes are medians with their quartiles. Rows marked ● are on the front: none of their kind is both "
      "faster and nearer "
      "to the truth.\n";
  for (const SuiteReport& suite : report.suites) {
    text += fmt::format("\n## {}\n\n{}\n", suite.title, suite.note);
    for (const RowPlot& plot : plots(suite)) text += fmt::format("\n![{}]({})\n", plot.file, plot.file);
    text +=
        "\n| scene | setting | time | quartiles | clock, of | error | unit | truth | front "
        "|\n|---|---|---|---|---|---|---|---|---|\n";
    for (const Row& row : suite.rows) {
      text += fmt::format("| {} | {} | {} | {} | {}, {} | {} | {} | {} | {} |\n", row.scene, row.setting(),
                          duration_text(row.seconds.median), spread_text(row.seconds), name_of(row.clock),
                          row.seconds_of, error_text(row.error), row.error_unit, row.truth,
                          row.on_front ? "●" : "");
    }
  }
  return text;
}

nlohmann::ordered_json to_json(const BenchReport& report) {
  using nlohmann::ordered_json;
  ordered_json machine = ordered_json::object(), rows = ordered_json::array(),
               outputs = ordered_json::array();
  for (const auto& [name, value] : report.machine) machine[name] = value;
  for (const SuiteReport& suite : report.suites) {
    for (const Row& row : suite.rows) {
      rows.push_back({{"suite", row.suite},
                      {"scene", row.scene},
                      {"setting", row.setting()},
                      {"seconds", row.seconds.median},
                      {"seconds_spread", {row.seconds.low, row.seconds.high}},
                      {"clock", name_of(row.clock)},
                      {"seconds_of", row.seconds_of},
                      {"error_of", row.error_of},
                      {"error", row.error},
                      {"error_unit", row.error_unit},
                      {"truth", row.truth},
                      {"on_front", row.on_front}});
    }
  }
  for (const auto& path : report.outputs) outputs.push_back(path.string());
  return {{"machine", machine}, {"effort", effort_text(report.effort)}, {"rows", rows},
          {"outputs", outputs}, {"interrupted", report.interrupted},    {"wall_s", report.wall_s}};
}

}  // namespace plisse::bench
