// PLY 1.0 (G. Turk, "The PLY Polygon File Format", 1994; see import_ply.h). The header names elements
// (vertex, face, …) and the properties of each, numbers or lists of numbers; after it stand all items of the
// first element, then all of the second, and so on.
#include "io/import_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/import_place.h"

namespace plisse::io {
namespace {

enum class Format { ascii, little, big };
enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

std::optional<Type> type_named(std::string_view name) {
  constexpr std::pair<std::string_view, Type> names[] = {
      {"char", Type::i8},   {"int8", Type::i8},     {"uchar", Type::u8},   {"uint8", Type::u8},
      {"short", Type::i16}, {"int16", Type::i16},   {"ushort", Type::u16}, {"uint16", Type::u16},
      {"int", Type::i32},   {"int32", Type::i32},   {"uint", Type::u32},   {"uint32", Type::u32},
      {"float", Type::f32}, {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64}};
  for (const auto& [known, type] : names)
    if (known == name) return type;
  return std::nullopt;
}

std::size_t size_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Type type = Type::f32;
  std::optional<Type> count;  // of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  // Position of the first of these names; −1 where there is none.
  int find(std::initializer_list<std::string_view> wanted) const {
    for (const std::string_view one : wanted)
      for (std::size_t p = 0; p < properties.size(); ++p)
        if (properties[p].name == one) return static_cast<int>(p);
    return -1;
  }
};

class PlyParser {
 public:
  PlyParser(std::span<const std::uint8_t> bytes, const std::filesystem::path& path)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), path_(path) {}

  PlyFile parse() {
    read_header();
    bool vertices = false, faces = false;
    for (const Element& element : elements_) {
      where_ = element.name;
      check_room(element);
      if (element.name == "vertex") {
        read_vertices(element);
        vertices = true;
      } else if (element.name == "face") {
        read_faces(element);
        faces = true;
      } else {
        for (item_ = 0; item_ < element.count; ++item_) read_item(element, -1);
      }
    }
    where_.clear();
    if (!vertices) fail("it has no element 'vertex'");
    if (!faces)
      fail(std::any_of(elements_.begin(), elements_.end(),
                       [](const Element& e) { return e.name == "tristrips"; })
               ? "it holds triangle strips; export its faces as polygons"
               : "it has no element 'face': a cloud of points has no surface to wrinkle");
    for (const auto& triangle : file_.triangles)
      for (const std::uint32_t corner : triangle)
        if (corner >= file_.positions.size())
          fail(fmt::format("a face names vertex {}, but there are {}, counted from 0", corner,
                           file_.positions.size()));
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const std::string place = where_.empty() ? "" : fmt::format("{} {}: ", where_, item_);
    throw Error(ExitCode::bad_input, fmt::format("{}: {}{}", path_.string(), place, what));
  }

