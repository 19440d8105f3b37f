// plisse_benchmark: what the passes, the wave shader, PNG and whole frames cost, and how that compares with
// Phong, plain C++, stb and the paper. Markdown on stdout; docs/benchmarks.md holds what it printed last.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "base/error.h"
#include "base/log.h"
#include "bench/machine.h"
#include "benchmark/report.h"
#include "benchmark/sections.h"
#include "gpu/context.h"

namespace plisse::benchmark {
namespace {

struct Section {
  const char* name;
  void (*measure)(Report&, const Effort&);
};
constexpr Section sections[] = {
    {"passes", measure_passes}, {"shading", measure_shading}, {"plain", measure_plain_cpp},
    {"png", measure_png},       {"frames", measure_frames},   {"paper", measure_paper},
    {"device", measure_device}, {"sizing", measure_sizing},   {"import", measure_import}};

int run(int argc, char** argv) {
  CLI::App app("What plisse's passes cost, against Phong, plain C++, stb and the paper's tables");
  bool smoke = false;
  std::string json, shaders;
  std::vector<std::string> only;
  std::vector<std::string> names;
  for (const Section& section : sections) names.emplace_back(section.name);
  app.add_flag(
      "--smoke", smoke,
      "tiny sizes, one sample: whether it runs and plain C++ agrees with the GPU; the times say nothing");
  app.add_option("--json", json, "the same as JSON into this file");
  app.add_option("--only", only, fmt::format("of {}", fmt::join(names, ", ")))
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_option("--compare-shaders", shaders,
                 "instead of all that: each pass with the shaders of this folder against the built-in ones")
      ->check(CLI::ExistingDirectory);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }
  Effort effort;
  if (smoke) effort = {{.samples = 1, .seconds = 0}, 2, 64, 52, 400};

  Report report;
  {
    const gpu::Context context;
    report.machine = describe_machine(context.info());
  }
  if (!shaders.empty()) compare_shaders(report, effort, shaders);
  for (const Section& section : sections) {
    if (!shaders.empty()) break;
    if (!only.empty() && std::find(only.begin(), only.end(), section.name) == only.end()) continue;
    log::notice(fmt::format("measuring: {}", section.name));
    section.measure(report, effort);
  }
  std::cout << markdown(report);
  if (!json.empty()) {
    std::ofstream file(json);
    file << to_json(report).dump(2) << '\n';
    if (!file.flush()) throw Error(ExitCode::no_output, json + ": cannot be written");
  }
  return static_cast<int>(report.results_agree ? ExitCode::fine : ExitCode::check_failed);
}

}  // namespace
}  // namespace plisse::benchmark

int main(int argc, char** argv) {
  try {
    return plisse::benchmark::run(argc, argv);
  } catch (const plisse::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(plisse::ExitCode::check_failed);
  }
}
