// The surface that the passes work on: all instances of all meshes of a model, welded for skin, crush and
// relax, and split again at seams for render (Loviscach 2006, section 3 and fig. 3).
//
// Units: metres of the world, y up. "Rest" is the pose in which wrinkles are zero and wavelengths are
// measured.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace plisse {

// Compressed rows: the entries of row v are items[offsets[v] … offsets[v+1]).
template <typename Item>
struct Rows {
  std::vector<std::uint32_t> offsets{0};
  std::vector<Item> items;
};

// The two other corners of a triangle that has this vertex, in the triangle's own order: (v, second, third).
struct Corner {
  std::uint32_t second = 0;
  std::uint32_t third = 0;
};

struct PaletteInfluences {
  std::array<std::uint32_t, 8> entry{};  // index into Pose::palette
  std::array<float, 8> weight{};         // sum 1, strongest first
};

struct RenderVertex {
  std::uint32_t welded = 0;
  glm::vec2 uv{0};            // v upward
  glm::vec3 normal{0, 1, 0};  // unit, in the rest pose
  glm::vec2 normal_uv{0};     // of the normal map; v upward
  glm::vec4 colour{1};        // linear, multiplies the material's
};

// A run of triangles that came from one mesh instance: the unit of selection and of material.
struct Part {
  std::string mesh;  // names for --only and --exclude
  std::string material_name;
  int material = -1;  // index into io::Model::materials, −1 none
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  bool wrinkles = true;  // false: selected out, its vertices have mask 0
  bool has_uv = false;
  bool has_colours = false;
};

struct Surface {
  // --- welded vertices, V of them -------------------------------------------------------------------------
  std::vector<glm::dvec3> bind;         // what skin moves: Σ α M_k bind (plus morph deltas before)
  std::vector<glm::dvec3> bind_normal;  // unit; only a fallback where triangles give none
  std::vector<glm::dvec3> rest;         // what crush compares with; equals bind unless --rest says otherwise
  std::vector<PaletteInfluences> influences;
  std::size_t target_count = 0;
  std::vector<glm::vec3> target_deltas;  // [target·V + v], metres in the space of bind
  Rows<std::uint32_t> neighbours;        // over triangle edges, ascending ids, symmetric, no loops
  Rows<Corner> corners;                  // triangles around a vertex, ascending triangle id

  // --- render vertices and triangles ----------------------------------------------------------------------
  std::vector<RenderVertex> render_vertices;
  std::vector<std::uint32_t> triangles;  // three render vertex ids each
  std::vector<Part> parts;

  std::size_t vertex_count() const { return rest.size(); }
  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// Neighbours and corners from welded triangles (three ids each, degenerate ones skipped).
void build_adjacency(Surface& surface);

// The tangent frames of the rest pose and what crush precomputes from them (wrinkle-passes, "Crush").
struct RestFrames {
  std::vector<glm::dvec3> normal, tangent;  // unit, orthogonal; b = n × t
  std::vector<std::uint32_t>
      tangent_neighbour;         // the neighbour t points to (its id), the vertex itself if none
  std::vector<glm::dvec2> edge;  // v_i per entry of surface.neighbours, in (t, b), metres
};
RestFrames rest_frames(const Surface& surface);

}  // namespace plisse
