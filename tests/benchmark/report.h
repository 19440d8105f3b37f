// What the benchmark found, as Markdown tables and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "benchmark/effort.h"

namespace plisse::benchmark {

struct Cell {
  std::string text;              // in Markdown
  nlohmann::ordered_json value;  // in JSON

  Cell(const char* words) : text(words), value(words) {}                // NOLINT(google-explicit-constructor)
  Cell(const std::string& words) : text(words), value(words) {}         // NOLINT(google-explicit-constructor)
  Cell(double number, int digits);                                      // 1,234.5
  Cell(const Distribution& spread, int digits, const char* unit = "");  // median (quartile–quartile)
};

struct Table {
  std::string title, note;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

// A ratio that issue asks for.
struct Target {
  std::string what;
  double at_most;
  Distribution ratio;
};

struct Report {
  std::vector<std::pair<std::string, std::string>> machine;
  std::vector<Target> targets;
  std::vector<Table> tables;
  bool results_agree = true;  // of the plain C++ with the GPU's
};

std::string markdown(const Report& report);
nlohmann::ordered_json to_json(const Report& report);

}  // namespace plisse::benchmark
