#include "config/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <sstream>
#include <system_error>
#include <tuple>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/fabric.h"
#include "config/frames.h"
#include "config/suggest.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;

constexpr int largest_side = 16384;  // of a picture; what OpenGL 4.5 itself promises (GL_MAX_TEXTURE_SIZE)

// A value as a message names it.
std::string described(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return fmt::format("'{}' is a text", *text);
  if (const auto integer = node.value_exact<std::int64_t>())
    return fmt::format("{} is a whole number", *integer);
  if (const auto number = node.value_exact<double>()) return fmt::format("{} is a number", *number);
  if (const auto truth = node.value_exact<bool>()) return fmt::format("{} is a truth value", *truth);
  if (node.is_array()) return "this is an array";
  if (node.is_table()) return "this is a table";
  return "this is a date or time";
}

Problem wrong_type(const toml::node& node, std::string_view wanted) {
  return {fmt::format("{}, not {}", described(node), wanted), ""};
}

double finite(double value) {
  if (!std::isfinite(value)) throw Problem{fmt::format("{} is not finite", value), ""};
  return value;
}

// Finds what a path in a scene means; the file system decides whether it is there.
fs::path resolved(const fs::path& folder, const std::string& text) {
  return folder.empty() ? fs::path(text) : folder / text;  // an absolute text stays what it is
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

glm::vec3 colour_of(const toml::node& node) {
  glm::vec3 colour{0};
  if (const auto text = node.value_exact<std::string>()) {
    const char* const digits = text->data() + 1;
    std::uint32_t rgb = 0;
    if (text->size() != 7 || text->front() != '#' ||
        std::from_chars(digits, digits + 6, rgb, 16).ptr != digits + 6) {
      throw Problem{fmt::format("'{}' is not a colour", *text), ""};
    }
    for (int i = 0; i < 3; ++i) colour[i] = static_cast<float>((rgb >> (16 - 8 * i)) & 255U) / 255.0F;
    return colour;
  }
  const toml::array* array = node.as_array();
  if (!array) throw wrong_type(node, "a colour");
  if (array->size() != 3) throw Problem{fmt::format("{} numbers are no colour", array->size()), ""};
  for (int i = 0; i < 3; ++i) {
    colour[i] = static_cast<float>(within(number_of((*array)[static_cast<std::size_t>(i)]), {0, 1}));
  }
  return colour;
}

std::string colour_text(const glm::vec3& colour) {
  return fmt::format("[{}, {}, {}]", colour.x, colour.y, colour.z);
}

// Settings are read through the same Member that sets them; a copy keeps the const promise.
template <typename Value>
Value read(const Member<Value>& value, const SceneSettings& settings) {
  SceneSettings copy = settings;
  return value(copy);
}

template <typename Value>
std::function<std::string(const SceneSettings&)> shown(Member<Value> value) {
  return [value](const SceneSettings& settings) { return fmt::format("{}", read(value, settings)); };
}

std::function<std::string(const SceneSettings&)> shown_text(Member<std::string> value) {
  return [value](const SceneSettings& settings) { return quoted(read(value, settings)); };
}

}  // namespace

double within(double value, const Range& range) {
  finite(value);
  const bool special = value == range.special_value && !range.special.empty();
  if (!special && (value < range.low || value > range.high)) {
    throw Problem{fmt::format("{} is out of range", value), ""};
  }
  return value;
}

std::string range_text(const Range& range) {
  const std::string limits = fmt::format("{:g} … {:g}", range.low, range.high);
  return range.special.empty() ? limits
                               : fmt::format("{}; {}: {}", limits, range.special_value, range.special);
}

namespace {
// Whole numbers that a double does not hold are none here.
double double_of(const toml::node& node) {
  const auto value = node.value<double>();
  if (!value) throw Problem{"it is out of range", ""};
  return *value;
}
}  // namespace

double number_of(const toml::node& node) {
  if (!node.is_number()) throw wrong_type(node, "a number");
  return double_of(node);
}

double length_of(const toml::node& node) {
  if (node.is_number()) return double_of(node);
  if (const auto text = node.value_exact<std::string>()) {
    if (const auto metres = parse_length(*text)) return *metres;
    throw Problem{fmt::format("'{}' is not a length like \"12 mm\" (units: {})", *text, length_units), ""};
  }
  throw wrong_type(node, "a length");
}

std::int64_t whole_of(const toml::node& node) {
  const auto value = node.value_exact<std::int64_t>();
  if (!value) throw wrong_type(node, "a whole number");
  return *value;
}