  // --- header
  std::string_view line() {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos) fail("its header has no end");
    std::string_view result = text_.substr(at_, end - at_);
    at_ = end + 1;
    while (!result.empty() && (result.back() == '\r' || result.back() == ' ')) result.remove_suffix(1);
    return result;
  }

  static std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      if (line.empty()) return words;
      const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
      words.push_back(line.substr(0, end));
      line.remove_prefix(end);
    }
  }

  Type type_of(std::string_view name) const {
    const std::optional<Type> type = type_named(name);
    if (!type) fail(fmt::format("'{}' is no type of PLY, such as float or uchar", name));
    return *type;
  }

  void read_header() {
    if (text_.substr(0, 3) != "ply" || line() != "ply")
      fail("not a PLY file: it does not begin with a line 'ply'");
    bool has_format = false;
    while (true) {
      const std::string_view whole = line();
      const std::vector<std::string_view> words = words_of(whole);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() == 3 && words[2] == "1.0") {
        has_format = true;
        if (words[1] == "ascii")
          format_ = Format::ascii;
        else if (words[1] == "binary_little_endian")
          format_ = Format::little;
        else if (words[1] == "binary_big_endian")
          format_ = Format::big;
        else
          fail(fmt::format("format '{}' is none of ascii, binary_little_endian and binary_big_endian",
                           words[1]));
      } else if (words[0] == "element" && words.size() == 3) {
        Element& element = elements_.emplace_back();
        element.name = words[1];
        const char* const end = words[2].data() + words[2].size();
        if (const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
            error != std::errc{} || stop != end)
          fail(fmt::format("element '{}': '{}' is no count", words[1], words[2]));
      } else if (words[0] == "property" && !elements_.empty() && words.size() == 3) {
        elements_.back().properties.push_back({std::string(words[2]), type_of(words[1]), std::nullopt});
      } else if (words[0] == "property" && !elements_.empty() && words.size() == 5 && words[1] == "list") {
        const Type count = type_of(words[2]);
        if (count == Type::f32 || count == Type::f64) fail("a list counted in floating point");
        elements_.back().properties.push_back({std::string(words[4]), type_of(words[3]), count});
      } else {
        fail(fmt::format("'{}' is no line of a PLY header", whole.substr(0, 80)));
      }
    }
    if (!has_format) fail("its header names no format");
  }

  // --- items
  // A count that the rest of the file cannot hold is damage, and allocates nothing.
  void check_room(const Element& element) const {
    std::size_t least = 0;
    for (const Property& property : element.properties)
      least +=
          format_ == Format::ascii ? 2 : size_of(property.count.value_or(property.type));  // digit and blank
    if (least == 0 && element.count > 0) fail("an element without properties");
    const std::size_t left = text_.size() - at_ + 1;  // the last digit needs no blank
    if (element.count > 0 && element.count > left / least)
      fail(fmt::format("the header promises {} of them, for which the file is too short", element.count));
  }

  double number(Type type) {
    const double value = format_ == Format::ascii ? number_in_words() : number_in_bytes(type);
    return value;
  }

  double number_in_words() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
    if (at_ == text_.size()) fail("the file ends here");
    if (text_[at_] == '+') ++at_;
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    const bool whole = end == text_.data() + text_.size() ||
                       std::string_view(" \t\r\n").find(*end) != std::string_view::npos;
    if (error != std::errc{} || !whole)
      fail(fmt::format(
          "'{}' is no number",
          text_.substr(at_, std::min(text_.find_first_of(" \t\r\n", at_) - at_, std::size_t{40}))));
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  template <typename Value>
  double plain() {
    if (text_.size() - at_ < sizeof(Value)) fail("the file ends here");
    std::array<char, sizeof(Value)> bytes;
    std::memcpy(bytes.data(), text_.data() + at_, sizeof(Value));
    at_ += sizeof(Value);
    static_assert(std::endian::native == std::endian::little);
    if (format_ == Format::big) std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<Value>(bytes));
  }

  double number_in_bytes(Type type) {
    switch (type) {
      case Type::i8:
        return plain<std::int8_t>();
      case Type::u8:
        return plain<std::uint8_t>();
      case Type::i16:
        return plain<std::int16_t>();
      case Type::u16:
        return plain<std::uint16_t>();
      case Type::i32:
        return plain<std::int32_t>();
      case Type::u32:
        return plain<std::uint32_t>();
      case Type::f32:
        return plain<float>();
      case Type::f64:
        return plain<double>();
    }
    return 0;
  }

  // Values of the item's properties in values_ (of a list: how many), and of the list `wanted` in list_.
  void read_item(const Element& element, int wanted) {
    values_.clear();
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      if (!property.count) {
        values_.push_back(number(property.type));
        continue;
      }
      const double count = number(*property.count);
      if (!(count >= 0) || count > static_cast<double>(text_.size() - at_) || count != std::floor(count))
        fail(fmt::format("a list of {} entries", count));
      values_.push_back(count);
      const bool keep = static_cast<int>(p) == wanted;
      if (keep) list_.clear();
      for (double i = 0; i < count; ++i) {
        const double entry = number(property.type);
        if (keep) list_.push_back(entry);
      }
    }
  }

  double value(int property) const { return values_[static_cast<std::size_t>(property)]; }

  float finite(int property) const {
    const double result = value(property);
    if (!std::isfinite(static_cast<float>(result))) fail(fmt::format("{} is not a finite number", result));
    return static_cast<float>(result);
  }

  void read_vertices(const Element& element) {
    const int x = element.find({"x"}), y = element.find({"y"}), z = element.find({"z"});
    if (x < 0 || y < 0 || z < 0) fail("vertices need properties x, y and z");
    const int nx = element.find({"nx"}), ny = element.find({"ny"}), nz = element.find({"nz"});
    const int u = element.find({"s", "u", "texture_u", "texture_s"}),
              v = element.find({"t", "v", "texture_v", "texture_t"});
    for (item_ = 0; item_ < element.count; ++item_) {
      read_item(element, -1);
      file_.positions.emplace_back(value(x), value(y), value(z));
      const glm::dvec3& position = file_.positions.back();
      if (!std::isfinite(position.x + position.y + position.z)) fail("its position is not finite");
      if (nx >= 0 && ny >= 0 && nz >= 0) file_.normals.emplace_back(finite(nx), finite(ny), finite(nz));
      if (u >= 0 && v >= 0) file_.uvs.emplace_back(finite(u), finite(v));
    }
  }

  void read_faces(const Element& element) {
    const int corners = element.find({"vertex_indices", "vertex_index"});
    if (corners < 0 || !element.properties[static_cast<std::size_t>(corners)].count)
      fail("faces need a list 'vertex_indices'");
    for (item_ = 0; item_ < element.count; ++item_) {
      read_item(element, corners);
      if (list_.size() < 3) fail(fmt::format("a face needs three corners, this has {}", list_.size()));
      for (const double corner : list_)
        if (!(corner >= 0) || corner > 4294967295.0 || corner != std::floor(corner))
          fail(fmt::format("{} is no number of a vertex", corner));
      const auto id = [&](std::size_t corner) { return static_cast<std::uint32_t>(list_[corner]); };
      for (std::size_t i = 1; i + 1 < list_.size(); ++i) file_.triangles.push_back({id(0), id(i), id(i + 1)});
    }
  }

  std::string_view text_;
  std::filesystem::path path_;
  std::size_t at_ = 0;
  Format format_ = Format::ascii;
  std::vector<Element> elements_;
  std::string where_;  // the element at hand, for messages
  std::uint64_t item_ = 0;
  std::vector<double> values_, list_;
  PlyFile file_;
};

}  // namespace

