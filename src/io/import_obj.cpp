// Wavefront OBJ and MTL (see import_obj.h).
#include "io/import_obj.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <tuple>

#include "base/error.h"
#include "base/log.h"
#include "io/import_colour.h"
#include "io/import_place.h"
#include "io/import_texture.h"

namespace plisse::io {
namespace {

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw Error(ExitCode::bad_input, fmt::format("{}: cannot be read", path.string()));
  std::string result = std::move(text).str();
  // A backslash at the end of a line continues it.
  for (std::size_t i = result.find("\\\n"); i != std::string::npos; i = result.find("\\\n", i))
    result.replace(i, 2, "  ");
  return result;
}

// A line as words; never allocates.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  std::string_view next() {
    skip_blanks();
    const std::size_t end = std::min(rest_.find_first_of(" \t\r"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  std::string_view remainder() {
    skip_blanks();
    const std::size_t end = rest_.find_last_not_of(" \t\r");
    return end == std::string_view::npos ? std::string_view{} : rest_.substr(0, end + 1);
  }

 private:
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size())); }
  std::string_view rest_;
};

template <typename Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    visit(text.substr(0, end), line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

class ObjParser {
 public:
  explicit ObjParser(const std::filesystem::path& path) { file_.path = path; }

  ObjFile parse() {
    const std::string text = read_text(file_.path);
    for_each_line(text, [&](std::string_view line, std::size_t number) {
      line_ = number;
      parse_line(line);
    });
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ExitCode::bad_input, fmt::format("{}:{}: {}", file_.path.string(), line_, what));
  }

  void parse_line(std::string_view line) {
    Words words(line);
    const std::string_view key = words.next();
    if (key == "v") {
      const glm::dvec3 position{number(words), number(words), number(words)};
      file_.positions.push_back(position);
    } else if (key == "vt") {
      const glm::dvec2 uv{number(words), number(words)};
      file_.uvs.emplace_back(uv);
    } else if (key == "vn") {
      const glm::dvec3 normal{number(words), number(words), number(words)};
      file_.normals.emplace_back(normal);
    } else if (key == "f") {
      parse_face(words);
    } else if (key == "o" || key == "g") {
      name_ = words.remainder();
      start_run();
    } else if (key == "usemtl") {
      material_ = words.remainder();
      start_run();
    } else if (key == "mtllib") {
      file_.libraries.emplace_back(words.remainder());
    }
  }

  void start_run() {
    if (!file_.runs.empty() && file_.runs.back().first_triangle == file_.triangles.size())
      file_.runs.pop_back();
    file_.runs.push_back({name_, material_, file_.triangles.size()});
  }

  double number(Words& words) const {
    std::string_view word = words.next();
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    // Too small for a double is zero; too large is left to the check below.
    if (word.empty() || error == std::errc::invalid_argument || end != word.data() + word.size())
      fail(fmt::format("'{}' is not a number", word));
    if (error == std::errc::result_out_of_range || !std::isfinite(value))
      fail(fmt::format("'{}' is not a finite number", word));
    return value;
  }

  std::int32_t index(std::string_view word, std::size_t count, const char* what) const {
    if (word.empty()) return -1;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
      fail(fmt::format("'{}' is not an index", word));
    const std::int64_t resolved = value < 0 ? value + static_cast<std::int64_t>(count) : value - 1;
    if (resolved < 0 || resolved >= static_cast<std::int64_t>(count))
      fail(fmt::format("{} {} does not exist: the file has {} so far", what, value, count));
    return static_cast<std::int32_t>(resolved);
  }

  void parse_face(Words& words) {
    polygon_.clear();
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (word.starts_with('#')) break;
      std::array<std::string_view, 3> parts;
      for (std::string_view& part : parts) {
        const std::size_t slash = std::min(word.find('/'), word.size());
        part = word.substr(0, slash);
        word.remove_prefix(std::min(slash + 1, word.size()));
      }
      ObjFile::Corner corner{index(parts[0], file_.positions.size(), "vertex"),
                             index(parts[1], file_.uvs.size(), "texture vertex"),
                             index(parts[2], file_.normals.size(), "normal")};
      if (corner.position < 0) fail("a corner of the face names no vertex");
      polygon_.push_back(corner);
    }
    if (polygon_.size() < 3) fail(fmt::format("a face needs three corners, this has {}", polygon_.size()));
    if (file_.runs.empty()) start_run();
    for (std::size_t i = 1; i + 1 < polygon_.size(); ++i)
      file_.triangles.push_back({polygon_[0], polygon_[i], polygon_[i + 1]});
  }

  ObjFile file_;
  std::size_t line_ = 0;
  std::string name_, material_;
  std::vector<ObjFile::Corner> polygon_;
};

