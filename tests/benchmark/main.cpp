// plisse_benchmark: what the passes, the wave shader, PNG and whole frames cost, and how that compares with
// Phong, plain C++, stb and the paper. Markdown on stdout; docs/benchmarks.md holds what it printed last.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>
#include <thread>

#include "base/error.h"
#include "base/log.h"
#include "base/version.h"
#include "benchmark/report.h"
#include "benchmark/sections.h"
#include "gpu/context.h"
#include "support/files.h"

namespace plisse::benchmark {
namespace {

struct Section {
  const char* name;
  void (*measure)(Report&, const Effort&);
};
constexpr Section sections[] = {{"passes", measure_passes},   {"shading", measure_shading},
                                {"plain", measure_plain_cpp}, {"png", measure_png},
                                {"frames", measure_frames},   {"paper", measure_paper},
                                {"sizing", measure_sizing},   {"import", measure_import}};

// The first line that a shell command prints.
std::string output_of(const std::string& command) {
  struct Close {
    void operator()(std::FILE* pipe) const { pclose(pipe); }
  };
  const std::unique_ptr<std::FILE, Close> pipe(popen(command.c_str(), "r"));
  std::array<char, 256> line{};
  if (!pipe || !std::fgets(line.data(), static_cast<int>(line.size()), pipe.get())) return "";
  std::string text(line.data());
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

std::string commit() {
  const std::string git = "git -C '" + test::source_file(".").string() + "' ";
  const std::string id = output_of(git + "rev-parse --short HEAD 2>/dev/null");
  if (id.empty()) return "unknown";
  const bool changed =
      !output_of(git + "status --porcelain -uno -- src shaders tests/benchmark 2>/dev/null").empty();
  return id + (changed ? " with changes" : "");
}

std::string today() {
  const std::time_t time = std::time(nullptr);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", std::gmtime(&time));
  return text.data();
}

void describe_machine(Report& report) {
  double load = 0;
  getloadavg(&load, 1);
  const gpu::Context context;
  const gpu::Info& gl = context.info();
  report.machine = {{"processor", fmt::format("{}, {} threads of hardware", processor(),
                                              std::thread::hardware_concurrency())},
                    {"OpenGL", fmt::format("{}; {}", gl.renderer, gl.version)},
                    {"compiler", "g++ " __VERSION__ ", -O3"},
                    {"date", fmt::format("{}, load average {:.1f} when it began", today(), load)},
                    {"plisse", fmt::format("{}, commit {}", version, commit())}};
  if (!gl.software) {
    report.machine.emplace_back(
        "CPU time", "only the driver's on this GPU: see the wall clock, which the targets are held to");
  }
}

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
  if (smoke)
    effort = {.samples = 1, .seconds = 0, .frames = 2, .width = 64, .height = 52, .grid_vertices = 400};

  Report report;
  describe_machine(report);
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
