#include "api/convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/error.h"

namespace plisse::api {
namespace {

Error bad(std::string_view who, const std::string& what) {
  return {ExitCode::bad_input, fmt::format("{}: {}", who, what)};
}

template <std::size_t Size>
bool finite(const std::array<double, Size>& v) {
  return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

// By the area of the triangles round each vertex, unit; up where these cancel out.
std::vector<glm::dvec3> smooth_normals(const Mesh& mesh) {
  std::vector<glm::dvec3> normals(mesh.positions.size(), glm::dvec3(0));
  for (const Triangle& t : mesh.triangles) {
    const glm::dvec3 a = to_glm(mesh.positions[t[0]]), b = to_glm(mesh.positions[t[1]]),
                     c = to_glm(mesh.positions[t[2]]);
    for (const std::uint32_t v : t) normals[v] += glm::cross(b - a, c - a);
  }
  for (glm::dvec3& n : normals) {
    const double length = glm::length(n);
    n = length > 0 ? n / length : glm::dvec3(0, 1, 0);
  }
  return normals;
}

}  // namespace

std::vector<Vector3> points_from(const std::vector<glm::dvec3>& points) {
  std::vector<Vector3> result;
  result.reserve(points.size());
  for (const glm::dvec3& p : points) result.push_back(from_glm(p));
  return result;
}

std::vector<glm::dvec3> points_to_glm(const std::vector<Vector3>& points) {
  std::vector<glm::dvec3> result;
  result.reserve(points.size());
  for (const Vector3& p : points) result.push_back(to_glm(p));
  return result;
}

log::Sink sink_of(const MessageSink& sink) {
  if (!sink) return {};
  return [sink](log::Kind kind, std::string_view text) {
    sink(kind == log::Kind::info     ? MessageLevel::detail
         : kind == log::Kind::notice ? MessageLevel::notice
                                     : MessageLevel::warning,
         text);
  };
}

void check_count(std::string_view who, std::string_view what, std::size_t found, std::size_t wanted) {
  if (found != wanted) throw bad(who, fmt::format("{} {}; there have to be {}", found, what, wanted));
}

void check_held(std::string_view who, const std::vector<std::uint8_t>& held, std::size_t vertices) {
  if (!held.empty()) check_count(who, "entries of held", held.size(), vertices);
}

void check_surface(std::string_view who, const std::vector<Vector3>& positions,
                   const std::vector<Triangle>& triangles) {
  if (triangles.empty()) throw bad(who, "has no triangles");
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (!finite(positions[v])) throw bad(who, fmt::format("the position of vertex {} is not finite", v));
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::uint32_t v : triangles[t])
      if (v >= positions.size())
        throw bad(who, fmt::format("triangle {} names vertex {}; there are {}, counted from 0", t, v,
                                   positions.size()));
}

void check_mesh(std::string_view who, const Mesh& mesh) {
  check_surface(who, mesh.positions, mesh.triangles);
  const std::size_t count = mesh.triangles.size();
  if (!mesh.uv.empty()) check_count(who, "triples of uv", mesh.uv.size(), count);
  if (!mesh.normals.empty()) check_count(who, "triples of normals", mesh.normals.size(), count);
  for (std::size_t t = 0; t < mesh.uv.size(); ++t)
    if (!std::all_of(mesh.uv[t].begin(), mesh.uv[t].end(), finite<2>))
      throw bad(who, fmt::format("uv of triangle {} are not finite", t));
  for (std::size_t t = 0; t < mesh.normals.size(); ++t)
    for (const Vector3& n : mesh.normals[t])
      // Single precision is what files and drivers keep of a normal; 1e-3 is far above its rounding.
      if (!finite(n) || std::abs(glm::length(to_glm(n)) - 1) > 1e-3)
        throw bad(who, fmt::format("a normal of triangle {} is not of length 1", t));
  std::size_t next = 0;
  for (const Mesh::Part& part : mesh.parts) {
    if (part.first_triangle != next)
      throw bad(who, fmt::format(
                         "part '{}' begins at triangle {}; it has to begin at {}, where the one before ends",
                         part.name, part.first_triangle, next));
    next += part.triangle_count;
  }
  if (!mesh.parts.empty() && next != count)
    throw bad(who,
              fmt::format("its parts have {} triangles together; they have to have all {}", next, count));
}

std::vector<std::uint32_t> flat(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> result;
  result.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) result.insert(result.end(), t.begin(), t.end());
  return result;
}