std::vector<std::string> names_of(const toml::node& node) {
  std::vector<std::string> given;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& item : *array) given.push_back(text_of(item));
  } else {
    given.push_back(text_of(node));
  }
  for (const std::string& name : given) {
    if (name.empty()) throw Problem{"a name is empty", ""};
  }
  return given;
}

fs::path existing_file(const toml::node& node, const fs::path& folder) {
  const std::string given = text_of(node);
  const fs::path path = resolved(folder, given);
  std::error_code ignored;
  if (given.empty() || !fs::is_regular_file(path, ignored))
    throw Problem{fmt::format("there is no file '{}'", path.string()), ""};
  return path;
}

std::pair<int, int> size_of(const toml::node& node) {
  std::int64_t sides[2] = {0, 0};
  if (const toml::array* array = node.as_array()) {
    if (array->size() != 2) throw Problem{fmt::format("{} numbers are no size", array->size()), ""};
    for (std::size_t i = 0; i < 2; ++i) sides[i] = whole_of((*array)[i]);
  } else {
    const std::string given = text_of(node);
    const char* const end = given.data() + given.size();
    const auto cross = std::from_chars(given.data(), end, sides[0]).ptr;
    const bool shaped = cross != given.data() && cross != end && (*cross == 'x' || *cross == 'X') &&
                        cross + 1 != end && std::from_chars(cross + 1, end, sides[1]).ptr == end;
    if (!shaped) throw Problem{fmt::format("'{}' is not a size like \"1280x1024\"", given), ""};
  }
  for (const std::int64_t side : sides) {
    if (side < 1 || side > largest_side) throw Problem{fmt::format("{} is out of range", side), ""};
  }
  return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

std::string quoted(const std::string& text) {
  std::ostringstream stream;
  const toml::value<std::string> value{text};
  stream << toml::toml_formatter{value, toml::format_flags::none};
  return stream.str();
}

std::string either(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  }
  return text;
}

Problem unknown_word(const std::string& word, const std::vector<std::string>& words) {
  return {fmt::format("'{}' is unknown", word), did_you_mean(word, words)};
}

std::string text_of(const toml::node& node) {
  auto text = node.value_exact<std::string>();
  if (!text) throw wrong_type(node, "a text");
  if (text->find('\0') != std::string::npos) throw Problem{"the text has a zero byte in it", ""};
  return *text;
}

Kind number(Member<double> value, Range range, std::string_view unit) {
  const std::string type = unit.empty() ? "number" : fmt::format("number, {}", unit);
  return {type, range_text(range),
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            value(settings) = within(number_of(node), range);
          },
          shown(value)};
}

Kind length(Member<double> value, Range range) {
  return {"length", fmt::format("{} (metres, or a text with {})", range_text(range), length_units),
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            value(settings) = within(length_of(node), range);
          },
          shown(value)};
}

Kind whole(Member<int> value, int low, int high) {
  return {"whole number", fmt::format("{} … {}", low, high),
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const std::int64_t given = whole_of(node);
            if (given < low || given > high) throw Problem{fmt::format("{} is out of range", given), ""};
            value(settings) = static_cast<int>(given);
          },
          shown(value)};
}

Kind whole(Member<std::uint32_t> value) {
  constexpr std::uint32_t high = std::numeric_limits<std::uint32_t>::max();
  return {"whole number", fmt::format("0 … {}", high),
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const std::int64_t given = whole_of(node);
            if (given < 0 || given > high) throw Problem{fmt::format("{} is out of range", given), ""};
            value(settings) = static_cast<std::uint32_t>(given);
          },
          shown(value)};
}

Kind one_of(Member<int> value, std::vector<int> choices) {
  std::vector<std::string> words;
  for (const int choice : choices) words.push_back(std::to_string(choice));
  return {"whole number", either(words),
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const std::int64_t given = whole_of(node);
            const auto found = std::find(choices.begin(), choices.end(), given);
            if (found == choices.end()) throw Problem{fmt::format("{} is not among them", given), ""};
            value(settings) = *found;
          },
          shown(value)};
}

Kind truth(Member<bool> value) {
  return {"truth value", "true or false",
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const auto given = node.value_exact<bool>();
            if (!given) throw wrong_type(node, "a truth value");
            value(settings) = *given;
          },
          shown(value)};
}

