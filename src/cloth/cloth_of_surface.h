// The selected parts of a model as cloth: oriented shells in which every edge has one face or two, whatever
// the model's triangles are like.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/surface.h"
#include "shell/rest_shape.h"

namespace plisse::cloth {

struct Cloth {
  std::vector<std::uint32_t> welded;    // of each vertex of the cloth: the surface's welded vertex
  std::vector<shell::Face> faces;       // of vertices of the cloth
  std::vector<std::uint32_t> triangle;  // of each face: the surface's triangle
  std::vector<bool> turned;             // of each face: its corners 1 and 2 are the triangle's 2 and 1
  std::vector<bool> shared;             // of each vertex: triangles that are not selected have it, too
  std::size_t without_area = 0;         // triangles that are left out
  std::size_t cut = 0;                  // edges at which faces do not fit together, so that sheets are parted

  // Of the cloth's vertices, 3×V, from those of the surface.
  shell::Positions places(const std::vector<glm::dvec3>& of_surface) const;
};

// Sheets go on across an edge to the face with the nearest normal, never to one with the same corners (a
// sheet that is modelled twice, back to back, is two). A vertex at which several sheets meet is one vertex in
// each. Throws Error(bad_input) where no triangle is left.
Cloth cloth_of(const Surface& surface);

}  // namespace plisse::cloth
