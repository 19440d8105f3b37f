// The kinds of values that keys of our files have: how each is read, checked, shown and described. One kind
// serves the keys of every file (config/key.h puts it on a member of the settings).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plisse::config {

struct Given;  // a value as the file or the command line has it (config/given.h)

// Why a value will not do; what is allowed instead is the key's to say.
struct Problem {
  std::string what;
  std::string hint = {};               // " (did you mean 'smooth'?)" or nothing
  std::uint32_t line = 0, column = 0;  // where in the file a part of the value is wrong; 0: it is the whole
};

template <typename Value>
struct Kind {
  std::string type;                         // in a word or two, with the unit: "length", "number, degrees"
  std::string allowed;                      // the range or the words
  std::function<Value(const Given&)> read;  // throws Problem
  std::function<std::string(const Value&)> show = {};  // the value as TOML; none where no file is written
  bool textual = false;                                // 007 on the command line is a name here, not seven

  // The same kind, with other words for what is allowed.
  Kind allowing(std::string text) const {
    Kind copy = *this;
    copy.allowed = std::move(text);
    return copy;
  }
};

struct Range {
  double low = 0, high = 1;
  std::string_view special = {};  // the meaning of one value outside low … high that is also allowed
  double special_value = 0;
};
std::string range_text(const Range& range);

Kind<double> number(Range range, std::string_view unit = {});
// A number, or a text that `parse` understands.
Kind<double> quantity(Range range, std::optional<double> (*parse)(std::string_view));
Kind<double> length(Range range);  // metres, or with a unit
Kind<std::int64_t> whole(std::int64_t low, std::int64_t high);
Kind<std::int64_t> one_of(std::vector<int> choices);
Kind<bool> truth();

Kind<std::string> text();
Kind<std::string> name_or_index(std::string_view empty);  // empty: what "" stands for
Kind<std::vector<std::string>> names();
Kind<std::vector<std::string>> names_or_files();  // files that are there, or patterns, with their folder
Kind<std::string> word(std::vector<std::string> words, std::string_view empty);
Kind<std::string> frame_selection();
Kind<std::pair<int, int>> picture_size();
Kind<glm::vec3> colour();
Kind<std::optional<glm::vec3>> background();  // none: transparent
// Three lengths; none: an empty array.
Kind<std::optional<glm::dvec3>> optional_point();
Kind<glm::dvec2> flat_point();                      // two lengths
Kind<glm::dvec3> point();                           // three lengths
Kind<glm::dvec3> vector(std::string_view allowed);  // three numbers
Kind<glm::dvec3> direction();                       // likewise, made one long
Kind<std::vector<std::uint32_t>> indices(std::string_view allowed);

Kind<std::filesystem::path> model_path();
Kind<std::filesystem::path> existing_file(std::string_view allowed);
// An existing file, whose name ends in one of these where there are any; empty: none.
Kind<std::filesystem::path> file_path(std::vector<std::string> endings = {});
Kind<std::filesystem::path> file_or_pattern();  // likewise; a pattern's files are looked for later
Kind<std::string> rest_pose();
Kind<std::string> word_or_file(std::vector<std::string> words);
Kind<std::string> frame_pattern();
Kind<std::string> fabric_text(std::string_view empty);  // as parse_fabric takes it; what "" stands for

// An enumeration's values by the words that files have for them, in the order in which they are listed.
template <typename Value>
struct Word {
  std::string_view name;
  Value value;
  std::string_view doc = {};
};
template <typename Value>
using Words = std::vector<Word<Value>>;

template <typename Value>
std::vector<std::string> names_of(const Words<Value>& words) {
  std::vector<std::string> names;
  for (const Word<Value>& word : words) names.emplace_back(word.name);
  return names;
}
template <typename Value>
std::string name_of(const Words<Value>& words, const Value& value) {
  for (const Word<Value>& word : words)
    if (word.value == value) return std::string(word.name);
  return {};
}

// "a, b or c", or with other signs between them.
std::string either(const std::vector<std::string>& words, std::string_view between = ", ",
                   std::string_view last = " or ");
// Which of the words is given; throws Problem where it is none, with the nearest.
std::size_t choice_of(const Given& given, const std::vector<std::string>& words);
std::string quoted(const std::string& text);  // a text as a TOML string with its quotes

template <typename Value>
Kind<Value> enumeration(const Words<Value>& words) {
  const std::vector<std::string> names = names_of(words);
  return {"word", either(names), [=](const Given& given) { return words[choice_of(given, names)].value; },
          [=](const Value& value) { return quoted(name_of(words, value)); }, true};
}

}  // namespace plisse::config
