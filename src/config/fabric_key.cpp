#include "config/fabric_key.h"

#include <fmt/format.h>

#include <limits>
#include <string>

#include "base/error.h"
#include "config/fabric.h"
#include "config/table_reader.h"

namespace plisse::config {
namespace {

// B and E; or E and the fabric's thickness.
bool read_stiffness(TableReader& table, const sizing::Fabric& fabric, sizing::Stiffness& result) {
  constexpr double least = std::numeric_limits<double>::min();
  const bool has_modulus = table.number("E", result.modulus, least, 1e15,
                                        "above 0, in N/m² or with a unit such as MPa", sizing::parse_modulus);
  const bool has_bending =
      table.number("B", result.bending, least, 1e9, "above 0, in N·m or with a unit such as gf·cm²/cm",
                   sizing::parse_bending);
  if (has_modulus && has_bending) return true;
  if (has_modulus && !table.table().contains("B") && fabric.thickness) {
    result.bending = sizing::bending_stiffness(result.modulus, *fabric.thickness, fabric.poisson_ratio);
    return true;
  }
  if (!table.table().contains("E")) table.needed("E", "Young's modulus in N/m², or with a unit");
  if (!table.table().contains("B") && !fabric.thickness)
    table.needed("B", "bending stiffness in N·m, or with a unit; or give the fabric's 'thickness'");
  return false;
}

bool read_direction(TableReader& table, const std::string& key, const sizing::Fabric& fabric,
                    sizing::Stiffness& result) {
  const toml::node* node = table.needed(key, "a table with B and E");
  if (!node) return false;
  if (!node->is_table()) {
    table.complain(*node, key, "is no table; allowed: { B = …, E = … }");
    return false;
  }
  TableReader inner(*node->as_table(), key, table.metres(), table.complaints());
  const bool good = read_stiffness(inner, fabric, result);
  inner.finish();
  return good;
}

}  // namespace

std::optional<sizing::Fabric> read_fabric(const toml::node& node, double metres, Complaints& complaints) {
  const auto complain = [&](const std::string& text) {
    complaints.add(node.source().begin, "key 'fabric': " + text);
    return std::nullopt;
  };
  if (node.is_string()) {
    try {
      return parse_fabric(*node.value<std::string>());
    } catch (const Error& error) {
      return complain(error.what());
    }
  }
  if (!node.is_table()) return complain(fmt::format("is no fabric; allowed: {}", fabric_allowed));
  TableReader table(*node.as_table(), "fabric", metres, complaints);
  sizing::Fabric fabric;
  fabric.source = "numbers";
  table.text("name", fabric.name);
  table.number("poisson", fabric.poisson_ratio, 0, 0.5, "0 to 0.5");
  double value = 0;
  if (table.length("thickness", value, 1e-7, "above 0")) fabric.thickness = value;
  if (table.number("density", value, 1e-9, 1e3, "above 0, in kg/m² or with a unit such as g/m²",
                   sizing::parse_density))
    fabric.density = value;
  bool good = false;
  if (table.table().contains("weft") || table.table().contains("warp")) {
    good = read_direction(table, "weft", fabric, fabric.weft);
    good &= read_direction(table, "warp", fabric, fabric.warp);
  } else {
    good = read_stiffness(table, fabric, fabric.weft);
    fabric.warp = fabric.weft;
  }
  table.finish();
  return good ? std::optional(fabric) : std::nullopt;
}

}  // namespace plisse::config
