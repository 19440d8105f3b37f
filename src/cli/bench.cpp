// plisse bench: time against error, over settings and scenes.

#include "bench/bench.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "bench/hard.h"
#include "bench/write.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/report.h"
#include "config/suggest.h"

namespace plisse::cli {
namespace {

struct Arguments {
  explicit Arguments(CommandOptions& options) : device(options), common(options) {
    options.add(
        "what", what, Values::many, "quick|full|hard|NAME…",
        described(fmt::format("quick (under two minutes), full (twenty), hard (cases that must "
                              "hold; exit code 1 where one does not), smoke (whether it runs at all: its "
                              "numbers say nothing), and suites by name, default all: {}",
                              fmt::join(bench::suite_names(), ", "))));
    options.add(
        "-o,--output", folder, "DIR",
        described("The folder for index.html, report.md, rows.csv, plots and pictures; default: bench"));
    options.add(
        "--assets", assets, "DIR",
        described("The folder of the project's own scenes; default: the one that came with the program"));
  }
  DeviceArguments device;
  CommonArguments common;
  std::vector<std::string> what;
  std::string folder = "bench", assets;
};

// Every hard case and what came of it, as a table in DIR/hard.md and on standard output.
int run_hard(const Arguments& arguments) {
  const std::filesystem::path file = std::filesystem::path(arguments.folder) / "hard.md";
  check_writable(file);
  install_interrupt_handlers();
  std::vector<bench::HardRow> rows;
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  bool all_hold = true;
  for (const bench::HardCase& hard : bench::hard_cases()) {
    if (interrupted()) return 128 + signal_number();
    const bench::HardRow& row = rows.emplace_back(bench::judge(hard));
    all_hold = all_hold && row.verdict.holds;
    if (arguments.common.tables_wanted())
      write_stdout(fmt::format("{:<5} {}: {}\n      {}\n", row.verdict.holds ? "holds" : "FAILS", row.area,
                               row.name, row.verdict.found));
    cases.push_back({{"area", row.area},
                     {"case", row.name},
                     {"must", row.must},
                     {"found", row.verdict.found},
                     {"holds", row.verdict.holds},
                     {"seconds", row.seconds}});
  }
  write_whole_file(file, bench::hard_markdown(rows));
  write_report({{"ok", all_hold}, {"cases", cases}}, arguments.common.json());
  return static_cast<int>(all_hold ? ExitCode::fine : ExitCode::check_failed);
}

int run_bench(Arguments& arguments) {
  arguments.common.apply();
  if (arguments.device.list_wanted()) {
    arguments.device.list();
    return 0;
  }
  if (arguments.what.empty())
    throw Error(ExitCode::bad_input,
                "plisse bench: give quick, full or the name of a suite; see 'plisse bench --help'");
  if (arguments.what == std::vector<std::string>{"hard"}) return run_hard(arguments);
  bench::BenchRequest request;
  request.folder = arguments.folder;
  request.assets = arguments.assets;
  request.device = arguments.device.device();
  const auto suites = bench::suite_names();
  std::vector<std::string> known = suites;
  known.insert(known.end(), {"quick", "full", "smoke", "hard"});
  for (const std::string& word : arguments.what) {
    if (word == "quick" || word == "full" || word == "smoke") {
      request.effort = word == "quick"  ? bench::Effort::quick
                       : word == "full" ? bench::Effort::full
                                        : bench::Effort::smoke;
    } else if (std::find(suites.begin(), suites.end(), word) != suites.end()) {
      request.suites.push_back(word);
    } else if (word == "hard") {
      throw Error(ExitCode::bad_input, "plisse bench: 'hard' stands alone");
    } else {
      throw Error(ExitCode::bad_input,
                  fmt::format("plisse bench: there is no '{}'{}; there are {}", word,
                              config::did_you_mean(word, known), fmt::join(known, ", ")));
    }
  }
  install_interrupt_handlers();
  request.progress = [](int done, int total, const std::string& suite) {
    log::notice(fmt::format("{}/{} {}", done + 1, total, suite));
  };
  const bench::BenchReport report = bench::bench(request);
  log::notice(fmt::format("{} rows in {:.0f} s → {}/index.html", bench::to_json(report)["rows"].size(),
                          report.wall_s, arguments.folder));
  write_report(bench::to_json(report), arguments.common.json());
  return report.interrupted ? 128 + signal_number() : 0;
}

}  // namespace

void add_bench(CommandLine& line) {
  CommandOptions& options =
      line.command("bench", "Measure settings: time against error",
                   "\nplisse bench quick                    everything, coarsely, into bench/index.html\n"
                   "plisse bench relaxation -o relax      one suite in full\n"
                   "plisse bench hard                     cases that must hold, into bench/hard.md");
  auto arguments = std::make_shared<Arguments>(options);
  options.run = [arguments] { return run_bench(*arguments); };
}

}  // namespace plisse::cli
