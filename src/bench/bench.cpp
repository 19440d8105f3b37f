#include "bench/bench.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "bench/suite.h"
#include "bench/write.h"
#include "config/suggest.h"

namespace plisse::bench {
namespace {

namespace fs = std::filesystem;

struct Suite {
  const char* name;
  SuiteReport (*measure)(const Setup&);
};
constexpr Suite suites[] = {{"relaxation", measure_relaxation}, {"precision", measure_precision},
                            {"shading", measure_shading},       {"mesh", measure_mesh},
                            {"method", measure_method},         {"output", measure_output},
                            {"sizing", measure_sizing}};

std::vector<Suite> wanted_suites(const std::vector<std::string>& names) {
  const auto known = suite_names();
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ExitCode::bad_input,
                  fmt::format("there is no suite '{}'{}; there are {}", name,
                              config::did_you_mean(name, known), fmt::join(known, ", ")));
  }
  std::vector<Suite> wanted;
  for (const Suite& suite : suites) {
    if (names.empty() || std::find(names.begin(), names.end(), suite.name) != names.end())
      wanted.push_back(suite);
  }
  return wanted;
}

void write(BenchReport& report, const fs::path& folder) {
  const auto add = [&](const std::string& name, const std::string& text) {
    write_whole_file(folder / name, text);
    report.outputs.push_back(folder / name);
  };
  for (const SuiteReport& suite : report.suites) {
    for (const RowPlot& plot : plots(suite)) add(plot.file, plot.svg);
    for (const Picture& picture : suite.pictures) report.outputs.push_back(folder / picture.path);
  }
  add("rows.csv", rows_csv(report));
  add("report.md", report_markdown(report));
  add("index.html", report_page(report));
}

}  // namespace

std::vector<std::string> suite_names() {
  std::vector<std::string> names;
  for (const Suite& suite : suites) names.emplace_back(suite.name);
  return names;
}

fs::path find_assets() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    for (const char* place : {"share/plisse/assets", "assets"}) {
      if (fs::exists(folder / place / "sleeve.toml", error)) return folder / place;
    }
  }
  throw Error(
      ExitCode::bad_input,
      fmt::format(
          "the project's own scenes are not there: no 'share/plisse/assets' or 'assets' with sleeve.toml in "
          "any folder above {}; name their folder with --assets",
          program.string()));
}

BenchReport bench(const BenchRequest& request) {
  const auto began = now();
  const auto wanted = wanted_suites(request.suites);
  Setup setup{request.effort, request.folder, request.assets.empty() ? find_assets() : request.assets,
              request.device};
  check_writable(setup.folder / "index.html");

  BenchReport report;
  report.effort = request.effort;
  {
    const gpu::Context context(request.device);
    report.machine = describe_machine(context.info());
  }
  for (std::size_t i = 0; i < wanted.size() && !report.interrupted; ++i) {
    if (request.progress)
      request.progress(static_cast<int>(i), static_cast<int>(wanted.size()), wanted[i].name);
    report.suites.push_back(wanted[i].measure(setup));
    mark_fronts(report.suites.back().rows);
    report.interrupted = interrupted();
  }
  report.wall_s = (now() - began).wall_s;
  write(report, setup.folder);
  return report;
}

}  // namespace plisse::bench
