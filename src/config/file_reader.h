// Reads a TOML file by the rows of its tables. Everything that is wrong with the file is gathered and thrown
// at once; all files share these messages.
#pragma once

#include <toml++/toml.h>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/complaints.h"
#include "config/given.h"
#include "config/key.h"

namespace plisse::config {

// The keys that a table has, right or wrong, and where.
using Places = std::map<std::string, toml::source_position>;

// A table of the file: [name], or any number of [[name]].
struct FileTable {
  std::string name;
  bool repeated = false;
  std::function<void(const toml::table&, const toml::source_position& at)> read;  // at: of its name
  bool alone = false;  // a repeated one may be written [name], too
};

class FileReader {
 public:
  // Throws Error(bad_input) where the text is no TOML.
  FileReader(std::string_view text, const std::filesystem::path& file);

  // Reads the tables in this order, then complains of what is none of them and no key of `root`.
  void read_tables(const std::vector<FileTable>& tables, const std::vector<KeyText>& root = {});

  // The file's keys outside tables, but for those that come `first`; and its tables.
  template <typename Target>
  void read_root(const Keys<Target>& keys, Target& target, const std::vector<FileTable>& tables) {
    for (const Key<Target>& key : keys)
      if (const auto found = root_.find(key.name); !key.extras.first && found != root_.end())
        set(key, found->second, found->first.source().begin, target);
    std::vector<KeyText> texts;
    append(texts, keys);
    read_tables(tables, texts);
  }

  // Of one that is written [[name]].
  void read_each(const toml::node& node, const std::string& name,
                 const std::function<void(const toml::table&)>& read);

  // Reads the keys that a table has into `target`, in the table's order but for those that come `first`.
  // `where`: the table as messages have it; `kind`: what the table describes, where rows belong to kinds.
  template <typename Target>
  Places read(const Keys<Target>& keys, const toml::table& table, const std::string& where, Target& target,
              const std::string& kind = {}) {
    Places places;
    std::vector<const KeyText*> known;
    for (const Key<Target>& key : keys)
      if (belongs(key.extras.of, kind)) known.push_back(&key);
    for (const auto& [toml_key, node] : table) {
      const std::string name(toml_key.str());
      const auto found =
          std::find_if(known.begin(), known.end(), [&](const KeyText* key) { return key->name == name; });
      if (found == known.end()) {
        unknown_key(name, toml_key.source().begin, where, known);
        continue;
      }
      places[name] = toml_key.source().begin;
      if (!(*found)->extras.first) set(static_cast<const Key<Target>&>(**found), node, places[name], target);
    }
    complain_of_missing(known, table, places, where, kind);
    return places;
  }

  // Those that come first; whether they are as they should be: without them the others have no meaning.
  template <typename Target>
  bool read_first(const Keys<Target>& keys, const toml::table& table, const std::string& where,
                  Target& target) {
    bool good = true;
    for (const Key<Target>& key : keys) {
      if (!key.extras.first) continue;
      const auto found = table.find(key.name);
      if (found != table.end()) {
        good &= set(key, found->second, found->first.source().begin, target);
      } else if (!key.extras.needed.empty()) {
        missing(key, table, where);
        good = false;
      }
    }
    return good;
  }

  void complain(const toml::source_position& at, const std::string& text) { complaints_.add(at, text); }
  void missing(const KeyText& key, const toml::table& table, const std::string& where);
  std::size_t complaints() const { return complaints_.count(); }
  // Throws what has been gathered, if anything.
  void finish() { complaints_.throw_if_any(); }

  Given given(const toml::node& node) { return {node, folder_, metres, this}; }
  const toml::table& root() const { return root_; }
  std::string place(const toml::source_position& at) const { return place_in(file_, at); }

  double metres = 1;              // of a length that is a number
  bool at_values = false;         // complaints point at a key's value, not at its name
  std::vector<KeyText> all = {};  // of the file: so that a key in a wrong table is told its own

 private:
  static bool belongs(const std::vector<std::string>& kinds, const std::string& kind) {
    return kinds.empty() || std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  }

  template <typename Target>
  bool set(const Key<Target>& key, const toml::node& node, const toml::source_position& at, Target& target) {
    try {
      key.set(target, given(node));
      return true;
    } catch (const Problem& problem) {
      wrong(key,
            problem.line ? toml::source_position{problem.line, problem.column}
            : at_values  ? node.source().begin
                         : at,
            problem);
      return false;
    }
  }

  void wrong(const KeyText& key, const toml::source_position& at, const Problem& problem);
  void unknown_key(const std::string& name, const toml::source_position& at, const std::string& where,
                   const std::vector<const KeyText*>& known);
  void unknown_table(const std::string& name, const toml::node& node, const toml::source_position& at,
                     const std::vector<std::string>& names);
  void complain_of_missing(const std::vector<const KeyText*>& known, const toml::table& table,
                           const Places& places, const std::string& where, const std::string& kind);

  std::filesystem::path file_, folder_;
  Complaints complaints_;
  toml::table root_;
};

}  // namespace plisse::config
