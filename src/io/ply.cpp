#include "io/ply.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "mesh/cut_polygon.h"

namespace plisse::io {
namespace {

using Type = PlyProperty::Type;

// In the order of Type; either name may stand in a file, the first is written.
constexpr std::array<std::array<std::string_view, 2>, 8> type_names = {{{"char", "int8"},
                                                                        {"uchar", "uint8"},
                                                                        {"short", "int16"},
                                                                        {"ushort", "uint16"},
                                                                        {"int", "int32"},
                                                                        {"uint", "uint32"},
                                                                        {"float", "float32"},
                                                                        {"double", "float64"}}};

// Calls `function` with a number of the type.
template <typename Function>
auto with_number(Type type, Function&& function) {
  switch (type) {
    case Type::int8:
      return function(std::int8_t{});
    case Type::uint8:
      return function(std::uint8_t{});
    case Type::int16:
      return function(std::int16_t{});
    case Type::uint16:
      return function(std::uint16_t{});
    case Type::int32:
      return function(std::int32_t{});
    case Type::uint32:
      return function(std::uint32_t{});
    case Type::float32:
      return function(float{});
    case Type::float64:
      break;
  }
  return function(double{});
}

std::size_t size_of(Type type) {
  return with_number(type, [](auto number) { return sizeof number; });
}

template <typename Item>
const Item* find_named(const std::vector<Item>& items, std::string_view name) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const Item& i) { return i.name == name; });
  return found == items.end() ? nullptr : &*found;
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& file, const std::vector<std::string_view>& wanted,
         const std::vector<std::string_view>& unchecked)
      : bytes_(bytes), wanted_(wanted), unchecked_(unchecked) {
    ply_.file = file;
  }

  Ply read() {
    header();
    for (std::size_t e = 0; e < ply_.elements.size(); ++e) read_items(ply_.elements[e], columns_[e]);
    return std::move(ply_);
  }

 private:
  struct Column {
    Type count;  // of a list
    bool wanted, unchecked;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}: {}", ply_.file, what));
  }
  [[noreturn]] void fail_line(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}:{}: {}", ply_.file, line_, what));
  }

  // --- header
  std::string_view next_line() {
    // "ply" and its line end begin the file: with a carriage return alone, all lines of the header have that.
    if (at_ == 0 && bytes_.size() > 4 && bytes_[3] == '\r' && bytes_[4] != '\n') line_end_ = '\r';
    const std::size_t end = bytes_.find(line_end_, at_);
    if (end == std::string_view::npos) fail("the header does not end; a line 'end_header' is missing");
    const std::string_view line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  }

  void header() {
    if (!bytes_.starts_with("ply") || trimmed(next_line()) != "ply")
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
          fail_line(fmt::format("format '{}' is none of ascii, binary_little_endian and binary_big_endian",
                                words[1]));
        if (words[2] != "1.0")
          fail_line(fmt::format("version '{}' of the format is not known; 1.0 is the only one", words[2]));
      } else if (words[0] == "element" && words.size() == 3) {
        PlyElement& element = ply_.elements.emplace_back();
        columns_.emplace_back();
        element.name = words[1];
        const char* const end = words[2].data() + words[2].size();
        if (const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
            error != std::errc{} || stop != end)
          fail_line(fmt::format("element '{}': '{}' is no number of items", words[1], words[2]));
      } else if (words[0] == "property" && (words.size() == 3 || (words.size() == 5 && words[1] == "list"))) {
        if (ply_.elements.empty()) fail_line("a property stands before the first element");
        const bool list = words.size() == 5;
        const std::string_view name = words.back();
        ply_.elements.back().properties.push_back(
            {std::string(name), type_named(words[words.size() - 2]), list});
        columns_.back().push_back({list ? type_named(words[2]) : Type::uint8,
                                   wanted_.empty() || is_in(wanted_, name) || is_in(unchecked_, name),
                                   is_in(unchecked_, name)});
      } else {
        // A line that says how the data lies cannot be left out.
        if (words[0] == "format" || words[0] == "element" || words[0] == "property")
          fail_line(fmt::format("'{}' is no line of a PLY header", line.substr(0, 80)));
        log::warn_once("header " + ply_.file,
                       fmt::format("{}:{}: '{}' is no line of a PLY header; it is left out", ply_.file, line_,
                                   line.substr(0, 80)));
      }
    }
    if (!has_format) fail("the header has no 'format'");
  }

  Type type_named(std::string_view word) const {
    for (std::size_t t = 0; t < type_names.size(); ++t)
      if (word == type_names[t][0] || word == type_names[t][1]) return static_cast<Type>(t);
    fail_line(fmt::format("'{}' is no type of PLY, such as float or uchar", word));
  }

  // --- items
  void read_items(PlyElement& element, const std::vector<Column>& columns) {
    if (element.properties.empty()) return;  // nothing stands in the file for its items
    // A count that the rest of the file cannot hold is damage, and allocates nothing. In text a number takes
    // a digit and a blank, which the last one needs not.
    std::size_t least = 0;
    for (std::size_t p = 0; p < columns.size(); ++p)
      least +=
          ascii_ ? 2 : size_of(element.properties[p].list ? columns[p].count : element.properties[p].type);
    if (element.count > (bytes_.size() - at_ + 1) / least)
      fail(fmt::format("the header promises {} of element '{}', the file is too short for that",
                       element.count, element.name));
    for (std::size_t p = 0; p < columns.size(); ++p) {
      auto& [name, type, list, values, ends] = element.properties[p];
      if (columns[p].wanted) (list ? ends.reserve(element.count) : values.reserve(element.count));
    }
    for (std::size_t i = 0; i < element.count; ++i)
      for (std::size_t p = 0; p < columns.size(); ++p)
        read_item(element, element.properties[p], i, columns[p]);
    for (std::size_t p = columns.size(); p-- > 0;)
      if (!columns[p].wanted)
        element.properties.erase(element.properties.begin() + static_cast<std::ptrdiff_t>(p));
  }

  void read_item(const PlyElement& element, PlyProperty& property, std::size_t i, const Column& column) {
    const auto where = [&] { return fmt::format("{} {}, '{}'", element.name, i, property.name); };
    double length = 1;
    if (property.list) {
      length = number(column.count, where);
      if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>(bytes_.size() - at_))
        fail(fmt::format("{}: {} is no length of a list here", where(), length));
    }
    for (double k = 0; k < length; ++k) {
      const double value = number(property.type, where);
      if (!column.wanted) continue;
      if (column.unchecked) {
        property.values.push_back(value);
        continue;
      }
      if (!std::isfinite(value)) fail(fmt::format("{}: the value is not finite", where()));
      property.values.push_back(value);
    }
    if (property.list && column.wanted) property.ends.push_back(property.values.size());
  }

  template <typename Where>
  double number(Type type, const Where& where) {
    if (ascii_) {
      constexpr std::string_view blanks = " \t\r\n";
      const std::size_t begin = std::min(bytes_.find_first_not_of(blanks, at_), bytes_.size());
      at_ = std::min(bytes_.find_first_of(blanks, begin), bytes_.size());
      const std::string_view word = bytes_.substr(begin, at_ - begin);
      if (word.empty()) fail(fmt::format("{}: the file ends before this value", where()));
      const auto value = parse_number(word);
      if (!value) fail(fmt::format("{}: '{}' is no number", where(), word.substr(0, 40)));
      return *value;
    }
    if (size_of(type) > bytes_.size() - at_)
      fail(fmt::format("{}: the file ends before this value", where()));
    return with_number(type, [&](auto value) {
      std::array<char, sizeof value> raw;
      std::memcpy(raw.data(), bytes_.data() + at_, raw.size());
      if (swapped_) std::reverse(raw.begin(), raw.end());
      at_ += raw.size();
      return static_cast<double>(std::bit_cast<decltype(value)>(raw));
    });
  }

  std::string_view bytes_;
  static bool is_in(const std::vector<std::string_view>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  const std::vector<std::string_view>&wanted_, &unchecked_;
  std::size_t at_ = 0, line_ = 0;
  char line_end_ = '\n';
  bool ascii_ = true, swapped_ = false;
  Ply ply_;
  std::vector<std::vector<Column>> columns_;  // of each element, as its properties
};

