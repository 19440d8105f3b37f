// A cloth's rest shape from its texture coordinates: flat panels, cut apart in uv and sewn in space.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cloth/cloth_of_surface.h"

namespace plisse::cloth {

struct UvRest {
  std::vector<shell::RestFace> faces;  // of the cloth's faces; u and v are the panels' own
  double metres = 1;                   // of a unit of uv
};

// metres: of a unit of uv; none: so that the surface's rest pose has the panels' area. Throws
// Error(bad_input) where parts have no uv, triangles have no area in them, the scale is another one, or
// panels and rest pose are no isometry: their lengths differ by more than a tenth in the median. Warns of
// parts of the cloth where they differ by more than a quarter. `name`: the model's, for messages.
UvRest rest_from_uv(const Surface& surface, const Cloth& cloth, std::optional<double> metres,
                    const std::string& name);

}  // namespace plisse::cloth
