// Wavefront OBJ (B1 appendix of the Advanced Visualizer's manual) as plain data. The one reader and the one
// writer: models, sequences, wrinkle fields, set-ups and the curves of panels all go through them. Our own
// reader, because in a sequence every vertex must keep its number in all frames, which general importers do
// not guarantee.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace plisse::io {

// The contents of the file: v, f, o, g, usemtl, mtllib, and vt, vn, l if wanted; other lines are ignored.
// Colours stand after the positions, or in ZBrush's comments (#MRGB).
struct ObjFile {
  struct Corner {
    std::int32_t position = -1, uv = -1, normal = -1;  // from 0; −1 not given
    bool operator==(const Corner&) const = default;
  };
  // Faces and lines from the first ones named here on belong to this object, group and material, until the
  // next run. `name`: of the object or group, whichever began last.
  struct Run {
    std::string object, name, material;
    std::size_t first_triangle = 0, first_line = 0;
  };
  std::filesystem::path path;
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec3> normals;
  std::vector<std::array<Corner, 3>> triangles;     // polygons as `ObjWanted` says
  std::vector<std::array<std::uint32_t, 2>> lines;  // pieces of line elements: numbers of positions
  std::vector<Run> runs;
  std::vector<std::string> libraries;  // mtllib, as it stands: one name, or several
  std::vector<glm::vec4> colours;      // one per position, 0…1, or empty
  std::set<std::string> left_out;      // kinds of elements that the file has and nobody reads: "points", …

  std::vector<std::array<std::uint32_t, 3>> faces() const;  // the positions that the triangles join
};

// The data to read besides positions and faces. Other data is ignored, even if it is damaged.
struct ObjWanted {
  bool looks = false;  // uvs, normals, colours, and what is left out
  bool lines = false;
  // Faces of more than three corners: `cut` inside themselves by where their corners lie
  // (mesh/cut_polygon.h); fans from their first corner, which depend on the file's numbers only; or an error.
  enum class Polygons { fans, cut, refused } polygons = Polygons::fans;
};

// Throws Error(bad_input) with file:line for numbers that cannot be read or are not finite, faces with fewer
// than three corners, lines with fewer than two, and indices out of range.
ObjFile read_obj(const std::filesystem::path& path, const ObjWanted& wanted = {});

// The text of an OBJ or MTL file in UTF-8 (utf8_of_file), where a backslash at the end of a line continues
// it: such a line is one with the next, and the line numbers of the file are kept (form feeds stand for the
// ends of lines that go on).
std::string read_obj_text(const std::filesystem::path& path);

// An OBJ file in the order of the calls; indices count from 0, −1 is none, as in ObjFile.
class ObjWriter {
 public:
  // `comment`: the first line; an object's name, or empty. Blanks in names become _, since OBJ's end there.
  explicit ObjWriter(std::string_view comment, std::string_view object = {});

  void position(const glm::dvec3& position);  // nine digits
  void uv(const glm::dvec2& uv);              // nine digits
  void normal(const glm::dvec3& normal);      // seven digits
  void group(std::string_view name);
  void material(std::string_view name);
  void face(const std::array<ObjFile::Corner, 3>& corners);
  void line(std::size_t from, std::size_t to);

  // Whole or not at all. Throws Error(no_output).
  void write(const std::filesystem::path& path) const;

 private:
  std::string text_;
};

}  // namespace plisse::io