// The values of one item, in either format.
void append(std::string& bytes, Type type, double value, PlyFormat format) {
  with_number(type, [&](auto number) {
    using Number = decltype(number);
    if (format == PlyFormat::binary) {
      const auto raw = std::bit_cast<std::array<char, sizeof number>>(static_cast<Number>(value));
      bytes.append(raw.data(), raw.size());
    } else if constexpr (std::is_integral_v<Number>) {
      fmt::format_to(std::back_inserter(bytes), "{} ", static_cast<std::int64_t>(value));
    } else {
      fmt::format_to(std::back_inserter(bytes), "{:.{}g} ", value, sizeof number == 4 ? 6 : 9);
    }
  });
}

}  // namespace

const PlyProperty* PlyElement::find(std::string_view property) const {
  return find_named(properties, property);
}

const PlyProperty* PlyElement::find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view one : names)
    if (const PlyProperty* property = find(one)) return property;
  return nullptr;
}

void PlyElement::add_vectors(const std::string& prefix, Type type, const std::vector<glm::dvec3>& vectors) {
  for (int axis = 0; axis < 3; ++axis) {
    PlyProperty& property = properties.emplace_back(PlyProperty{prefix + "xyz"[axis], type});
    property.values.reserve(vectors.size());
    for (const glm::dvec3& v : vectors) property.values.push_back(v[axis]);
  }
}

