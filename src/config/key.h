// A key of one of our TOML files is one row: its name, the kind of its value, what it does, and where that is
// kept. The parser and its messages, the documents, the scene that `init` writes and the command line's
// options are all made from rows.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "config/kinds.h"

namespace plisse::config {

inline const std::vector<std::string> always = {"*"};

// What a row may say beside that.
struct KeyExtras {
  std::string option = {};               // the option of the command line that overrides it
  std::string option_value = {};         // as --help names its value
  std::vector<std::string> of = {};      // the kinds of stroke, obstacle, … that have it; none: all
  std::vector<std::string> needed = {};  // those that cannot do without; or `always`
  bool first = false;                    // read before all others, which depend on it
};

// What messages and documents know of a key.
struct KeyText {
  std::string table, name;
  std::string type, allowed;
  bool textual = false;
  std::string doc;  // one sentence; a line break starts a new line of a scene's comment
  KeyExtras extras;
};

template <typename Target>
struct Key : KeyText {
  std::function<void(Target&, const Given&)> set;  // throws Problem
  std::function<std::string(const Target&)> show;  // the value as TOML
};
template <typename Target>
using Keys = std::vector<Key<Target>>;

// Writes rows: row("name", &Group::member, kind, "What it does.", extras). A number that is to change over
// frames gets a type of its own for its member, and an overload of `store` for that type which reads the
// frames and their values, each by the row's kind: rows stay as they are.
template <typename Target, typename Group = Target>
class Rows {
 public:
  Rows(Keys<Target>& keys, std::string table, std::function<Group&(Target&)> group)
      : keys_(keys), table_(std::move(table)), group_(std::move(group)) {}

  template <typename Member, typename Value>
  void operator()(std::string name, Member Group::*member, const Kind<Value>& kind, std::string doc,
                  KeyExtras extras = {}) {
    (*this)(
        std::move(name), kind, std::move(doc), std::move(extras),
        [=](Group& group, Value value) { store(group.*member, std::move(value)); },
        [=](const Group& group) { return stored<Value>(group.*member); });
  }

  // For what is no single member: `set` takes the group and the value, and `get` gives it back, where values
  // are shown.
  template <typename Value, typename Set, typename Get = std::nullptr_t>
  void operator()(std::string name, const Kind<Value>& kind, std::string doc, KeyExtras extras, Set set,
                  Get get = {}) {
    Key<Target> key{
        {table_, std::move(name), kind.type, kind.allowed, kind.textual, std::move(doc), std::move(extras)},
        {},
        {}};
    key.set = [set, read = kind.read, group = group_](Target& target, const Given& given) {
      set(group(target), read(given));
    };
    if constexpr (!std::is_same_v<Get, std::nullptr_t>) {
      if (kind.show) {
        // Rows reach what they set; a copy keeps the const promise.
        key.show = [get, show = kind.show, group = group_](const Target& target) {
          Target copy = target;
          return show(get(group(copy)));
        };
      }
    }
    keys_.push_back(std::move(key));
  }

  // For values whose meaning depends on keys that are read before them: `set` reads the value, too.
  void operator()(std::string name, std::string allowed, std::string doc, KeyExtras extras,
                  std::function<void(Group&, const Given&)> set) {
    Key<Target> key{
        {table_, std::move(name), {}, std::move(allowed), true, std::move(doc), std::move(extras)}, {}, {}};
    key.set = [set = std::move(set), group = group_](Target& target, const Given& given) {
      set(group(target), given);
    };
    keys_.push_back(std::move(key));
  }

 private:
  template <typename Member, typename Value>
  static void store(Member& member, Value&& value) {
    member = static_cast<Member>(std::forward<Value>(value));
  }
  template <typename Member, typename Value>
  static void store(std::optional<Member>& member, Value&& value) {
    if constexpr (std::is_arithmetic_v<Member>) {
      member = static_cast<Member>(value);
    } else {
      member = std::forward<Value>(value);
    }
  }
  template <typename Value, typename Member>
  static Value stored(const Member& member) {
    return static_cast<Value>(member);
  }
  template <typename Value, typename Member>
  static Value stored(const std::optional<Member>& member) {
    return member ? static_cast<Value>(*member) : Value{};
  }

  Keys<Target>& keys_;
  std::string table_;
  std::function<Group&(Target&)> group_;
};

// The rows of a table, written by `list`, which is given the Rows to write them with.
template <typename Target, typename List>
Keys<Target> keys_of(const std::string& table, const List& list) {
  Keys<Target> keys;
  Rows<Target> rows(keys, table, [](Target& target) -> Target& { return target; });
  list(rows);
  return keys;
}

template <typename Target>
void append(std::vector<KeyText>& all, const Keys<Target>& keys) {
  all.insert(all.end(), keys.begin(), keys.end());
}

}  // namespace plisse::config
