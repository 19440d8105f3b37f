// Geometry out: one moment of a surface as PLY, OBJ or GLB, for other programs to open.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace plisse::io {

// Positions, normals and texture coordinates with separate indices, as in OBJ. Metres, y up, right-handed;
// v upward.
struct MeshFile {
  struct Vertex {
    std::uint32_t position = 0, normal = 0;
    glm::vec2 uv{0};
    glm::vec4 colour{1};  // linear
  };
  // A run of triangles with one material.
  struct Part {
    std::string mesh, material;
    glm::vec4 base_colour{1};  // linear
    bool two_sided = true, has_uv = false, has_colours = false;
    std::uint32_t first_triangle = 0, triangle_count = 0;
  };
  std::vector<glm::dvec3> positions;
  std::vector<glm::dvec3> normals;  // unit
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> triangles;  // three vertices each
  std::vector<Part> parts;
};

// By the name's ending: .obj (v, vt, vn, g, usemtl; a v for each position, in order), .ply (binary; a vertex
// for each vertex, with nx ny nz and, where there is uv, s t), .glb (a mesh whose primitives are the parts;
// vertex colours too; v counts downward there). Whole or not at all. Throws Error(no_output) where it cannot
// be written or something is not finite, Error(bad_input) for another ending.
void write_mesh(const std::filesystem::path& path, const MeshFile& mesh);

}  // namespace plisse::io