void PlyElement::add_lists(const std::string& property, Type type, std::size_t length,
                           std::vector<double> values) {
  PlyProperty& lists = properties.emplace_back(PlyProperty{property, type, true, std::move(values)});
  for (std::size_t i = 1; i <= lists.values.size() / length; ++i) lists.ends.push_back(i * length);
}

const PlyElement* Ply::find(std::string_view element) const {
  return find_named(elements, element);
}

const PlyElement& Ply::element(std::string_view name) const {
  if (const PlyElement* found = find(name)) return *found;
  throw Error(ExitCode::bad_input, fmt::format("{}: has no element '{}'", file, name));
}

const std::vector<double>& Ply::numbers(std::string_view name,
                                        std::initializer_list<std::string_view> names) const {
  const PlyProperty* property = element(name).find(names);
  if (property && !property->list) return property->values;
  throw Error(ExitCode::bad_input,
              fmt::format("{}: element '{}' has no property '{}'", file, name, fmt::join(names, "' or '")));
}

std::vector<glm::dvec3> Ply::vectors(std::string_view name, const std::string& prefix) const {
  const auto &x = numbers(name, {prefix + "x"}), &y = numbers(name, {prefix + "y"}),
             &z = numbers(name, {prefix + "z"});
  std::vector<glm::dvec3> result;
  result.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) result.emplace_back(x[i], y[i], z[i]);
  return result;
}

const std::vector<double>& Ply::lists(std::string_view name, std::string_view property,
                                      std::size_t length) const {
  const PlyProperty* found = element(name).find(property);
  if (!found || !found->list)
    throw Error(ExitCode::bad_input, fmt::format("{}: element '{}' has no list '{}'", file, name, property));
  for (std::size_t i = 0; i < found->ends.size(); ++i)
    if (found->ends[i] != length * (i + 1))
      throw Error(ExitCode::bad_input,
                  fmt::format("{}: {} {}: '{}' has to have {} values", file, name, i, property, length));
  return found->values;
}

