// PLY files as tables: elements (vertex, face, …) with named properties, numbers or lists of numbers. What
// carries painted wrinkles and wrinkle fields from one program to the next (G. Turk, The PLY Polygon File
// Format, 1994).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plisse::io {

struct PlyProperty {
  enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
  std::string name;
  Type type = Type::float64;           // as the file has it, or shall have it
  bool list = false;                   // a number of values per item instead of one
  std::vector<double> values = {};     // of all items, one after the other
  std::vector<std::size_t> ends = {};  // lists: where the values of item i end
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties = {};

  const PlyProperty* find(std::string_view property) const;  // nullptr where there is none
};

struct Ply {
  std::vector<std::string> comments = {};
  std::vector<PlyElement> elements = {};

  const PlyElement* find(std::string_view element) const;
};

// ASCII or binary of either byte order. Throws Error(bad_input): no PLY, a header that makes no sense or
// promises more than the file holds, a text that is no number, a value that is not finite; with file and
// line, or element and item.
Ply read_ply(const std::filesystem::path& path);
Ply parse_ply(std::span<const std::uint8_t> bytes, const std::string& name);

// Binary little-endian, whole or not at all. Throws Error(no_output).
void write_ply(const std::filesystem::path& path, const Ply& ply);

// The values of a number property of an element, by the first of these names that it has. Throws
// Error(bad_input) naming `file`, where there is none of them.
const std::vector<double>& ply_values(const PlyElement& element,
                                      std::initializer_list<std::string_view> names, const std::string& file);

}  // namespace plisse::io