Kind name_or_index(Member<std::string> value, std::string_view empty) {
  return {"name or index", fmt::format("a name, or an index from 0; empty: {}", empty),
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            if (const auto index = node.value_exact<std::int64_t>()) {
              if (*index < 0) throw Problem{fmt::format("{} is no index", *index), ""};
              value(settings) = std::to_string(*index);
            } else {
              value(settings) = text_of(node);
            }
          },
          shown_text(value), true};
}

Kind names(Member<std::vector<std::string>> value) {
  return {"names", "a text or an array of texts",
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            value(settings) = names_of(node);
          },
          [=](const SceneSettings& settings) {
            std::string text;
            for (const std::string& name : read(value, settings)) {
              text += (text.empty() ? "" : ", ") + quoted(name);
            }
            return "[" + text + "]";
          },
          true};
}

Kind word(Member<std::string> value, std::vector<std::string> words, std::string_view empty) {
  return {"word", fmt::format("{}; empty: {}", either(words), empty),
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const std::string given = text_of(node);
            const bool known = given.empty() || std::find(words.begin(), words.end(), given) != words.end();
            if (!known) throw unknown_word(given, words);
            value(settings) = given;
          },
          shown_text(value), true};
}

Kind frame_selection(Member<std::string> value) {
  return {"frames", "7, 1-48, 1-48x2, 5..20, or several: \"1-48x2,60\"; empty: all",
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const auto single = node.value_exact<std::int64_t>();
            const std::string given = single ? std::to_string(*single) : text_of(node);
            try {
              if (!given.empty()) parse_frames(given);
            } catch (const Error& error) {
              throw Problem{error.what(), ""};
            }
            value(settings) = given;
          },
          shown_text(value), true};
}

Kind size(Member<int> width, Member<int> height) {
  return {"size, pixels", fmt::format("\"WxH\" or [W, H], 1 … {} each", largest_side),
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            std::tie(width(settings), height(settings)) = size_of(node);
          },
          [=](const SceneSettings& settings) {
            return quoted(fmt::format("{}x{}", read(width, settings), read(height, settings)));
          },
          true};
}

Kind colour(Member<glm::vec3> value) {
  return {"colour", "\"#rrggbb\" or [r, g, b] with 0 … 1 each, sRGB",
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            value(settings) = colour_of(node);
          },
          [=](const SceneSettings& settings) { return colour_text(read(value, settings)); }, true};
}

Kind background(Member<glm::vec3> value, Member<bool> transparent) {
  return {"colour", "\"#rrggbb\", [r, g, b] with 0 … 1 each, sRGB, or \"transparent\"",
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const bool clear = node.value_exact<std::string>() == "transparent";
            if (!clear) value(settings) = colour_of(node);
            transparent(settings) = clear;
          },
          [=](const SceneSettings& settings) {
            return read(transparent, settings) ? quoted("transparent") : colour_text(read(value, settings));
          },
          true};
}

Kind point(Member<glm::dvec3> value) {
  return {"point", "[x, y, z], lengths, y up; empty: none",
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const toml::array* array = node.as_array();
            if (!array) throw wrong_type(node, "a point");
            if (array->empty()) return;
            if (array->size() != 3) throw Problem{fmt::format("{} numbers are no point", array->size()), ""};
            glm::dvec3 given{0};
            for (int i = 0; i < 3; ++i) given[i] = finite(length_of((*array)[static_cast<std::size_t>(i)]));
            value(settings) = given;
          },
          [=](const SceneSettings& settings) {
            if (!settings.camera.explicit_pose) return std::string("[]");
            const glm::dvec3 given = read(value, settings);
            return fmt::format("[{}, {}, {}]", given.x, given.y, given.z);
          }};
}

Kind model_path(Member<fs::path> value) {
  return {"path", "an existing model file, numbered pattern (drape_####.obj) or folder",
          [=](SceneSettings& settings, const toml::node& node, const fs::path& folder) {
            const std::string given = text_of(node);
            const fs::path path = resolved(folder, given);
            const fs::path parent = path.has_parent_path() ? path.parent_path() : ".";
            if (given.empty() || !is_there(is_frame_pattern(given) && !is_there(path) ? parent : path)) {
              throw Problem{fmt::format("there is no '{}'", path.string()), ""};
            }
            value(settings) = path;
          },
          [=](const SceneSettings& settings) { return quoted(read(value, settings).string()); }, true};
}

Kind file_path(Member<fs::path> value) {
  return {"path", "an existing file; empty: none",
          [=](SceneSettings& settings, const toml::node& node, const fs::path& folder) {
            value(settings) = text_of(node).empty() ? fs::path() : existing_file(node, folder);
          },
          [=](const SceneSettings& settings) { return quoted(read(value, settings).string()); }, true};
}

