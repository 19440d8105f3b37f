#include "config/fabric.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "config/suggest.h"

namespace plisse::config {
namespace {

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// A positive number, or an error that says which part of the text will not do.
template <typename Parse>
double positive(const std::string& part, const char* what, std::string_view allowed, const Parse& parse) {
  const std::optional<double> value = parse(part);
  if (value && *value > 0 && std::isfinite(*value)) return *value;
  throw Error(ExitCode::bad_input,
              fmt::format("'{}' is no {}; allowed: a number above 0, alone or with {}", part, what, allowed));
}

sizing::Stiffness stiffness(const std::string& bending, const std::string& modulus) {
  return {positive(bending, "bending stiffness", sizing::bending_units, sizing::parse_bending),
          positive(modulus, "Young's modulus", sizing::modulus_units, sizing::parse_modulus)};
}

}  // namespace

sizing::Fabric parse_fabric(const std::string& text) {
  if (const sizing::Fabric* known = sizing::find_fabric(text)) return *known;
  const auto parts = parts_of(text);
  if (parts.size() != 2 && parts.size() != 4) {
    std::vector<std::string> names;
    for (const sizing::Fabric& fabric : sizing::fabrics()) names.push_back(fabric.name);
    throw Error(
        ExitCode::bad_input,
        fmt::format(
            "'{}' is unknown: neither B,E (bending stiffness and Young's modulus; four numbers for weft and "
            "warp) nor a fabric{}; 'plisse size --list-fabrics' tells their names",
            text, did_you_mean(text, names)));
  }
  sizing::Fabric fabric{"", "numbers", {}, {}, 0.3, {}, {}};
  fabric.weft = stiffness(parts[0], parts[1]);
  fabric.warp = parts.size() == 2 ? fabric.weft : stiffness(parts[2], parts[3]);
  return fabric;
}

sizing::FabricRange parse_fabric_range(const std::string& text) {
  const auto parts = parts_of(text);
  if (parts.size() != 6)
    throw Error(ExitCode::bad_input,
                fmt::format("'{}' has {} parts; give Bmin,Bmax,Emin,Emax,rmin,rmax", text, parts.size()));
  const auto length = [&](std::size_t i) { return positive(parts[i], "length", length_units, parse_length); };
  const sizing::Stiffness low = stiffness(parts[0], parts[2]), high = stiffness(parts[1], parts[3]);
  return {low.bending, high.bending, low.modulus, high.modulus, length(4), length(5)};
}

}  // namespace plisse::config
