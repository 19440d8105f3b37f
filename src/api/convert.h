// Between the plain types of the public face and ours.
#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "base/message_scope.h"
#include "io/mesh_file.h"
#include "io/wrinkle_field.h"
#include "plisse/wrinkle.h"
#include "shell/material.h"

namespace plisse::api {

inline Vector3 from_glm(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
inline glm::dvec3 to_glm(const Vector3& v) {
  return {v[0], v[1], v[2]};
}
std::vector<Vector3> points_from(const std::vector<glm::dvec3>& points);
std::vector<glm::dvec3> points_to_glm(const std::vector<Vector3>& points);

// A sink as base/message_scope.h takes it; empty stays empty.
log::Sink sink_of(const MessageSink& sink);

// Throw Error(bad_input), which begins with `who`: a number that is not finite; a triangle that names a
// vertex which is not there; nothing at all; lists whose lengths do not belong together.
void check_surface(std::string_view who, const std::vector<Vector3>& positions,
                   const std::vector<Triangle>& triangles);
void check_mesh(std::string_view who, const Mesh& mesh);
void check_count(std::string_view who, std::string_view what, std::size_t found, std::size_t wanted);
void check_held(std::string_view who, const std::vector<std::uint8_t>& held, std::size_t vertices);

// Three vertices a triangle in one list.
std::vector<std::uint32_t> flat(const std::vector<Triangle>& triangles);

// A mesh as files have it, and back. A vertex keeps its number; copies of it, for other uv or normals, come
// after all of them. Without normals of its own it gets those of the smooth surface.
io::MeshFile file_of(const Mesh& mesh);
Mesh mesh_of(const io::MeshFile& file);

// Both throw Error(bad_input) for what does not hold together.
shell::Material to_shell(const Material& material);
io::WrinkleField to_io(const WrinkleField& field, std::string_view who);

}  // namespace plisse::api
