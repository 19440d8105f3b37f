#include "config/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/fabric.h"
#include "config/frames.h"
#include "config/given.h"
#include "config/rest_choice.h"
#include "config/suggest.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;

constexpr int largest_side = 16384;  // of a picture; what OpenGL 4.5 itself promises (GL_MAX_TEXTURE_SIZE)
constexpr Range coordinates{-1e9, 1e9};

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

Problem wrong_type(const Given& given, std::string_view wanted) {
  return {fmt::format("{}, not {}", described(given.node), wanted)};
}

double finite(double value) {
  if (!std::isfinite(value)) throw Problem{fmt::format("{} is not finite", value)};
  return value;
}

// Whole numbers that a double does not hold are none here.
double double_of(const Given& given) {
  const auto value = given.node.value<double>();
  if (!value) throw Problem{"it is out of range"};
  return *value;
}

// Finds what a path in a file means; the file system decides whether it is there.
fs::path resolved(const Given& given, const std::string& text) {
  return given.folder.empty() ? fs::path(text) : given.folder / text;  // an absolute text stays what it is
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

fs::path existing_file_of(const Given& given) {
  const std::string text = text_of(given);
  const fs::path path = resolved(given, text);
  std::error_code ignored;
  if (text.empty() || !fs::is_regular_file(path, ignored))
    throw Problem{fmt::format("there is no file '{}'", path.string())};
  return path;
}

// The text, once `check` lets it pass: what that throws is the problem.
template <typename Check>
std::string checked(std::string text, const Check& check) {
  try {
    if (!text.empty()) check(text);
  } catch (const Error& error) {
    throw Problem{error.what()};
  }
  return text;
}

glm::vec3 colour_of(const Given& given) {
  glm::vec3 colour{0};
  if (const auto text = given.node.value_exact<std::string>()) {
    const char* const digits = text->data() + 1;
    std::uint32_t rgb = 0;
    if (text->size() != 7 || text->front() != '#' ||
        std::from_chars(digits, digits + 6, rgb, 16).ptr != digits + 6) {
      throw Problem{fmt::format("'{}' is not a colour", *text)};
    }
    for (int i = 0; i < 3; ++i) colour[i] = static_cast<float>((rgb >> (16 - 8 * i)) & 255U) / 255.0F;
    return colour;
  }
  const toml::array& array = array_of(given, "colour", 3);
  for (int i = 0; i < 3; ++i)
    colour[i] = static_cast<float>(within(number_of(given.part(array[static_cast<std::size_t>(i)])), {0, 1}));
  return colour;
}

std::string shown(const glm::vec3& colour) {
  return fmt::format("[{}, {}, {}]", colour.x, colour.y, colour.z);
}
std::string shown(const fs::path& path) {
  return quoted(path.string());
}

template <typename Number>
std::string plain(const Number& value) {
  return fmt::format("{}", value);
}

template <typename Read>
glm::dvec3 three(const Given& given, std::string_view wanted, const Read& read, Range range = coordinates) {
  const toml::array& array = array_of(given, wanted, 3);
  glm::dvec3 result{0};
  for (int i = 0; i < 3; ++i) result[i] = within(read(given.part(array[static_cast<std::size_t>(i)])), range);
  return result;
}

}  // namespace

double within(double value, const Range& range) {
  finite(value);
  const bool special = value == range.special_value && !range.special.empty();
  if (!special && (value < range.low || value > range.high))
    throw Problem{fmt::format("{} is out of range", value)};
  return value;
}

std::string range_text(const Range& range) {
  const std::string limits = fmt::format("{:g} … {:g}", range.low, range.high);
  return range.special.empty() ? limits
                               : fmt::format("{}; {}: {}", limits, range.special_value, range.special);
}

double number_of(const Given& given) {
  if (!given.node.is_number()) throw wrong_type(given, "a number");
  return double_of(given);
}

double length_of(const Given& given) {
  if (given.node.is_number()) return double_of(given) * given.metres;
  if (const auto text = given.node.value_exact<std::string>()) {
    if (const auto metres = parse_length(*text)) return *metres;
    throw Problem{fmt::format("'{}' is not a length like \"12 mm\" (units: {})", *text, length_units)};
  }
  throw wrong_type(given, "a length");
}

std::int64_t whole_of(const Given& given) {
  const auto value = given.node.value_exact<std::int64_t>();
  if (!value) throw wrong_type(given, "a whole number");
  return *value;
}

