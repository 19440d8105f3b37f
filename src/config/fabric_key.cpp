#include "config/fabric_key.h"

#include <fmt/format.h>

#include <limits>
#include <string>

#include "base/error.h"
#include "config/fabric.h"
#include "config/file_reader.h"

namespace plisse::config {
namespace {

constexpr double least = std::numeric_limits<double>::min();

// What a table says of one direction, or of both.
struct Numbers {
  std::optional<double> bending, modulus;
};
struct FabricNumbers {
  sizing::Fabric fabric;
  Numbers both, weft, warp;
};

template <typename Row>
void add_numbers(Row& row, const KeyExtras& extras) {
  row("B", &Numbers::bending,
      quantity({least, 1e9}, sizing::parse_bending)
          .allowing("above 0, in N·m or with a unit such as gf·cm²/cm"),
      "Bending stiffness.", extras);
  row("E", &Numbers::modulus,
      quantity({least, 1e15}, sizing::parse_modulus).allowing("above 0, in N/m² or with a unit such as MPa"),
      "Young's modulus.", extras);
}

const Keys<Numbers>& direction_keys() {
  static const auto keys = keys_of<Numbers>("weft", [](auto& row) { add_numbers(row, {}); });
  return keys;
}

void read_direction(const std::string& name, Numbers& numbers, const Given& given) {
  if (!given.node.is_table()) throw Problem{"is no table"};
  given.reader->read(direction_keys(), *given.node.as_table(), name, numbers);
}

const Keys<FabricNumbers>& fabric_keys() {
  using F = FabricNumbers;
  static const auto keys = [] {
    Keys<F> all;
    Rows<F, sizing::Fabric> row(all, "fabric", [](F& f) -> sizing::Fabric& { return f.fabric; });
    row("name", &sizing::Fabric::name, text(), "What reports call it.");
    row("poisson", &sizing::Fabric::poisson_ratio, number({0, 0.5}).allowing("0 to 0.5"), "Poisson's ratio.");
    row("thickness", &sizing::Fabric::thickness, length({1e-7, 1e9}).allowing("above 0"), "Thickness.");
    row("density", &sizing::Fabric::density,
        quantity({1e-9, 1e3}, sizing::parse_density)
            .allowing("above 0, in kg/m² or with a unit such as g/m²"),
        "Weight of an area.");
    Rows<F, Numbers> both(all, "fabric", [](F& f) -> Numbers& { return f.both; });
    add_numbers(both, {.of = {"one"}});
    Rows<F> rest(all, "fabric", [](F& f) -> F& { return f; });
    const KeyExtras two{.of = {"two"}, .needed = always};
    rest("weft", "a table with B and E: { B = …, E = … }", "Across the warp.", two,
         [](F& f, const Given& given) { read_direction("weft", f.weft, given); });
    rest("warp", "a table with B and E: { B = …, E = … }", "Along the warp.", two,
         [](F& f, const Given& given) { read_direction("warp", f.warp, given); });
    return all;
  }();
  return keys;
}

// B and E; or E and the fabric's thickness.
sizing::Stiffness stiffness_of(const Numbers& numbers, const toml::node& node, const sizing::Fabric& fabric,
                               FileReader& reader) {
  const toml::table* table = node.as_table();
  if (!table) return {};
  const auto missing = [&](const char* key, const char* allowed) {
    if (!table->contains(key))
      reader.complain(table->source().begin, fmt::format("key '{}': missing; allowed: {}", key, allowed));
  };
  if (!numbers.modulus) missing("E", "Young's modulus in N/m², or with a unit");
  if (!numbers.bending && !fabric.thickness)
    missing("B", "bending stiffness in N·m, or with a unit; or give the fabric's 'thickness'");
  if (!numbers.modulus) return {};
  if (numbers.bending) return {*numbers.bending, *numbers.modulus};
  if (!fabric.thickness) return {};
  return {sizing::bending_stiffness(*numbers.modulus, *fabric.thickness, fabric.poisson_ratio),
          *numbers.modulus};
}

std::optional<sizing::Fabric> read_fabric(const Given& given) {
  if (given.node.is_string()) {
    try {
      return parse_fabric(text_of(given));
    } catch (const Error& error) {
      given.reader->complain(given.node.source().begin, fmt::format("key 'fabric': {}", error.what()));
      return std::nullopt;
    }
  }
  if (!given.node.is_table()) throw Problem{"is no fabric"};
  FileReader& reader = *given.reader;
  const toml::table& table = *given.node.as_table();
  const std::size_t before = reader.complaints();
  FabricNumbers numbers;
  sizing::Fabric& fabric = numbers.fabric;
  fabric.source = "numbers";
  const bool two = table.contains("weft") || table.contains("warp");
  reader.read(fabric_keys(), table, "fabric", numbers, two ? "two" : "one");
  if (two) {
    if (const toml::node* node = table.get("weft"))
      fabric.weft = stiffness_of(numbers.weft, *node, fabric, reader);
    if (const toml::node* node = table.get("warp"))
      fabric.warp = stiffness_of(numbers.warp, *node, fabric, reader);
  } else {
    fabric.weft = fabric.warp = stiffness_of(numbers.both, table, fabric, reader);
  }
  if (reader.complaints() != before) return std::nullopt;
  return fabric;
}

}  // namespace

Kind<std::optional<sizing::Fabric>> fabric() {
  return {"fabric",
          "a fabric by name (plisse size --list-fabrics), \"B,E\", or a table: { B, E }, { thickness, E, "
          "poisson }, { weft = { B, E }, warp = { B, E } }, with density = \"120 g/m²\" where it is known",
          read_fabric};
}

}  // namespace plisse::config
