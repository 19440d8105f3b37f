// Garments of sewn panels as shells: the rest shape in flat panels, the base surface sewn.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/drape_mesh.h"
#include "sizing/garment.h"

namespace plisse::cloth {

struct SewnGarment {
  FlatMesh rest;                       // panels in their own coordinates, z = 0, one after the other
  std::vector<std::size_t> panel;      // of each rest vertex
  std::vector<std::uint32_t> base_of;  // of each rest vertex
  std::uint32_t count = 0;             // of base vertices
  std::vector<shell::Face> faces;      // of the base; face i is rest face i

  // Base positions from those of the rest vertices: the mean where they are sewn.
  shell::Positions sewn(const shell::Positions& rest_placed) const;
};

// As finely as its fabrics need. Throws as sizing::mesh_garment.
SewnGarment sew_garment(const sizing::Garment& garment, const sizing::SizingOptions& options);

// The same with about this many vertices. Throws Error(bad_input) where panels have holes or features.
SewnGarment sew_garment(const sizing::Garment& garment, int vertices, std::uint32_t seed);

// Initial positions of panels: each is bent around a vertical cylinder of this radius, with x along the
// circumference and x = 0 in front (+z) of the axis, or left flat (0); then rotated and moved to its
// placement.
shell::Positions placed(const SewnGarment& sewn, const sizing::Garment& garment, double wrap);

}  // namespace plisse::cloth
