#include "io/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "mesh/cut_polygon.h"

namespace plisse::io {
namespace {

using Corner = ObjFile::Corner;

class Reader {
 public:
  Reader(const std::filesystem::path& path, const ObjWanted& wanted) : wanted_(wanted) { file_.path = path; }

  ObjFile read() {
    for_each_line(read_obj_text(file_.path), [&](std::string_view line, std::size_t number) {
      line_ = number + continued_;
      read_line(line);
      continued_ += static_cast<std::size_t>(std::count(line.begin(), line.end(), '\f'));
    });
    finish_colours();
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}:{}: {}", file_.path.string(), line_, what));
  }

  void read_line(std::string_view rest) {
    const std::string_view key = next_word(rest);
    if (key == "v") {
      const glm::dvec3 position{number(rest), number(rest), number(rest)};
      file_.positions.push_back(position);
      if (!rest.empty() && wanted_.looks) read_colour(rest);
    } else if (key == "vt" && wanted_.looks) {
      const double u = number(rest);
      file_.uvs.emplace_back(u, trimmed(rest).empty() || trimmed(rest).starts_with('#') ? 0 : number(rest));
    } else if (key == "vn" && wanted_.looks) {
      const glm::dvec3 normal{number(rest), number(rest), number(rest)};
      file_.normals.emplace_back(normal);
    } else if (key == "f") {
      read_face(rest);
    } else if (key == "l" && wanted_.lines) {
      read_line_element(rest);
    } else if (key == "o" || key == "g") {
      run_.name = trimmed(rest);
      if (key == "o") run_.object = run_.name;
      start_run();
    } else if (key == "usemtl") {
      run_.material = trimmed(rest);
      start_run();
    } else if (key == "mtllib") {
      file_.libraries.emplace_back(trimmed(rest));
    } else if (wanted_.looks) {
      if (key == "#MRGB") read_painted(trimmed(rest));
      if (key == "p") file_.left_out.insert("points");
      if (key == "l") file_.left_out.insert("lines");
      if (key == "curv" || key == "curv2" || key == "surf")
        file_.left_out.insert("free-form curves and surfaces");
    }
  }

  // Red, green, blue after a position; a fourth number is the opacity, a single one a weight.
  void read_colour(std::string_view rest) {
    std::array<double, 4> values{1, 1, 1, 1};
    std::size_t count = 0;
    for (; count < values.size(); ++count) {
      const auto value = parse_number(next_word(rest));
      if (!value || !std::isfinite(*value)) break;
      values[count] = *value;
    }
    if (count < 3) return;
    if (count == 3) values[3] = 1;
    file_.colours.resize(file_.positions.size() - 1, without);
    file_.colours.emplace_back(glm::dvec4(values[0], values[1], values[2], values[3]));
  }

  // ZBrush's colours of the vertices in turn, eight hexadecimal digits each: mask, red, green, blue.
  void read_painted(std::string_view digits) {
    for (; digits.size() >= 8; digits.remove_prefix(8)) {
      std::uint32_t value = 0;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + 8, value, 16);
      if (error != std::errc{} || end != digits.data() + 8) return;
      painted_.emplace_back(value >> 16U & 0xFFU, value >> 8U & 0xFFU, value & 0xFFU, 255U);
    }
  }

  // One colour a vertex, from 0 to 1. Some programs write them from 0 to 255.
  static constexpr glm::vec4 without{-1, -1, -1, -1};  // of vertices that have no colour
  void finish_colours() {
    if (file_.colours.empty() && painted_.size() == file_.positions.size())
      file_.colours = std::move(painted_);
    if (file_.colours.empty()) return;
    float most = 0;
    for (const glm::vec4& colour : file_.colours) most = std::max({most, colour.r, colour.g, colour.b});
    file_.colours.resize(file_.positions.size(), without);
    for (glm::vec4& colour : file_.colours) {
      if (colour == without)
        colour = glm::vec4(1);
      else if (most > 1.5F)
        colour = {glm::vec3(colour) / 255.0F, colour.a > 1 ? colour.a / 255 : colour.a};
    }
  }

  // A run that nothing belongs to is not kept.
  void start_run() {
    run_.first_triangle = file_.triangles.size();
    run_.first_line = file_.lines.size();
    if (!file_.runs.empty() && file_.runs.back().first_triangle == run_.first_triangle &&
        file_.runs.back().first_line == run_.first_line)
      file_.runs.pop_back();
    file_.runs.push_back(run_);
  }

  double number(std::string_view& rest) const {
    const std::string_view word = next_word(rest);
    const auto value = parse_number(word);
    if (!value || !std::isfinite(*value)) fail(fmt::format("'{}' is no finite number", word));
    return *value;
  }

