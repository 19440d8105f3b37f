#include "benchmark/report.h"

#include <fmt/format.h>

namespace plisse::benchmark {
namespace {

using nlohmann::ordered_json;

std::string with_commas(double number, int digits) {
  std::string text = fmt::format("{:.{}f}", number, digits);
  const std::size_t point = digits > 0 ? text.find('.') : text.size();
  for (std::size_t at = point; at > 3; at -= 3) {
    if (text[at - 4] != '-') text.insert(at - 3, 1, ',');
  }
  return text;
}

ordered_json spread_json(const Distribution& spread) {
  return {{"median", spread.median}, {"lower_quartile", spread.low}, {"upper_quartile", spread.high}};
}

std::string line(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const auto& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

std::string markdown(const Table& table) {
  std::string text = "### " + table.title + "\n\n";
  if (!table.note.empty()) text += table.note + "\n\n";
  text += line(table.columns) + "|";
  for (std::size_t i = 0; i < table.columns.size(); ++i) text += "---|";
  text += "\n";
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (const Cell& cell : row) cells.push_back(cell.text);
    text += line(cells);
  }
  return text + "\n";
}

Table targets_table(const std::vector<Target>& targets) {
  Table table{"Targets", "", {"ratio", "at most", "measured", "met"}, {}};
  for (const Target& target : targets) {
    table.rows.push_back({target.what, Cell(target.at_most, 2), Cell(target.ratio, 2),
                          target.ratio.median <= target.at_most ? "yes" : "no"});
  }
  return table;
}

std::vector<Table> all_tables(const Report& report) {
  std::vector<Table> tables;
  if (!report.targets.empty()) tables.push_back(targets_table(report.targets));
  tables.insert(tables.end(), report.tables.begin(), report.tables.end());
  return tables;
}

}  // namespace

Cell::Cell(double number, int digits) : text(with_commas(number, digits)), value(number) {}

Cell::Cell(const Distribution& spread, int digits, const char* unit)
    : text(fmt::format("{}{} ({}–{})", with_commas(spread.median, digits), unit,
                       with_commas(spread.low, digits), with_commas(spread.high, digits))),
      value(spread_json(spread)) {}

std::string markdown(const Report& report) {
  std::string text;
  for (const auto& [name, value] : report.machine) text += fmt::format("- {}: {}\n", name, value);
  text += "\nNumbers are medians, with the quartiles in brackets.\n\n";
  for (const Table& table : all_tables(report)) text += markdown(table);
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

ordered_json to_json(const Report& report) {
  ordered_json json;
  for (const auto& [name, value] : report.machine) json["machine"][name] = value;
  json["results_agree"] = report.results_agree;
  json["tables"] = ordered_json::array();
  for (const Table& table : all_tables(report)) {
    ordered_json rows = ordered_json::array();
    for (const auto& row : table.rows) {
      ordered_json entry;
      for (std::size_t i = 0; i < row.size(); ++i) entry[table.columns[i]] = row[i].value;
      rows.push_back(entry);
    }
    json["tables"].push_back({{"title", table.title}, {"note", table.note}, {"rows", rows}});
  }
  return json;
}

}  // namespace plisse::benchmark
