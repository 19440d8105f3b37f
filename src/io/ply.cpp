#include "io/ply.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"

namespace plisse::io {
namespace {

using Type = PlyProperty::Type;

struct TypeInfo {
  Type type;
  std::string_view name, other_name;
  std::size_t bytes;
};
constexpr std::array<TypeInfo, 8> types = {{{Type::int8, "char", "int8", 1},
                                            {Type::uint8, "uchar", "uint8", 1},
                                            {Type::int16, "short", "int16", 2},
                                            {Type::uint16, "ushort", "uint16", 2},
                                            {Type::int32, "int", "int32", 4},
                                            {Type::uint32, "uint", "uint32", 4},
                                            {Type::float32, "float", "float32", 4},
                                            {Type::float64, "double", "float64", 8}}};

const TypeInfo& info(Type type) {
  return *std::find_if(types.begin(), types.end(), [&](const TypeInfo& t) { return t.type == type; });
}

template <typename Number>
double number_at(const std::uint8_t* bytes, bool swapped) {
  std::array<std::uint8_t, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes, raw.size());
  if (swapped) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Number>(raw));
}

double decode(Type type, const std::uint8_t* bytes, bool swapped) {
  switch (type) {
    case Type::int8:
      return number_at<std::int8_t>(bytes, swapped);
    case Type::uint8:
      return number_at<std::uint8_t>(bytes, swapped);
    case Type::int16:
      return number_at<std::int16_t>(bytes, swapped);
    case Type::uint16:
      return number_at<std::uint16_t>(bytes, swapped);
    case Type::int32:
      return number_at<std::int32_t>(bytes, swapped);
    case Type::uint32:
      return number_at<std::uint32_t>(bytes, swapped);
    case Type::float32:
      return number_at<float>(bytes, swapped);
    case Type::float64:
      break;
  }
  return number_at<double>(bytes, swapped);
}

template <typename Number>
void append(std::vector<std::uint8_t>& out, double value) {
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(Number)>>(static_cast<Number>(value));
  out.insert(out.end(), raw.begin(), raw.end());
}

void encode(std::vector<std::uint8_t>& out, Type type, double value) {
  switch (type) {
    case Type::int8:
      return append<std::int8_t>(out, value);
    case Type::uint8:
      return append<std::uint8_t>(out, value);
    case Type::int16:
      return append<std::int16_t>(out, value);
    case Type::uint16:
      return append<std::uint16_t>(out, value);
    case Type::int32:
      return append<std::int32_t>(out, value);
    case Type::uint32:
      return append<std::uint32_t>(out, value);
    case Type::float32:
      return append<float>(out, value);
    case Type::float64:
      break;
  }
  append<double>(out, value);
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r", at);
    if (begin == std::string_view::npos) break;
    at = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.push_back(line.substr(begin, at - begin));
  }
  return words;
}

