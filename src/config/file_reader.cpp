#include "config/file_reader.h"

#include <fmt/format.h>

#include <array>

#include "config/suggest.h"

namespace plisse::config {

FileReader::FileReader(std::string_view text, const std::filesystem::path& file)
    : file_(file), folder_(file.parent_path()), complaints_(file), root_(parse_toml(text, file)) {}

void FileReader::read_tables(const std::vector<FileTable>& tables, const std::vector<KeyText>& root) {
  std::vector<std::string> names;
  for (const KeyText& key : root) names.push_back(key.name);
  for (const FileTable& table : tables) {
    names.push_back(table.repeated && !root.empty() ? "[[" + table.name + "]]" : table.name);
    const auto found = root_.find(table.name);
    if (found == root_.end()) continue;
    const auto& [key, node] = *found;
    if (table.repeated && !(table.alone && node.is_table())) {
      read_each(node, table.name, [&](const toml::table& item) { table.read(item, item.source().begin); });
    } else if (node.is_table()) {
      table.read(*node.as_table(), key.source().begin);
    } else {
      complain(key.source().begin,
               fmt::format("key '{0}': is a table; write [{0}] and its keys below", table.name));
    }
  }
  for (const auto& [key, node] : root_) {
    const std::string name(key.str());
    const auto is_this = [&](const auto& known) { return known.name == name; };
    if (std::none_of(tables.begin(), tables.end(), is_this) &&
        std::none_of(root.begin(), root.end(), is_this))
      unknown_table(name, node, key.source().begin, names);
  }
}

void FileReader::read_each(const toml::node& node, const std::string& name,
                           const std::function<void(const toml::table&)>& read) {
  if (!node.is_array_of_tables()) {
    complain(node.source().begin,
             fmt::format("key '{0}': is no list of tables; write [[{0}]] and its keys below", name));
    return;
  }
  for (const toml::node& item : *node.as_array()) read(*item.as_table());
}

void FileReader::missing(const KeyText& key, const toml::table& table, const std::string& where) {
  complain(table.source().begin,
           fmt::format("key '{}': missing in {}; allowed: {}", key.name, where, key.allowed));
}

void FileReader::wrong(const KeyText& key, const toml::source_position& at, const Problem& problem) {
  complain(at, fmt::format("key '{}': {}; allowed: {}{}", key.name, problem.what, key.allowed, problem.hint));
}

// Where else a key of this name is at home, in words; or what its name nearly is.
void FileReader::unknown_key(const std::string& name, const toml::source_position& at,
                             const std::string& where, const std::vector<const KeyText*>& known) {
  std::string elsewhere;
  for (const KeyText& key : all)
    if (key.name == name) elsewhere += fmt::format("{}[{}]", elsewhere.empty() ? "" : " or ", key.table);
  if (!elsewhere.empty())
    return complain(at, fmt::format("key '{}': unknown in {}, it belongs to {}", name, where, elsewhere));
  std::vector<std::string> names;
  for (const KeyText* key : known) names.push_back(key->name);
  std::string hint = did_you_mean(name, names);
  for (std::size_t i = 0; hint.empty() && i < all.size(); ++i) {
    if (!nearest(name, std::array{all[i].name}).empty())
      hint = fmt::format(" (did you mean '{}' of [{}]?)", all[i].name, all[i].table);
  }
  complain(at, fmt::format("key '{}': unknown in {}; allowed: {}{}", name, where, either(names), hint));
}

void FileReader::unknown_table(const std::string& name, const toml::node& node,
                               const toml::source_position& at, const std::vector<std::string>& names) {
  const std::string allowed = either(names) + did_you_mean(name, names);
  if (all.empty()) return complain(at, fmt::format("key '{}': unknown; allowed: {}", name, allowed));
  if (node.is_table() || node.is_array_of_tables())
    return complain(at, fmt::format("table [{}]: unknown; allowed: {}", name, allowed));
  std::vector<std::string> keys;
  for (const KeyText& key : all) keys.push_back(key.name);
  const std::string meant = nearest(name, keys);
  for (const KeyText& key : all) {
    if (key.name != meant) continue;
    const std::string hint = meant == name ? "" : fmt::format(" (did you mean '{}'?)", meant);
    return complain(at, fmt::format("key '{}': stands outside a table, '{}' belongs under [{}]{}", name,
                                    meant, key.table, hint));
  }
  complain(at, fmt::format("key '{}': unknown, and outside a table; tables: {}", name, either(names)));
}

void FileReader::complain_of_missing(const std::vector<const KeyText*>& known, const toml::table& table,
                                     const Places& places, const std::string& where,
                                     const std::string& kind) {
  for (const KeyText* key : known) {
    const auto& needed = key->extras.needed;
    if (key->extras.first || needed.empty() || places.contains(key->name)) continue;
    if (needed == always || belongs(needed, kind)) missing(*key, table, where);
  }
}

}  // namespace plisse::config
