// The kinds of values of a scene's keys: how each is read, checked, shown and described. Only config/
// sees this; toml++ nodes carry values from the command line as well.
#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/settings.h"

namespace plisse::config {

// The reason why a value is refused; the key adds what is allowed.
struct Problem {
  std::string what;
  std::string hint;  // " (did you mean 'smooth'?)" or nothing
};

struct Kind {
  std::string type;     // in a word or two, with the unit: "length", "number, degrees"
  std::string allowed;  // the range or the words
  // Throws Problem. Relative paths start from the folder; an empty one stands for the working directory.
  std::function<void(SceneSettings&, const toml::node&, const std::filesystem::path& folder)> set;
  std::function<std::string(const SceneSettings&)> show;  // the value as TOML
  bool textual = false;                                   // 007 on the command line is a name here, not seven
};

// Reaches one member of the settings.
template <typename Value>
using Member = std::function<Value&(SceneSettings&)>;

template <typename Group, typename Value>
Member<Value> member(Group SceneSettings::*group, Value Group::*value) {
  return [=](SceneSettings& settings) -> Value& { return settings.*group.*value; };
}

struct Range {
  double low = 0, high = 1;
  std::string_view special = {};  // the meaning of one value outside low … high that is also allowed
  double special_value = 0;
};

// The value of a TOML node; each throws Problem where it has another type.
double number_of(const toml::node& node);
double length_of(const toml::node& node);  // metres; not yet known to be finite
std::int64_t whole_of(const toml::node& node);
std::vector<std::string> names_of(const toml::node& node);  // a text or an array of texts, none of them empty
// The number itself; Problem where it is not finite or out of range.
double within(double value, const Range& range);
std::string range_text(const Range& range);
// The existing file that a text names, relative to the folder.
std::filesystem::path existing_file(const toml::node& node, const std::filesystem::path& folder);
// Width and height of a picture, "1280x1024" or [1280, 1024].
std::pair<int, int> size_of(const toml::node& node);

// A text as a TOML string with its quotes.
std::string quoted(const std::string& text);

Kind number(Member<double> value, Range range, std::string_view unit = {});
Kind length(Member<double> value, Range range);  // metres, or with a unit
Kind whole(Member<int> value, int low, int high);
Kind whole(Member<std::uint32_t> value);
Kind one_of(Member<int> value, std::vector<int> choices);
Kind truth(Member<bool> value);

Kind name_or_index(Member<std::string> value, std::string_view empty);  // empty: what "" stands for
Kind names(Member<std::vector<std::string>> value);
Kind word(Member<std::string> value, std::vector<std::string> words, std::string_view empty);
Kind frame_selection(Member<std::string> value);
Kind size(Member<int> width, Member<int> height);
Kind colour(Member<glm::vec3> value);
Kind background(Member<glm::vec3> value, Member<bool> transparent);
// Three lengths; an empty array stands for none.
Kind point(Member<glm::dvec3> value);

Kind model_path(Member<std::filesystem::path> value);
Kind file_path(Member<std::filesystem::path> value);  // empty: none
Kind file_or_pattern(
    Member<std::filesystem::path> value);  // likewise; a pattern's files are looked for later
Kind rest_pose(Member<std::string> value);
Kind word_or_file(Member<std::string> value, std::vector<std::string> words);
// An existing file whose name ends in one of these; empty: none.
Kind file_path(Member<std::filesystem::path> value, std::vector<std::string> endings);
Kind frame_pattern(Member<std::string> value);
Kind fabric(Member<std::string> value);  // as parse_fabric takes it; empty: none

// Words for the values of an enumeration.
template <typename Value>
using Words = std::vector<std::pair<std::string, Value>>;

std::string either(const std::vector<std::string>& words);  // "a, b or c"
Problem unknown_word(const std::string& word, const std::vector<std::string>& words);
std::string text_of(const toml::node& node);  // throws Problem where it is no text

template <typename Value>
Kind enumeration(Member<Value> value, Words<Value> words) {
  std::vector<std::string> names;
  for (const auto& [name, meaning] : words) names.push_back(name);
  Kind kind{"word", either(names), {}, {}, true};
  kind.set = [=](SceneSettings& settings, const toml::node& node, const std::filesystem::path&) {
    const std::string given = text_of(node);
    for (const auto& [name, meaning] : words) {
      if (name == given) {
        value(settings) = meaning;
        return;
      }
    }
    throw unknown_word(given, names);
  };
  kind.show = [=](const SceneSettings& settings) {
    auto copy = settings;
    for (const auto& [name, meaning] : words) {
      if (meaning == value(copy)) return quoted(name);
    }
    return quoted("");
  };
  return kind;
}

}  // namespace plisse::config
