// Curves of pattern pieces from Wavefront OBJ files, which CAD and modelling programs can write.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "sizing/polyline.h"

namespace plisse::sizing {

// The line elements (`l`) of the group or object `name` (of the whole file where that is empty) as chains,
// closed where they return to their start; where it has none, the boundary of its faces. Longest first, at
// least one. In a plane of constant z, y or x the coordinates are (x, y), (x, −z) or (−z, y): the views from
// the front, from above and from the right. Throws Error(bad_input) with the file, and the line where there
// is one: text that is no OBJ, a missing group, lines that branch, curves in no such plane.
std::vector<Polyline> read_obj_lines(const std::filesystem::path& path, std::string_view name);

// The same of closed chains, the one that all the others lie in first. Throws Error(bad_input) as well where
// there is none such, or a chain is open.
std::vector<Polyline> read_obj_outline(const std::filesystem::path& path, std::string_view name);

}  // namespace plisse::sizing
