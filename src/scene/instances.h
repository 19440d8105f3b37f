// All instances of all meshes of a model, transformed into one space for welding: metres of the world at bind
// time.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "io/model.h"
#include "mesh/surface.h"
#include "mesh/weld.h"
#include "scene/rig.h"

namespace plisse::scene {

// One matrix of Pose::palette: world(node)·right, or the identity where node is −1.
struct PaletteEntry {
  int node = -1;
  glm::dmat4 right{1};
};

// One weight of Pose::morph_weights.
struct MorphSource {
  int node = -1;
  std::size_t target = 0;  // of the node's meshes
  double rest_weight = 0;  // in the rest pose: the default with a skin, else the first frame's
};

// Vertices before welding: in the order of their numbers in the file where those are known (OBJ, PLY,
// panels), else of all instances one after the other.
struct Instances {
  WeldInput vertices;               // in the space of Surface::bind
  std::vector<glm::dvec3> normals;  // unit, in the space of bind; 0 where the file has none
  std::vector<glm::vec2> uvs, normal_uvs;
  std::vector<glm::vec4> colours;
  std::vector<std::uint32_t> cache_index;  // vertex number over all meshes of the model, as in VertexCache
  std::vector<std::uint32_t> triangles;    // in the order for which area normals agree with the file's
  std::vector<Part> parts;
  std::vector<PaletteEntry> palette;
  std::vector<MorphSource> targets;
};

// `times`: the frames of the clip in seconds; the rest position of a rigid instance is that of the first
// frame in which its matrix can be inverted. A vertex cache replaces bones, nodes and targets.
Instances gather_instances(const io::Model& model, const Rig& rig, const std::vector<double>& times);

}  // namespace plisse::scene