namespace {

// Calls take(face, vertex of a corner in the face's list, three corners) for every triangle.
template <typename Start, typename Take>
void for_each_triangle(const Ply& ply, Ply::Polygons polygons, const Start& start, const Take& take) {
  using Polygons = Ply::Polygons;
  const std::string& file = ply.file;
  const auto bad = [&](const std::string& what) {
    return Error(ExitCode::bad_input, fmt::format("{}: {}", file, what));
  };
  if (!ply.find("face"))
    throw bad(ply.find("tristrips") ? "it holds triangle strips; export its faces as polygons"
                                    : "has no element 'face': a cloud of points has no surface to wrinkle");
  const PlyProperty* corners = ply.element("face").find({"vertex_indices", "vertex_index"});
  if (!corners || !corners->list) throw bad("element 'face' has no list 'vertex_indices'");
  const auto count = static_cast<double>(ply.element("vertex").count);
  std::vector<glm::dvec3> positions, outline;
  start(corners->ends.size());
  for (std::size_t f = 0, begin = 0; f < corners->ends.size(); begin = corners->ends[f++]) {
    const std::size_t end = corners->ends[f];
    if (end - begin < 3 || (end - begin > 3 && polygons == Polygons::refused))
      throw bad(fmt::format("face {}: {} corners; a face {} three corners", f, end - begin,
                            polygons == Polygons::refused ? "of this kind of file has" : "needs"));
    const auto id = [&](std::size_t at) {
      const double corner = corners->values[at];
      if (!(corner >= 0 && corner < count) || corner != std::floor(corner))
        throw bad(
            fmt::format("face {}: there is no vertex {}; the file has {}, counted from 0", f, corner, count));
      return static_cast<std::uint32_t>(corner);
    };
    if (end - begin == 3 || polygons == Polygons::fans) {
      for (std::uint32_t i = 1; begin + i + 1 < end; ++i)
        take(f, {id(begin), id(begin + i), id(begin + i + 1)}, {0U, i, i + 1});
      continue;
    }
    if (positions.empty()) positions = ply.vectors("vertex");
    outline.clear();
    for (std::size_t i = begin; i < end; ++i) outline.push_back(positions[id(i)]);
    for (const auto& t : cut_polygon(outline))
      take(f, {id(begin + t[0]), id(begin + t[1]), id(begin + t[2])}, t);
  }
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> Ply::triangles(Polygons polygons) const {
  using Three = std::array<std::uint32_t, 3>;
  std::vector<Three> triangles;
  for_each_triangle(
      *this, polygons, [&](std::size_t faces) { triangles.reserve(faces); },
      [&](std::size_t, const Three& vertices, const Three&) { triangles.push_back(vertices); });
  return triangles;
}

std::vector<Ply::FaceTriangle> Ply::face_triangles(Polygons polygons) const {
  using Three = std::array<std::uint32_t, 3>;
  std::vector<FaceTriangle> triangles;
  for_each_triangle(
      *this, polygons, [&](std::size_t faces) { triangles.reserve(faces); },
      [&](std::size_t face, const Three& vertices, const Three& corners) {
        triangles.push_back({static_cast<std::uint32_t>(face), vertices, corners});
      });
  return triangles;
}

Ply parse_ply(std::string_view bytes, const std::string& file, const std::vector<std::string_view>& wanted,
              const std::vector<std::string_view>& unchecked) {
  return Reader(bytes, file, wanted, unchecked).read();
}

Ply read_ply(const std::filesystem::path& path, const std::vector<std::string_view>& wanted,
             const std::vector<std::string_view>& unchecked) {
  std::string bytes = read_whole_text(path);
  if (!bytes.starts_with("ply")) bytes = utf8_of_file(std::move(bytes));
  return parse_ply(bytes, path.string(), wanted, unchecked);
}

void write_ply(const std::filesystem::path& path, const Ply& ply, PlyFormat format) {
  static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in memory");
  const auto fail = [&](const std::string& what) {
    throw Error(ExitCode::no_output, fmt::format("{}: {}", path.string(), what));
  };
  std::string bytes =
      fmt::format("ply\nformat {} 1.0\n", format == PlyFormat::ascii ? "ascii" : "binary_little_endian");
  for (const std::string& comment : ply.comments) bytes += fmt::format("comment {}\n", comment);
  for (const PlyElement& element : ply.elements) {
    bytes += fmt::format("element {} {}\n", element.name, element.count);
    for (const PlyProperty& property : element.properties) {
      const std::size_t held = property.list ? property.ends.size() : property.values.size();
      if (held != element.count)
        fail(fmt::format("'{}' has {} items, element '{}' {}", property.name, held, element.name,
                         element.count));
      bytes += fmt::format("property {}{} {}\n", property.list ? "list uchar " : "",
                           type_names[static_cast<std::size_t>(property.type)][0], property.name);
    }
  }
  bytes += "end_header\n";
  for (const PlyElement& element : ply.elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        std::size_t first = i, last = i + 1;
        if (property.list) {
          first = i > 0 ? property.ends[i - 1] : 0;
          last = property.ends[i];
          if (last - first > 255) fail(fmt::format("a list of {} values is too long", last - first));
          append(bytes, Type::uint8, static_cast<double>(last - first), format);
        }
        for (std::size_t k = first; k < last; ++k) {
          if (!std::isfinite(property.values[k]))
            fail(fmt::format("'{}' of {} {} is not finite", property.name, element.name, i));
          append(bytes, property.type, property.values[k], format);
        }
      }
      if (format == PlyFormat::ascii) bytes.back() = '\n';
    }
  }
  write_whole_file(path, bytes);
}

}  // namespace plisse::io
