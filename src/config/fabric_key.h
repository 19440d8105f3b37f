// The key 'fabric' of panel files and drape scenes: a text as parse_fabric takes it, or a table of numbers.
#pragma once

#include <optional>

#include "config/complaints.h"
#include "sizing/fabric.h"

namespace plisse::config {

inline constexpr const char* fabric_allowed =
    "a fabric by name (plisse size --list-fabrics), \"B,E\", or a table: { B, E }, { thickness, E, poisson "
    "}, "
    "{ weft = { B, E }, warp = { B, E } }, with density = \"120 g/m²\" where it is known";

// Numbers that are lengths are times `metres`. None where something is wrong, with a complaint.
std::optional<sizing::Fabric> read_fabric(const toml::node& node, double metres, Complaints& complaints);

}  // namespace plisse::config