std::string text_of(const Given& given) {
  auto text = given.node.value_exact<std::string>();
  if (!text) throw wrong_type(given, "a text");
  if (text->find('\0') != std::string::npos) throw Problem{"the text has a zero byte in it"};
  return *text;
}

const toml::array& array_of(const Given& given, std::string_view wanted, std::size_t count) {
  const toml::array* array = given.node.as_array();
  if (!array) throw wrong_type(given, fmt::format("a {}", wanted));
  if (count == 0 && array->empty()) throw Problem{fmt::format("an empty array is no {}", wanted)};
  if (count != 0 && array->size() != count)
    throw Problem{fmt::format("{} numbers are no {}", array->size(), wanted)};
  return *array;
}

glm::dvec3 point_of(const Given& given) {
  return three(given, "point", length_of);
}
glm::dvec3 vector_of(const Given& given) {
  return three(given, "vector", number_of);
}

std::string quoted(const std::string& text) {
  std::ostringstream stream;
  const toml::value<std::string> value{text};
  stream << toml::toml_formatter{value, toml::format_flags::none};
  return stream.str();
}

std::string either(const std::vector<std::string>& words, std::string_view between, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? last : between;
    text += words[i];
  }
  return text;
}

std::size_t choice_of(const Given& given, const std::vector<std::string>& words) {
  const std::string word = text_of(given);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) throw Problem{fmt::format("'{}' is unknown", word), did_you_mean(word, words)};
  return static_cast<std::size_t>(found - words.begin());
}

Kind<double> number(Range range, std::string_view unit) {
  return {unit.empty() ? "number" : fmt::format("number, {}", unit), range_text(range),
          [=](const Given& given) { return within(number_of(given), range); }, plain<double>};
}

Kind<double> quantity(Range range, std::optional<double> (*parse)(std::string_view)) {
  return {"quantity", range_text(range), [=](const Given& given) {
            if (!given.node.is_string()) return within(number_of(given), range);
            const std::string text = text_of(given);
            const auto value = parse(text);
            if (!value) throw Problem{fmt::format("'{}' is no such value", text)};
            return within(*value, range);
          }};
}

Kind<double> length(Range range) {
  return {"length", fmt::format("{} (metres, or a text with {})", range_text(range), length_units),
          [=](const Given& given) { return within(length_of(given), range); }, plain<double>};
}

Kind<std::int64_t> whole(std::int64_t low, std::int64_t high) {
  return {"whole number", fmt::format("{} … {}", low, high),
          [=](const Given& given) {
            const std::int64_t value = whole_of(given);
            if (value < low || value > high) throw Problem{fmt::format("{} is out of range", value)};
            return value;
          },
          plain<std::int64_t>};
}

Kind<std::int64_t> one_of(std::vector<int> choices) {
  std::vector<std::string> words;
  for (const int choice : choices) words.push_back(std::to_string(choice));
  return {"whole number", either(words),
          [=](const Given& given) {
            const std::int64_t value = whole_of(given);
            if (std::find(choices.begin(), choices.end(), value) == choices.end())
              throw Problem{fmt::format("{} is not among them", value)};
            return value;
          },
          plain<std::int64_t>};
}

Kind<bool> truth() {
  return {"truth value", "true or false",
          [](const Given& given) {
            const auto value = given.node.value_exact<bool>();
            if (!value) throw wrong_type(given, "a truth value");
            return *value;
          },
          plain<bool>};
}

Kind<std::string> text() {
  return {"text", "a text in quotes", text_of, quoted, true};
}

Kind<std::string> name_or_index(std::string_view empty) {
  return {"name or index", fmt::format("a name, or an index from 0; empty: {}", empty),
          [](const Given& given) {
            const auto index = given.node.value_exact<std::int64_t>();
            if (!index) return text_of(given);
            if (*index < 0) throw Problem{fmt::format("{} is no index", *index)};
            return std::to_string(*index);
          },
          quoted, true};
}

Kind<std::vector<std::string>> names() {
  return {"names", "a text or an array of texts",
          [](const Given& given) {
            std::vector<std::string> result;
            if (const toml::array* array = given.node.as_array()) {
              for (const toml::node& item : *array) result.push_back(text_of(given.part(item)));
            } else {
              result.push_back(text_of(given));
            }
            for (const std::string& name : result)
              if (name.empty()) throw Problem{"a name is empty"};
            return result;
          },
          [](const std::vector<std::string>& names) {
            std::string text;
            for (const std::string& name : names) text += (text.empty() ? "" : ", ") + quoted(name);
            return "[" + text + "]";
          },
          true};
}