Kind file_or_pattern(Member<fs::path> value) {
  Kind kind = file_path(value);
  kind.allowed = "an existing file, or a pattern for one a frame (field_####.ply); empty: none";
  kind.set = [=, one = kind.set](SceneSettings& settings, const toml::node& node, const fs::path& folder) {
    const fs::path path = resolved(folder, text_of(node));
    if (!names_many_files(path)) return one(settings, node, folder);
    if (!is_there(path.has_parent_path() ? path.parent_path() : "."))
      throw Problem{fmt::format("there is no folder '{}'", path.parent_path().string()), ""};
    value(settings) = path;
  };
  return kind;
}

Kind rest_pose(Member<std::string> value) {
  return {"word or path", "auto, bind, frame:N with N from 1, or an existing file",
          [=](SceneSettings& settings, const toml::node& node, const fs::path& folder) {
            const std::string given = text_of(node);
            constexpr std::string_view frame = "frame:";
            if (given == "auto" || given == "bind") {
              value(settings) = given;
            } else if (given.starts_with(frame)) {
              int number = 0;
              const char* const end = given.data() + given.size();
              const auto [stop, failure] = std::from_chars(given.data() + frame.size(), end, number);
              if (failure != std::errc{} || stop != end || number < 1) {
                throw Problem{fmt::format("'{}' names no frame", given), ""};
              }
              value(settings) = fmt::format("{}{}", frame, number);
            } else {
              const fs::path path = resolved(folder, given);
              if (given.empty() || !is_there(path)) {
                const std::vector<std::string> words = {"auto", "bind", "frame:1"};
                throw Problem{fmt::format("'{}' is no such word, and there is no '{}'", given, path.string()),
                              did_you_mean(given, words)};
              }
              value(settings) = path.string();
            }
          },
          shown_text(value), true};
}

Kind word_or_file(Member<std::string> value, std::vector<std::string> words) {
  std::vector<std::string> choices = words;
  choices.emplace_back("an existing file");
  return {"word or path", either(choices),
          [=](SceneSettings& settings, const toml::node& node, const fs::path& folder) {
            const std::string given = text_of(node);
            if (std::find(words.begin(), words.end(), given) != words.end()) {
              value(settings) = given;
              return;
            }
            const fs::path path = resolved(folder, given);
            if (given.empty() || !is_there(path)) {
              throw Problem{fmt::format("'{}' is no such word, and there is no '{}'", given, path.string()),
                            did_you_mean(given, words)};
            }
            value(settings) = path.string();
          },
          shown_text(value), true};
}

Kind file_path(Member<fs::path> value, std::vector<std::string> endings) {
  return {"path", fmt::format("an existing file ending in {}; empty: none", either(endings)),
          [=](SceneSettings& settings, const toml::node& node, const fs::path& folder) {
            const std::string given = text_of(node);
            const fs::path path = given.empty() ? fs::path() : resolved(folder, given);
            const std::string ending = lower_case(path.extension().string());
            if (!given.empty() && !is_there(path))
              throw Problem{fmt::format("there is no '{}'", path.string()), ""};
            if (!given.empty() && std::find(endings.begin(), endings.end(), ending) == endings.end())
              throw Problem{fmt::format("'{}' has another ending", path.string()), ""};
            value(settings) = path;
          },
          [=](const SceneSettings& settings) { return quoted(read(value, settings).string()); }, true};
}

Kind frame_pattern(Member<std::string> value) {
  return {"path", "a folder (its files: frame_####.png), or a PNG name with ####, %04d or {frame:04}",
          [=](SceneSettings& settings, const toml::node& node, const fs::path& folder) {
            const std::string given = text_of(node);
            if (given.empty()) throw Problem{"the path is empty", ""};
            try {
              check_frame_pattern(given);
            } catch (const Error& error) {
              throw Problem{error.what(), ""};
            }
            value(settings) = resolved(folder, given).string();
          },
          shown_text(value), true};
}

Kind fabric(Member<std::string> value) {
  return {"fabric", "a name (plisse size --list-fabrics), or \"B,E\"; empty: the panels' own",
          [=](SceneSettings& settings, const toml::node& node, const fs::path&) {
            const std::string given = text_of(node);
            try {
              if (!given.empty()) parse_fabric(given);
            } catch (const Error& error) {
              throw Problem{error.what(), ""};
            }
            value(settings) = given;
          },
          shown_text(value), true};
}

}  // namespace plisse::config