  std::int32_t index(std::string_view word, std::size_t count, const char* what) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) fail(fmt::format("'{}' is no index", word));
    const std::int64_t resolved = value < 0 ? value + static_cast<std::int64_t>(count) : value - 1;
    if (resolved < 0 || resolved >= static_cast<std::int64_t>(count))
      fail(fmt::format("{} {} does not exist: the file has {} so far", what, value, count));
    return static_cast<std::int32_t>(resolved);
  }

  // Corners of a face or line into corners_.
  void read_corners(std::string_view rest) {
    corners_.clear();
    for (auto word = next_word(rest); !word.empty() && !word.starts_with('#'); word = next_word(rest)) {
      std::array<std::string_view, 3> parts;
      for (std::string_view& part : parts) {
        const std::size_t slash = word.find('/');
        part = word.substr(0, slash);
        word = slash == std::string_view::npos ? std::string_view() : word.substr(slash + 1);
      }
      if (parts[0].empty()) fail("a corner names no vertex");
      Corner& corner = corners_.emplace_back(Corner{index(parts[0], file_.positions.size(), "vertex")});
      if (!wanted_.looks) continue;
      if (!parts[1].empty()) corner.uv = index(parts[1], file_.uvs.size(), "texture vertex");
      if (!parts[2].empty()) corner.normal = index(parts[2], file_.normals.size(), "normal");
    }
  }

  void read_face(std::string_view rest) {
    read_corners(rest);
    if (corners_.size() < 3) fail(fmt::format("a face needs three corners, this has {}", corners_.size()));
    if (corners_.size() > 3 && wanted_.polygons == ObjWanted::Polygons::refused)
      fail(fmt::format("the faces of this mesh need three corners each, this has {}", corners_.size()));
    if (file_.runs.empty()) start_run();
    if (corners_.size() == 3 || wanted_.polygons == ObjWanted::Polygons::fans) {
      for (std::size_t i = 1; i + 1 < corners_.size(); ++i)
        file_.triangles.push_back({corners_[0], corners_[i], corners_[i + 1]});
      return;
    }
    outline_.clear();
    for (const Corner& corner : corners_)
      outline_.push_back(file_.positions[static_cast<std::size_t>(corner.position)]);
    for (const auto& [a, b, c] : cut_polygon(outline_))
      file_.triangles.push_back({corners_[a], corners_[b], corners_[c]});
  }

  void read_line_element(std::string_view rest) {
    read_corners(rest);
    if (corners_.size() < 2) fail(fmt::format("a line needs two points, this has {}", corners_.size()));
    if (file_.runs.empty()) start_run();
    for (std::size_t i = 0; i + 1 < corners_.size(); ++i)
      file_.lines.push_back({static_cast<std::uint32_t>(corners_[i].position),
                             static_cast<std::uint32_t>(corners_[i + 1].position)});
  }

  ObjWanted wanted_;
  ObjFile file_;
  ObjFile::Run run_;  // that faces belong to now
  std::size_t line_ = 0, continued_ = 0;
  std::vector<Corner> corners_;
  std::vector<glm::dvec3> outline_;
  std::vector<glm::vec4> painted_;
};

// With blanks as _: names end at white space.
std::string one_word(std::string_view name) {
  std::string word(name);
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }, '_');
  return word;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> ObjFile::faces() const {
  std::vector<std::array<std::uint32_t, 3>> faces;
  faces.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles)
    faces.push_back({static_cast<std::uint32_t>(a.position), static_cast<std::uint32_t>(b.position),
                     static_cast<std::uint32_t>(c.position)});
  return faces;
}

ObjFile read_obj(const std::filesystem::path& path, const ObjWanted& wanted) {
  return Reader(path, wanted).read();
}

std::string read_obj_text(const std::filesystem::path& path) {
  std::string text = utf8_of_file(read_whole_text(path));
  // Lines of old Macintosh files end with a carriage return alone.
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  for (std::size_t i = text.find('\\'); i != std::string::npos; i = text.find('\\', i + 1)) {
    const std::size_t end = text.find_first_not_of(" \t\r", i + 1);
    if (end == std::string::npos || text[end] != '\n') continue;
    text[i] = ' ';
    text[end] = '\f';
  }
  return text;
}

ObjWriter::ObjWriter(std::string_view comment, std::string_view object)
    : text_(fmt::format("# {}\n", comment)) {
  if (!object.empty()) text_ += fmt::format("o {}\n", one_word(object));
}

void ObjWriter::position(const glm::dvec3& x) {
  fmt::format_to(std::back_inserter(text_), "v {:.9g} {:.9g} {:.9g}\n", x.x, x.y, x.z);
}

void ObjWriter::uv(const glm::dvec2& uv) {
  fmt::format_to(std::back_inserter(text_), "vt {:.9g} {:.9g}\n", uv.x, uv.y);
}

void ObjWriter::normal(const glm::dvec3& n) {
  fmt::format_to(std::back_inserter(text_), "vn {:.7g} {:.7g} {:.7g}\n", n.x, n.y, n.z);
}

void ObjWriter::group(std::string_view name) {
  text_ += fmt::format("g {}\n", one_word(name));
}

void ObjWriter::material(std::string_view name) {
  text_ += fmt::format("usemtl {}\n", one_word(name));
}

void ObjWriter::face(const std::array<Corner, 3>& corners) {
  text_ += 'f';
  const auto out = std::back_inserter(text_);
  for (const Corner& corner : corners) {
    fmt::format_to(out, " {}", corner.position + 1);
    if (corner.uv >= 0) fmt::format_to(out, "/{}", corner.uv + 1);
    if (corner.normal >= 0) fmt::format_to(out, "{}{}", corner.uv < 0 ? "//" : "/", corner.normal + 1);
  }
  text_ += '\n';
}

void ObjWriter::line(std::size_t from, std::size_t to) {
  fmt::format_to(std::back_inserter(text_), "l {} {}\n", from + 1, to + 1);
}

void ObjWriter::write(const std::filesystem::path& path) const {
  write_whole_file(path, text_);
}

}  // namespace plisse::io
