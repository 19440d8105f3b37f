// The result of a reader: one model file (or a numbered sequence) as plain data, before welding and posing.
// Every reader fills only this, and `validate` checks it afterwards.
//
// Units: the world that nodes place meshes in is metres, y up, right-handed: readers put the file's unit and
// up axis into a node above its roots (or into the positions, where the file has no nodes). A mesh's own
// coordinates are the file's. Times are seconds from the clip's start. Colours are linear unless said
// otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

#include "io/vertex_cache.h"

namespace plisse::io {

// 8 bits a channel, sRGB colour, straight alpha, rows from top to bottom; rgba.size() == 4·width·height.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
};

struct Texture {
  enum class Use { colour, normals };  // normals: a tangent-space normal map, its channels linear
  std::string name;                    // the file's path, or "embedded 0"
  Image image;
  Use use = Use::colour;
};

struct Material {
  enum class Alpha { opaque, mask, blend };
  std::string name;
  glm::vec4 base_colour{1.0F};   // linear, multiplies the texture
  int base_colour_texture = -1;  // index into Model::textures, −1 none
  int normal_texture = -1;       // likewise; x to the right, y up the picture, z outward
  float normal_scale = 1;        // multiplies the normal map's x and y
  Alpha alpha = Alpha::opaque;
  float alpha_cutoff = 0.5F;
  bool two_sided = true;
};

inline constexpr int max_influences = 8;

// The strongest eight, weights summing to 1, strongest first; unused slots have weight 0.
struct Influences {
  std::array<std::uint32_t, max_influences> bone{};  // index into Mesh::bones
  std::array<float, max_influences> weight{};
};

struct Bone {
  int node = -1;         // index into Model::nodes
  glm::dmat4 offset{1};  // mesh space → the bone's space at bind time (inverse bind matrix)
};

struct MorphTarget {
  std::string name;
  std::vector<glm::vec3> position_deltas;  // one per vertex, mesh space
};

// Vertices as the file has them: split wherever normal or uv has a seam. Triangles only.
struct Mesh {
  std::string name;
  int material = -1;
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec3> normals;        // unit, or empty
  bool flat = false;                     // without normals: each triangle has its own, not the surface's
  std::vector<glm::vec2> uvs;            // v grows upward as in OpenGL (texture row 0 is at v = 1), or empty
  std::vector<glm::vec2> normal_uvs;     // the normal map's, where they are not `uvs`; or empty
  std::vector<glm::vec4> colours;        // linear, multiply the base colour; or empty
  std::vector<std::uint32_t> triangles;  // three indices each
  std::vector<Bone> bones;               // empty: rigid, moves with its node
  std::vector<Influences> influences;    // one per vertex where bones is not empty
  std::vector<MorphTarget> targets;
  int file_max_influences = 0;  // as found, before keeping eight
  // The number that each vertex has in the file (OBJ, PLY), which point caches and sequences count by; empty
  // where the reader does not know it.
  std::vector<std::uint32_t> file_vertices;
};

struct Node {
  std::string name;
  int parent = -1;          // always smaller than the node's own index
  glm::dmat4 local{1};      // to the parent; the pose where no clip moves it
  std::vector<int> meshes;  // indices into Model::meshes; a mesh under two nodes is an instance each
  std::vector<double> morph_weights;  // of the mesh's targets where no clip moves them
};

enum class Interpolation { linear, step, cubic_spline };

template <typename Value>
struct Keys {
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;                     // seconds, strictly increasing
  std::vector<Value> values;                     // one per time
  std::vector<Value> in_tangents, out_tangents;  // cubic_spline only, per second
};

// One node's motion; an empty track keeps that part of the node's own `local` matrix.
struct Channel {
  int node = -1;
  Keys<glm::dvec3> translation;
  Keys<glm::dquat> rotation;
  Keys<glm::dvec3> scale;
  Keys<std::vector<double>> morph_weights;
};

struct Clip {
  std::string name;
  double duration = 0;  // seconds
  std::vector<Channel> channels;
};

struct Camera {
  std::string name;
  int node = -1;
  double vertical_field_of_view = 0.8;  // radians
  double half_height = 0;  // > 0: parallel projection, half the picture's height in the node's unit
};

struct Model {
  std::filesystem::path path;
  double metres_per_unit = 1;           // as applied: the file's, or the option's
  std::string up = "y";                 // likewise
  std::uint64_t file_vertex_count = 0;  // of Mesh::file_vertices; 0 where they are not known
  std::vector<Node> nodes;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Clip> clips;
  std::vector<Camera> cameras;
  VertexCache cache;  // takes the place of bones, nodes and targets; empty where there is none
};

}  // namespace plisse::io
