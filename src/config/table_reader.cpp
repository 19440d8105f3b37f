#include "config/table_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "config/kinds.h"
#include "config/suggest.h"

namespace plisse::config {

void TableReader::finish() {
  const std::vector<std::string> names(asked_.begin(), asked_.end());
  for (const auto& [key, node] : table_) {
    const std::string given(key.str());
    if (asked_.contains(given)) continue;
    complaints_.add(key.source().begin, fmt::format("key '{}': unknown in {}; allowed: {}{}", given, name_,
                                                    either(names), did_you_mean(given, names)));
  }
}

const toml::node* TableReader::node(const std::string& key) {
  asked_.insert(key);
  return table_.get(key);
}

const toml::node* TableReader::needed(const std::string& key, const char* allowed) {
  const toml::node* found = node(key);
  if (!found)
    complaints_.add(table_.source().begin,
                    fmt::format("key '{}': missing in {}; allowed: {}", key, name_, allowed));
  return found;
}

void TableReader::complain(const toml::node& at, const std::string& key, const std::string& text) {
  complaints_.add(at.source().begin, fmt::format("key '{}': {}", key, text));
}

void TableReader::text(const std::string& key, std::string& value) {
  const toml::node* found = node(key);
  if (!found) return;
  if (found->is_string()) {
    value = *found->value<std::string>();
  } else {
    complain(*found, key, "is no text; allowed: a text in quotes");
  }
}

std::optional<double> TableReader::number_of(const toml::node& at, const Parse& parse, double factor) {
  if (at.is_number()) {
    const auto value = at.value<double>();  // none for whole numbers that a double does not hold
    return value ? std::optional(*value * factor) : std::nullopt;
  }
  if (at.is_string() && parse) return parse(*at.value<std::string>());
  return std::nullopt;
}

bool TableReader::number(const std::string& key, double& value, double low, double high, const char* allowed,
                         const Parse& parse, double factor) {
  const toml::node* found = node(key);
  if (!found) return false;
  const auto given = number_of(*found, parse, factor);
  if (!given || !(*given >= low) || !(*given <= high) || !std::isfinite(*given)) {
    complain(*found, key,
             fmt::format("{}; allowed: {}",
                         given ? fmt::format("{:g} is out of range", *given) : "is no such value", allowed));
    return false;
  }
  value = *given;
  return true;
}

bool TableReader::length(const std::string& key, double& value, double low, const char* allowed) {
  return number(key, value, low, 1e9, allowed, parse_length, metres_);
}

std::optional<double> TableReader::length_of(const toml::node& at) const {
  return number_of(at, parse_length, metres_);
}

void TableReader::unknown(const std::string& key, const std::string& given,
                          const std::vector<std::string>& names) {
  complain(*table_.get(key), key,
           fmt::format("'{}' is unknown; allowed: {}{}", given, either(names), did_you_mean(given, names)));
}

}  // namespace plisse::config