io::MeshFile file_of(const Mesh& mesh) {
  io::MeshFile file;
  file.positions = points_to_glm(mesh.positions);
  const bool own_normals = !mesh.normals.empty();
  if (!own_normals) file.normals = smooth_normals(mesh);
  std::map<std::tuple<std::uint32_t, Vector2, Vector3>, std::uint32_t> known;
  std::map<Vector3, std::uint32_t> normal_numbers;
  std::vector<bool> given(mesh.positions.size(), false);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    file.vertices.push_back({v, own_normals ? 0 : v, glm::vec2(0), glm::vec4(1)});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangles[t][c];
      const Vector2 uv = mesh.uv.empty() ? Vector2{} : mesh.uv[t][c];
      const Vector3 normal = own_normals ? mesh.normals[t][c] : Vector3{};
      const auto next = given[v] ? static_cast<std::uint32_t>(file.vertices.size()) : v;
      const auto [entry, is_new] = known.try_emplace({v, uv, normal}, next);
      if (is_new) {
        std::uint32_t n = v;
        if (own_normals) {
          const auto count = static_cast<std::uint32_t>(file.normals.size());
          const auto [number, first] = normal_numbers.try_emplace(normal, count);
          if (first) file.normals.push_back(to_glm(normal));
          n = number->second;
        }
        const io::MeshFile::Vertex vertex{v, n, glm::vec2(uv[0], uv[1]), glm::vec4(1)};
        if (given[v]) {
          file.vertices.push_back(vertex);
        } else {
          file.vertices[v] = vertex;
        }
        given[v] = true;
      }
      file.triangles.push_back(entry->second);
    }
  }
  std::vector<Mesh::Part> parts = mesh.parts;
  if (parts.empty()) parts.push_back({"mesh", "", 0, static_cast<std::uint32_t>(mesh.triangles.size())});
  for (const Mesh::Part& part : parts)
    file.parts.push_back({part.name, part.material, glm::vec4(1), true, !mesh.uv.empty(), false,
                          part.first_triangle, part.triangle_count});
  return file;
}

Mesh mesh_of(const io::MeshFile& file) {
  Mesh mesh;
  mesh.positions = points_from(file.positions);
  const bool has_uv = std::any_of(file.parts.begin(), file.parts.end(),
                                  [](const io::MeshFile::Part& part) { return part.has_uv; });
  for (std::size_t t = 0; 3 * t < file.triangles.size(); ++t) {
    Triangle triangle;
    std::array<Vector2, 3> uv;
    std::array<Vector3, 3> normals;
    for (std::size_t c = 0; c < 3; ++c) {
      const io::MeshFile::Vertex& vertex = file.vertices[file.triangles[3 * t + c]];
      triangle[c] = vertex.position;
      uv[c] = {vertex.uv.x, vertex.uv.y};
      normals[c] = from_glm(file.normals[vertex.normal]);
    }
    mesh.triangles.push_back(triangle);
    mesh.normals.push_back(normals);
    if (has_uv) mesh.uv.push_back(uv);
  }
  for (const io::MeshFile::Part& part : file.parts)
    mesh.parts.push_back({part.mesh, part.material, part.first_triangle, part.triangle_count});
  return mesh;
}

shell::Material to_shell(const Material& material) {
  const shell::Material result{material.young, material.poisson, material.thickness, material.density};
  shell::check(result);
  return result;
}

io::WrinkleField to_io(const WrinkleField& field, std::string_view who) {
  check_surface(who, field.positions, field.triangles);
  check_count(who, "amplitudes", field.amplitude.size(), field.positions.size());
  check_count(who, "triples of phases", field.phase.size(), field.triangles.size());
  io::WrinkleField result{points_to_glm(field.positions), field.amplitude, field.triangles, field.phase};
  io::check_field(result, std::string(who));
  return result;
}

}  // namespace plisse::api
