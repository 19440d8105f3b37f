// plisse bench: time against error for settings × scenes. Suites (suite.h) measure; writers (write.h) make a
// table, plots and one page.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/machine.h"
#include "bench/timing.h"

namespace plisse::bench {

enum class Effort { smoke, quick, full };  // a test that it runs; two minutes; twenty minutes

// One setting of one scene, with one kind of error.
struct Row {
  std::string suite, scene;
  std::string series, label;  // the setting: "smooth", "4 rounds"
  Distribution seconds;       // median and quartiles
  Clock clock = Clock::cpu;   // of the seconds
  std::string seconds_of;     // "a frame", "a picture"
  std::string error_of = {};  // "picture", "phases": rows with the same are comparable
  double error = 0;
  std::string error_unit = {};
  std::string truth = {};  // the reference of the error
  bool detail = false;     // a part of another row's time: in the tables, not in the plots
  bool on_front = false;   // no comparable row is both faster and more accurate

  std::string setting() const {
    return series.empty() || label.empty() ? series + label : series + ", " + label;
  }
};

struct Picture {
  std::string path, caption;  // relative to the report's folder
};

struct SuiteReport {
  std::string name, title, note;  // the note: what was compared, in sentences
  std::vector<Row> rows;
  std::vector<Picture> pictures;
};

struct BenchReport {
  Machine machine;
  Effort effort = Effort::full;
  std::vector<SuiteReport> suites;
  std::vector<std::filesystem::path> outputs;
  bool interrupted = false;  // the finished suites are kept
  double wall_s = 0;
};

struct BenchRequest {
  Effort effort = Effort::full;
  std::vector<std::string> suites;  // by name; empty: all
  std::filesystem::path folder = "bench";
  std::filesystem::path assets;  // the folder of sleeve.toml; empty: as find_assets finds it
  int device = -1;
  std::function<void(int done, int total, const std::string& suite)> progress;
};

std::vector<std::string> suite_names();

// The project's own scenes: `assets` or `share/plisse/assets` in a folder above the running program's. Throws
// Error(bad_input) that says where it looked.
std::filesystem::path find_assets();

// Writes rows.csv, report.md, index.html, plot_*.svg and pictures/ into the folder. Throws Error.
BenchReport bench(const BenchRequest& request);

}  // namespace plisse::bench
