// Tangents for tangent-space normal maps as MikkTSpace makes them (M. S. Mikkelsen, Simulation of Wrinkled
// Surfaces Revisited, 2008, and the author's mikktspace.c): the basis that glTF prescribes and that Blender
// and most baking programs use. Ours alone where a map is made; who reads it makes the same from the mesh.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace plisse {

// One corner of a triangle: equal numbers of `vertex` are one vertex with one normal and one uv.
struct TangentCorner {
  std::uint32_t vertex = 0;
  glm::dvec3 position{0}, normal{0};  // unit
  glm::dvec2 uv{0};                   // v upward
};

// The bitangent is sign · normal × tangent; all three are interpolated as they are, not made unit again.
struct CornerTangent {
  glm::dvec3 tangent{0};  // unit, at right angles to the normal; 0 where the triangle has no area in uv
  double sign = 1;        // −1 where uv is mirrored
};

// Three corners a triangle in, three tangents out. Triangles that follow each other round a vertex share
// their tangent, weighted by their angles there, but for those that are mirrored against each other.
std::vector<CornerTangent> mikktspace(const std::vector<TangentCorner>& corners);

}  // namespace plisse
