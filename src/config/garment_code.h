// Sewing patterns of GarmentCode (M. Korosteleva, O. Sorkine-Hornung, GarmentCode: Programming Parametric
// Sewing Patterns, ACM TOG 2023): panels of straight and curved edges, stitches between edges, placements, in
// JSON. What is read: pattern. panels (vertices, edges with endpoints and curvature, translation, rotation),
// pattern.stitches, properties (units_in_meter, curvature_coords). Parameters and constraints are theirs
// alone.
#pragma once

#include <filesystem>
#include <string_view>

#include "sizing/garment.h"

namespace plisse::config {

// All panels have one fabric, which the files do not contain. A stitch joins those ends of its edges that are
// nearer to each other in the placed panels. Throws Error(bad_input) that names the place in the JSON, all
// that is wrong at once.
sizing::Garment parse_garment_code(std::string_view text, const std::filesystem::path& file,
                                   const sizing::Fabric& fabric);

}  // namespace plisse::config