Kind<std::vector<std::string>> names_or_files() {
  Kind<std::vector<std::string>> kind = names();
  kind.read = [plain = kind.read](const Given& given) {
    std::vector<std::string> result = plain(given);
    for (std::string& name : result) {
      const fs::path path = resolved(given, name);
      if (is_there(path) || (path.has_extension() && names_many_files(path))) name = path.string();
    }
    return result;
  };
  return kind;
}

Kind<std::string> word(std::vector<std::string> words, std::string_view empty) {
  return {"word", fmt::format("{}; empty: {}", either(words), empty),
          [=](const Given& given) {
            const std::string value = text_of(given);
            return value.empty() ? value : words[choice_of(given, words)];
          },
          quoted, true};
}

Kind<std::string> frame_selection() {
  return {"frames", "7, 1-48, 1-48x2, 5..20, or several: \"1-48x2,60\"; empty: all",
          [](const Given& given) {
            const auto single = given.node.value_exact<std::int64_t>();
            return checked(single ? std::to_string(*single) : text_of(given), parse_frames);
          },
          quoted, true};
}

Kind<std::pair<int, int>> picture_size() {
  return {
      "size, pixels", fmt::format("\"WxH\" or [W, H], 1 … {} each", largest_side),
      [](const Given& given) {
        std::int64_t sides[2] = {0, 0};
        if (given.node.is_array()) {
          const toml::array& array = array_of(given, "size", 2);
          for (std::size_t i = 0; i < 2; ++i) sides[i] = whole_of(given.part(array[i]));
        } else {
          const std::string text = text_of(given);
          const char* const end = text.data() + text.size();
          const auto cross = std::from_chars(text.data(), end, sides[0]).ptr;
          const bool shaped = cross != text.data() && cross != end && (*cross == 'x' || *cross == 'X') &&
                              cross + 1 != end && std::from_chars(cross + 1, end, sides[1]).ptr == end;
          if (!shaped) throw Problem{fmt::format("'{}' is not a size like \"1280x1024\"", text)};
        }
        for (const std::int64_t side : sides)
          if (side < 1 || side > largest_side) throw Problem{fmt::format("{} is out of range", side)};
        return std::pair(static_cast<int>(sides[0]), static_cast<int>(sides[1]));
      },
      [](const std::pair<int, int>& size) { return quoted(fmt::format("{}x{}", size.first, size.second)); },
      true};
}

Kind<glm::vec3> colour() {
  return {"colour", "\"#rrggbb\" or [r, g, b] with 0 … 1 each, sRGB", colour_of,
          [](const glm::vec3& value) { return shown(value); }, true};
}

Kind<std::optional<glm::vec3>> background() {
  return {"colour", "\"#rrggbb\", [r, g, b] with 0 … 1 each, sRGB, or \"transparent\"",
          [](const Given& given) -> std::optional<glm::vec3> {
            if (given.node.value_exact<std::string>() == "transparent") return std::nullopt;
            return colour_of(given);
          },
          [](const std::optional<glm::vec3>& value) { return value ? shown(*value) : quoted("transparent"); },
          true};
}

Kind<std::optional<glm::dvec3>> optional_point() {
  return {"point", "[x, y, z], lengths, y up; empty: none",
          [](const Given& given) -> std::optional<glm::dvec3> {
            const toml::array* array = given.node.as_array();
            if (array && array->empty()) return std::nullopt;
            constexpr double infinity = std::numeric_limits<double>::infinity();
            return three(given, "point", length_of, {-infinity, infinity});
          },
          [](const std::optional<glm::dvec3>& value) {
            return value ? fmt::format("[{}, {}, {}]", value->x, value->y, value->z) : std::string("[]");
          }};
}

Kind<glm::dvec2> flat_point() {
  return {"point", "[x, y], two lengths", [](const Given& given) {
            const toml::array& array = array_of(given, "point", 2);
            glm::dvec2 result{0};
            for (int i = 0; i < 2; ++i)
              result[i] = finite(length_of(given.part(array[static_cast<std::size_t>(i)])));
            return result;
          }};
}

Kind<glm::dvec3> point() {
  return {"point", "[x, y, z], lengths", point_of};
}

Kind<glm::dvec3> vector(std::string_view allowed) {
  return {"vector", std::string(allowed), vector_of};
}

Kind<glm::dvec3> direction() {
  return {"direction", "[x, y, z]", [](const Given& given) {
            const glm::dvec3 direction = vector_of(given);
            if (glm::length(direction) == 0) throw Problem{"it has no direction"};
            return glm::normalize(direction);
          }};
}

