// PLY files as tables: elements (vertex, face, …) with named properties, numbers or lists of numbers (G.
// Turk, The PLY Polygon File Format, 1994). The one reader and the one writer: models, sequences, painted
// wrinkles, wrinkle fields, base surfaces and sized panels all go through them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
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

  // The property of this name, or of the first of these names that there is; nullptr where there is none.
  const PlyProperty* find(std::string_view property) const;
  const PlyProperty* find(std::initializer_list<std::string_view> names) const;

  // For a file to be written: PREFIXx, PREFIXy and PREFIXz of `count` vectors; a list of `length` values an
  // item.
  void add_vectors(const std::string& prefix, PlyProperty::Type type, const std::vector<glm::dvec3>& vectors);
  void add_lists(const std::string& property, PlyProperty::Type type, std::size_t length,
                 std::vector<double> values);
};

struct Ply {
  std::vector<std::string> comments = {};
  std::vector<PlyElement> elements = {};
  std::string file = {};  // where it was read from, for messages

  const PlyElement* find(std::string_view element) const;

  // What the file must have. All throw Error(bad_input), naming the file, where it is not there.
  const PlyElement& element(std::string_view name) const;
  // The values of a number property, by the first of these names that there is.
  const std::vector<double>& numbers(std::string_view element,
                                     std::initializer_list<std::string_view> names) const;
  // PREFIXx, PREFIXy and PREFIXz of each item.
  std::vector<glm::dvec3> vectors(std::string_view element, const std::string& prefix = "") const;
  // A list property that has `length` values for every item.
  const std::vector<double>& lists(std::string_view element, std::string_view name, std::size_t length) const;
  // The corners of the faces, numbers of vertices from 0. Polygons: as ObjWanted::Polygons (io/obj.h).
  enum class Polygons { fans, cut, refused };
  std::vector<std::array<std::uint32_t, 3>> triangles(Polygons polygons) const;
  // The same with what faces say of their corners: the face of each triangle, and where its corners stand in
  // the face's list.
  struct FaceTriangle {
    std::uint32_t face = 0;
    std::array<std::uint32_t, 3> vertex{}, corner{};
  };
  std::vector<FaceTriangle> face_triangles(Polygons polygons) const;
};

// ASCII or binary of either byte order, version 1.0; text may also be UTF-16, lines of the header may end
// with a carriage return alone. Lines of the header that no version knows are left out with a warning. Values
// of properties whose names are not in `wanted` are ignored, whatever they are; if it is empty all are read.
// The count of a list may have any type, but must be a whole number. Throws Error(bad_input): no PLY, a
// header that is invalid or declares more than the file contains, a text that is no number, a wanted value
// that is not finite; with file and line, or element and item.
// Values of `unchecked` names are read as well, and need not be finite.
Ply read_ply(const std::filesystem::path& path, const std::vector<std::string_view>& wanted = {},
             const std::vector<std::string_view>& unchecked = {});
Ply parse_ply(std::string_view bytes, const std::string& file,
              const std::vector<std::string_view>& wanted = {},
              const std::vector<std::string_view>& unchecked = {});

// Binary little-endian, or text with nine digits of a double and six of a float. Whole or not at all. Throws
// Error(no_output).
enum class PlyFormat { binary, ascii };
void write_ply(const std::filesystem::path& path, const Ply& ply, PlyFormat format = PlyFormat::binary);

}  // namespace plisse::io
