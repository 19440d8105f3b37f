// One table of a TOML file, key by key, for files whose tables nest (panel files); the tables of scenes are
// keys.h's.
#pragma once

#include <toml++/toml.h>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/complaints.h"

namespace plisse::config {

// Reads keys with their ranges and adds complaints about wrong values; at the end, about unknown keys.
class TableReader {
 public:
  // `name` as messages have it; numbers that are lengths are times `metres`.
  TableReader(const toml::table& table, std::string name, double metres, Complaints& complaints)
      : table_(table), name_(std::move(name)), metres_(metres), complaints_(complaints) {}
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;

  // Call last: what has not been asked for by then is unknown.
  void finish();

  // nullptr where the table has no such key; `needed` complains then.
  const toml::node* node(const std::string& key);
  const toml::node* needed(const std::string& key, const char* allowed);
  void complain(const toml::node& at, const std::string& key, const std::string& text);

  void text(const std::string& key, std::string& value);
  // A number, or a text that `parse` understands.
  using Parse = std::function<std::optional<double>(std::string_view)>;
  bool number(const std::string& key, double& value, double low, double high, const char* allowed,
              const Parse& parse = {}, double factor = 1);
  // In the file's unit, or a text with one.
  bool length(const std::string& key, double& value, double low, const char* allowed);
  std::optional<double> length_of(const toml::node& at) const;

  template <typename Value>
  void word(const std::string& key, Value& value, const std::vector<std::pair<std::string, Value>>& words) {
    std::string given;
    text(key, given);
    const toml::node* found = node(key);
    if (!found || !found->is_string()) return;
    std::vector<std::string> names;
    for (const auto& [name, meaning] : words) {
      if (name == given) {
        value = meaning;
        return;
      }
      names.push_back(name);
    }
    unknown(key, given, names);
  }

  const toml::table& table() const { return table_; }
  const std::string& name() const { return name_; }
  double metres() const { return metres_; }
  Complaints& complaints() const { return complaints_; }

 private:
  static std::optional<double> number_of(const toml::node& at, const Parse& parse, double factor);
  void unknown(const std::string& key, const std::string& given, const std::vector<std::string>& names);

  const toml::table& table_;
  std::string name_;
  double metres_;
  Complaints& complaints_;
  std::set<std::string> asked_;
};

}  // namespace plisse::config