PlyFile parse_ply(std::span<const std::uint8_t> bytes, const std::filesystem::path& path) {
  return PlyParser(bytes, path).parse();
}

PlyFile read_ply_file(const std::filesystem::path& path) {
  return parse_ply(read_whole_file(path), path);
}

Model import_ply(const std::filesystem::path& path, const ImportOptions& options) {
  PlyFile file = read_ply_file(path);
  Model model;
  model.path = path;
  model.metres_per_unit = options.metres_per_unit.value_or(1);
  model.up = options.up.empty() ? "y" : options.up;
  const glm::dmat4 world = file_to_world(model.up, model.metres_per_unit);
  model.file_vertex_count = file.positions.size();
  Node& node = model.nodes.emplace_back();
  node.name = path.stem().string();
  node.meshes = {0};
  Mesh& mesh = model.meshes.emplace_back();
  mesh.name = node.name;
  mesh.uvs = std::move(file.uvs);
  mesh.positions.reserve(file.positions.size());
  mesh.file_vertices.reserve(file.positions.size());
  for (const glm::dvec3& position : file.positions) {
    mesh.file_vertices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.emplace_back(world * glm::dvec4(position, 1));
  }
  const glm::dmat3 turn(upright(model.up));
  for (const glm::vec3& normal : file.normals) {
    const double length = glm::length(glm::dvec3(normal));
    // Normals that are missing on some vertices cannot be told from damage; the surface's own are used then.
    if (!(length > 0)) {
      mesh.normals.clear();
      break;
    }
    mesh.normals.emplace_back(turn * glm::dvec3(normal) / length);
  }
  mesh.triangles.reserve(3 * file.triangles.size());
  for (const auto& triangle : file.triangles)
    mesh.triangles.insert(mesh.triangles.end(), triangle.begin(), triangle.end());
  return model;
}

}  // namespace plisse::io