// Kd (sRGB, as modelling programs write it), d or Tr, map_Kd. A library that is missing costs colours, not
// the model.
void read_materials(const std::filesystem::path& obj, const std::string& library, Model& model,
                    std::map<std::string, int>& ids) {
  const std::filesystem::path path = find_texture(obj, library);
  if (path.empty()) {
    log::warn(fmt::format("{}: material library '{}' not found; going on without", obj.string(), library));
    return;
  }
  Material* material = nullptr;
  for_each_line(read_text(path), [&](std::string_view line, std::size_t) {
    std::istringstream words{std::string(line)};
    std::string key;
    words >> key;
    float value = 1;
    if (key == "newmtl") {
      const std::string name{Words(line.substr(line.find("newmtl") + 6)).remainder()};
      ids.emplace(name, static_cast<int>(model.materials.size()));
      material = &model.materials.emplace_back();
      material->name = name;
    } else if (material == nullptr) {
      return;
    } else if (glm::vec3 colour{1}; key == "Kd" && words >> colour.r >> colour.g >> colour.b) {
      if (material->base_colour_texture < 0)
        material->base_colour = {linear(colour), material->base_colour.a};
    } else if ((key == "d" || key == "Tr") && words >> value) {
      const float alpha = key == "d" ? value : 1 - value;
      // Some writers mean 0 by Tr and d alike; a material that nobody could see is not what they meant.
      material->base_colour.a = alpha > 0 && alpha <= 1 ? alpha : 1;
      material->alpha = material->base_colour.a < 1 ? Material::Alpha::blend : Material::Alpha::opaque;
    } else if (key == "map_Kd") {
      // Options stand before the name; names with blanks are taken when there are no options.
      std::string name{Words(line.substr(line.find("map_Kd") + 6)).remainder()};
      if (name.starts_with('-')) name = name.substr(name.find_last_of(" \t") + 1);
      material->base_colour_texture = load_texture_file(path, name, Texture::Use::colour, model);
      if (material->base_colour_texture >= 0) material->base_colour = {1, 1, 1, material->base_colour.a};
    }
  });
}

}  // namespace

ObjFile read_obj_file(const std::filesystem::path& path) {
  return ObjParser(path).parse();
}

Model import_obj(const std::filesystem::path& path, const ImportOptions& options) {
  const ObjFile file = read_obj_file(path);
  Model model;
  model.file_vertex_count = file.positions.size();
  model.path = file.path;
  model.metres_per_unit = options.metres_per_unit.value_or(1);
  model.up = options.up.empty() ? "y" : options.up;
  const glm::dmat4 world = file_to_world(model.up, model.metres_per_unit);
  model.nodes.emplace_back().name = file.path.stem().string();

  std::map<std::string, int> material_ids;
  for (const std::string& library : file.libraries) read_materials(file.path, library, model, material_ids);
  const auto material_id = [&](const std::string& name) {
    if (name.empty()) return -1;
    const auto [entry, added] = material_ids.emplace(name, static_cast<int>(model.materials.size()));
    if (added) model.materials.emplace_back().name = name;
    return entry->second;
  };

  // Runs of one name and material are one mesh, in the order of their first triangle.
  std::map<std::pair<std::string, std::string>, std::size_t> mesh_ids;
  using Key = std::tuple<std::int32_t, std::int32_t, std::int32_t>;
  std::vector<std::map<Key, std::uint32_t>> vertex_ids;
  for (std::size_t r = 0; r < file.runs.size(); ++r) {
    const ObjFile::Run& run = file.runs[r];
    const std::size_t end =
        r + 1 < file.runs.size() ? file.runs[r + 1].first_triangle : file.triangles.size();
    if (run.first_triangle == end) continue;
    const auto [entry, added] = mesh_ids.try_emplace({run.name, run.material}, model.meshes.size());
    const std::size_t id = entry->second;
    if (added) {
      Mesh& mesh = model.meshes.emplace_back();
      mesh.name = run.name.empty() ? file.path.stem().string() : run.name;
      mesh.material = material_id(run.material);
      vertex_ids.emplace_back();
      model.nodes[0].meshes.push_back(static_cast<int>(id));
    }
    Mesh& mesh = model.meshes[id];
    for (std::size_t t = run.first_triangle; t < end; ++t)
      for (const ObjFile::Corner& corner : file.triangles[t]) {
        const auto [vertex, fresh] = vertex_ids[id].try_emplace(
            {corner.position, corner.uv, corner.normal}, static_cast<std::uint32_t>(mesh.positions.size()));
        if (fresh) {
          mesh.positions.emplace_back(
              world * glm::dvec4(file.positions[static_cast<std::size_t>(corner.position)], 1));
          mesh.file_vertices.push_back(static_cast<std::uint32_t>(corner.position));
          // A corner without uv or normal gets a blank, and the mesh loses the array where all are blank.
          mesh.uvs.push_back(corner.uv < 0 ? glm::vec2{0} : file.uvs[static_cast<std::size_t>(corner.uv)]);
          const glm::dvec3 normal = corner.normal < 0
                                        ? glm::dvec3{0}
                                        : glm::dvec3(file.normals[static_cast<std::size_t>(corner.normal)]);
          const double length = glm::length(normal);
          mesh.normals.emplace_back(length > 0 ? glm::dmat3(world) * normal / (length * model.metres_per_unit)
                                               : glm::dvec3{0});
        }
        mesh.triangles.push_back(vertex->second);
      }
  }
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    Mesh& mesh = model.meshes[m];
    const auto blank = [](const std::map<Key, std::uint32_t>& ids, auto member) {
      for (const auto& [key, id] : ids)
        if (member(key) >= 0) return false;
      return true;
    };
    if (blank(vertex_ids[m], [](const Key& key) { return std::get<1>(key); })) mesh.uvs.clear();
    // Normals on some corners only cannot be told from damage; the surface's own are used then.
    for (const glm::vec3& normal : mesh.normals)
      if (glm::dot(normal, normal) < 0.5F) {
        mesh.normals.clear();
        break;
      }
  }
  return model;
}

}  // namespace plisse::io