Kind<std::vector<std::uint32_t>> indices(std::string_view allowed) {
  return {"indices", std::string(allowed), [](const Given& given) {
            std::vector<std::uint32_t> result;
            for (const toml::node& item : array_of(given, "list of numbers"))
              result.push_back(static_cast<std::uint32_t>(
                  whole(0, std::numeric_limits<std::uint32_t>::max()).read(given.part(item))));
            return result;
          }};
}

Kind<fs::path> model_path() {
  return {"path", "an existing model file, numbered pattern (drape_####.obj) or folder",
          [](const Given& given) {
            const std::string text = text_of(given);
            fs::path path = resolved(given, text);
            const fs::path parent = path.has_parent_path() ? path.parent_path() : ".";
            if (text.empty() || !is_there(is_frame_pattern(text) && !is_there(path) ? parent : path))
              throw Problem{fmt::format("there is no '{}'", path.string())};
            return path;
          },
          [](const fs::path& path) { return shown(path); }, true};
}

Kind<fs::path> existing_file(std::string_view allowed) {
  return {"path", std::string(allowed), existing_file_of, [](const fs::path& path) { return shown(path); },
          true};
}

Kind<fs::path> file_path(std::vector<std::string> endings) {
  return {"path",
          endings.empty() ? "an existing file; empty: none"
                          : fmt::format("an existing file ending in {}; empty: none", either(endings)),
          [=](const Given& given) {
            if (text_of(given).empty()) return fs::path();
            fs::path path = existing_file_of(given);
            const std::string ending = lower_case(path.extension().string());
            if (!endings.empty() && std::find(endings.begin(), endings.end(), ending) == endings.end())
              throw Problem{fmt::format("'{}' has another ending", path.string())};
            return path;
          },
          [](const fs::path& path) { return shown(path); }, true};
}

Kind<fs::path> file_or_pattern() {
  Kind<fs::path> kind =
      file_path().allowing("an existing file, or a pattern for one a frame (field_####.ply); empty: none");
  kind.read = [one = kind.read](const Given& given) {
    fs::path path = resolved(given, text_of(given));
    if (!names_many_files(path)) return one(given);
    if (!is_there(path.has_parent_path() ? path.parent_path() : "."))
      throw Problem{fmt::format("there is no folder '{}'", path.parent_path().string())};
    return path;
  };
  return kind;
}

Kind<std::string> rest_pose() {
  Kind<std::string> kind = word_or_file({"auto", "bind", "frame:1"});
  kind.allowed =
      "auto, bind, frame:N with N from 1, uv or uv:LENGTH with the length of a unit of uv, or an existing "
      "file";
  kind.read = [other = kind.read](const Given& given) {
    const std::string text = text_of(given);
    try {
      if (uv_rest_choice(text)) return text;
    } catch (const Error& error) {
      throw Problem{error.what()};
    }
    constexpr std::string_view frame = "frame:";
    if (!text.starts_with(frame)) return other(given);
    int number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data() + frame.size(), end, number);
    if (failure != std::errc{} || stop != end || number < 1)
      throw Problem{fmt::format("'{}' names no frame", text)};
    return fmt::format("{}{}", frame, number);
  };
  return kind;
}

Kind<std::string> word_or_file(std::vector<std::string> words) {
  std::vector<std::string> choices = words;
  choices.emplace_back("an existing file");
  return {"word or path", either(choices),
          [=](const Given& given) {
            const std::string text = text_of(given);
            if (std::find(words.begin(), words.end(), text) != words.end()) return text;
            const fs::path path = resolved(given, text);
            if (text.empty() || !is_there(path))
              throw Problem{fmt::format("'{}' is no such word, and there is no '{}'", text, path.string()),
                            did_you_mean(text, words)};
            return path.string();
          },
          quoted, true};
}

Kind<std::string> frame_pattern() {
  return {"path", "a folder (its files: frame_####.png), or a PNG name with ####, %04d or {frame:04}",
          [](const Given& given) {
            const std::string text = checked(text_of(given), check_frame_pattern);
            if (text.empty()) throw Problem{"the path is empty"};
            return resolved(given, text).string();
          },
          quoted, true};
}

Kind<std::string> fabric_text(std::string_view empty) {
  return {"fabric", "a name (plisse size --list-fabrics), or \"B,E\"; empty: " + std::string(empty),
          [](const Given& given) { return checked(text_of(given), parse_fabric); }, quoted, true};
}

}  // namespace plisse::config
