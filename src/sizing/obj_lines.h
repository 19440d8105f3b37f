// Curves of pattern pieces from Wavefront OBJ files: what CAD and modelling programs can all write.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "sizing/polyline.h"

namespace plisse::sizing {

// The line elements (`l`) of the group or object `name` (of the whole file where that is empty) as chains,
// closed where they return to their start; where it has none, the boundary of its faces. Longest first, at
// least one. Of what lies in a plane of constant z, y or x the other two coordinates are taken: (x, y), (x,
// −z) or (−z, y), as it looks from front, above and the right. Throws Error(bad_input) with the file, and the
// line where there is one: what is no OBJ, a group that is not there, lines that branch, what lies in no such
// plane.
std::vector<Polyline> read_obj_lines(const std::filesystem::path& path, std::string_view name);

// The same of closed chains, the one that all the others lie in first. Throws Error(bad_input) as well where
// there is none such, or a chain is open.
std::vector<Polyline> read_obj_outline(const std::filesystem::path& path, std::string_view name);

}  // namespace plisse::sizing