template <typename Number>
bool parse(std::string_view text, Number& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [stop, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc{} && stop == text.data() + text.size();
}

class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  Ply read() {
    header();
    for (PlyElement& element : ply_.elements) {
      // Each item takes at least a byte a property (two as text, but for the last): no count can ask for more
      // memory than a few times the file.
      const std::size_t least = std::max<std::size_t>(element.properties.size(), 1);
      if (element.count > (bytes_.size() - at_ + 1) / least) {
        fail(fmt::format("the header promises {} of element '{}', the file is too short for that",
                         element.count, element.name));
      }
      for (std::size_t i = 0; i < element.count; ++i) {
        for (PlyProperty& property : element.properties) item(element, property, i);
      }
    }
    return std::move(ply_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}", name_, what));
  }
  [[noreturn]] void fail_line(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}:{}: {}", name_, line_, what));
  }

  std::string_view next_line() {
    if (at_ >= bytes_.size()) fail("the header does not end; 'end_header' is missing");
    const auto* begin = bytes_.data() + at_;
    const auto* end = std::find(begin, bytes_.data() + bytes_.size(), std::uint8_t{'\n'});
    at_ = static_cast<std::size_t>(end - bytes_.data()) + 1;
    ++line_;
    std::string_view text(reinterpret_cast<const char*>(begin), static_cast<std::size_t>(end - begin));
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  void header() {
    if (bytes_.size() < 4 || words_of(next_line()) != std::vector<std::string_view>{"ply"})
      fail("is no PLY file; its first line has to be 'ply'");
    bool has_format = false;
    while (true) {
      const std::string_view line = next_line();
      const auto words = words_of(line);
      if (words.empty()) continue;
      if (words[0] == "end_header") break;
      if (words[0] == "comment" || words[0] == "obj_info") {
        ply_.comments.emplace_back(line.substr(std::min(line.size(), words[0].size() + 1)));
      } else if (words[0] == "format" && words.size() == 3) {
        has_format = true;
        ascii_ = words[1] == "ascii";
        const bool big = words[1] == "binary_big_endian";
        swapped_ = big != (std::endian::native == std::endian::big);
        if (!ascii_ && !big && words[1] != "binary_little_endian")
          fail_line("the format is none of PLY's three");
      } else if (words[0] == "element" && words.size() == 3) {
        PlyElement element;
        element.name = words[1];
        if (!parse(words[2], element.count)) fail_line(fmt::format("'{}' is no number of items", words[2]));
        ply_.elements.push_back(std::move(element));
      } else if (words[0] == "property" && (words.size() == 3 || (words.size() == 5 && words[1] == "list"))) {
        if (ply_.elements.empty()) fail_line("a property stands before the first element");
        PlyProperty property;
        property.list = words.size() == 5;
        property.name = words.back();
        property.type = type_of(words[words.size() - 2]);
        auto& element = ply_.elements.back();
        length_types_.resize(ply_.elements.size());
        length_types_.back().push_back(property.list ? type_of(words[2]) : Type::uint8);
        element.properties.push_back(std::move(property));
      } else {
        fail_line(fmt::format("'{}' is no line of a PLY header", line.substr(0, 60)));
      }
    }
    length_types_.resize(ply_.elements.size());
    if (!has_format) fail("the header has no 'format'");
  }

  Type type_of(std::string_view word) const {
    for (const TypeInfo& type : types) {
      if (word == type.name || word == type.other_name) return type.type;
    }
    fail_line(fmt::format("'{}' is no type of PLY", word));
  }

  void item(const PlyElement& element, PlyProperty& property, std::size_t i) {
    std::size_t length = 1;
    if (property.list) {
      const auto e = static_cast<std::size_t>(&element - ply_.elements.data());
      const auto p = static_cast<std::size_t>(&property - element.properties.data());
      const double given = value(element, property, i, length_types_[e][p]);
      if (given < 0 || given != std::floor(given) || given > static_cast<double>(bytes_.size()))
        fail(fmt::format("{} {}: {} is no length of the list '{}'", element.name, i, given, property.name));
      length = static_cast<std::size_t>(given);
    }
    for (std::size_t k = 0; k < length; ++k)
      property.values.push_back(value(element, property, i, property.type));
    if (property.list) property.ends.push_back(property.values.size());
  }

  double value(const PlyElement& element, const PlyProperty& property, std::size_t i, Type type) {
    const auto where = [&] { return fmt::format("{} {}, '{}'", element.name, i, property.name); };
    double result = 0;
    if (ascii_) {
      const auto is_space = [](std::uint8_t c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
      while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
      const std::size_t begin = at_;
      while (at_ < bytes_.size() && !is_space(bytes_[at_])) ++at_;
      const std::string_view word(reinterpret_cast<const char*>(bytes_.data()) + begin, at_ - begin);
      if (word.empty()) fail(fmt::format("{}: the file ends before this value", where()));
      if (!parse(word, result)) fail(fmt::format("{}: '{}' is no number", where(), word.substr(0, 40)));
    } else {
      const std::size_t size = info(type).bytes;
      if (size > bytes_.size() - at_) fail(fmt::format("{}: the file ends before this value", where()));
      result = decode(type, bytes_.data() + at_, swapped_);
      at_ += size;
    }
    if (!std::isfinite(result)) fail(fmt::format("{}: the value is not finite", where()));
    return result;
  }

  std::span<const std::uint8_t> bytes_;
  std::string name_;
  std::size_t at_ = 0, line_ = 0;
  bool ascii_ = true, swapped_ = false;
  Ply ply_;
  std::vector<std::vector<Type>> length_types_;  // per element and property
};

template <typename Item>
const Item* find_named(const std::vector<Item>& items, std::string_view name) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const Item& i) { return i.name == name; });
  return found == items.end() ? nullptr : &*found;
}

}  // namespace

const PlyProperty* PlyElement::find(std::string_view property) const {
  return find_named(properties, property);
}

const PlyElement* Ply::find(std::string_view element) const {
  return find_named(elements, element);
}

Ply parse_ply(std::span<const std::uint8_t> bytes, const std::string& name) {
  return Reader(bytes, name).read();
}

Ply read_ply(const std::filesystem::path& path) {
  return parse_ply(read_whole_file(path), path.string());
}

void write_ply(const std::filesystem::path& path, const Ply& ply) {
  static_assert(std::endian::native == std::endian::little, "write_ply copies numbers as they lie in memory");
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : ply.comments) header += fmt::format("comment {}\n", comment);
  for (const PlyElement& element : ply.elements) {
    header += fmt::format("element {} {}\n", element.name, element.count);
    for (const PlyProperty& property : element.properties) {
      const std::size_t held = property.list ? property.ends.size() : property.values.size();
      if (held != element.count) {
        throw Error(ExitCode::no_output, fmt::format("{}: '{}' has {} items, element '{}' {}", path.string(),
                                                     property.name, held, element.name, element.count));
      }
      header += fmt::format("property {}{} {}\n", property.list ? "list uchar " : "",
                            info(property.type).name, property.name);
    }
  }
  header += "end_header\n";
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  for (const PlyElement& element : ply.elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        std::size_t first = i, last = i + 1;
        if (property.list) {
          first = i > 0 ? property.ends[i - 1] : 0;
          last = property.ends[i];
          if (last - first > 255) {
            throw Error(ExitCode::no_output,
                        fmt::format("{}: a list of {} values is too long", path.string(), last - first));
          }
          bytes.push_back(static_cast<std::uint8_t>(last - first));
        }
        for (std::size_t k = first; k < last; ++k) {
          if (!std::isfinite(property.values[k])) {
            throw Error(ExitCode::no_output, fmt::format("{}: '{}' of {} {} is not finite", path.string(),
                                                         property.name, element.name, i));
          }
          encode(bytes, property.type, property.values[k]);
        }
      }
    }
  }
  write_whole_file(path, bytes);
}

const std::vector<double>& ply_values(const PlyElement& element,
                                      std::initializer_list<std::string_view> names,
                                      const std::string& file) {
  for (const std::string_view name : names) {
    const PlyProperty* property = element.find(name);
    if (property && !property->list) return property->values;
  }
  throw Error(ExitCode::bad_input, fmt::format("{}: element '{}' has no property '{}'", file, element.name,
                                               fmt::join(names, "' or '")));
}

}  // namespace plisse::io
