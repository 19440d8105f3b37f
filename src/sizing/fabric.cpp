// Units of the garment industry and the table of fabrics.

#include "sizing/fabric.h"

#include <array>
#include <span>

#include "base/units.h"

namespace plisse::sizing {
namespace {

constexpr double gram_force = 9.80665e-3;                                      // N
constexpr double ounce_per_square_yard = 28.349523125e-3 / (0.9144 * 0.9144);  // kg/m²

struct Unit {
  std::string_view name;  // as `plain` leaves it
  double factor;
};

// Normalises the spelling of units: removes dots, stars, carets and spaces, ² becomes 2, ³ becomes 3, µ and μ
// become u.
std::string plain(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> spellings = {{{"·", ""},
                                                                                       {"*", ""},
                                                                                       {"^", ""},
                                                                                       {" ", ""},
                                                                                       {"²", "2"},
                                                                                       {"³", "3"},
                                                                                       {"µ", "u"},
                                                                                       {"μ", "u"},
                                                                                       {"⋅", ""}}};
  std::string result(text);
  for (const auto& [from, to] : spellings) {
    for (std::size_t at = result.find(from); at != std::string::npos; at = result.find(from, at))
      result.replace(at, from.size(), to);
  }
  return result;
}

std::optional<double> parse(std::string_view text, std::span<const Unit> units) {
  if (const auto number = parse_number(text)) return number;
  // The unit begins after the longest prefix of the text that is a number: "2e-6 N·m", "5 gf·cm²/cm".
  for (std::size_t end = text.size(); end-- > 1;) {
    const auto number = parse_number(text.substr(0, end));
    if (!number) continue;
    const std::string unit = plain(text.substr(end));
    for (const Unit& known : units) {
      if (known.name == unit) return *number * known.factor;
    }
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> parse_bending(std::string_view text) {
  // A stiffness per width: N·m²/m = N·m. The KES-F sheet's gf·cm²/cm is a gf·cm, the cantilever's mg·cm a
  // mgf·cm.
  static constexpr std::array<Unit, 8> units = {{{"Nm", 1},
                                                 {"Nm2/m", 1},
                                                 {"mNm", 1e-3},
                                                 {"uNm", 1e-6},
                                                 {"gfcm2/cm", gram_force * 1e-2},
                                                 {"gfcm", gram_force * 1e-2},
                                                 {"mgcm", gram_force * 1e-5},
                                                 {"mgfcm", gram_force * 1e-5}}};
  return parse(text, units);
}

std::optional<double> parse_modulus(std::string_view text) {
  static constexpr std::array<Unit, 8> units = {{{"N/m2", 1},
                                                 {"Pa", 1},
                                                 {"kPa", 1e3},
                                                 {"MPa", 1e6},
                                                 {"GPa", 1e9},
                                                 {"N/mm2", 1e6},
                                                 {"gf/mm2", gram_force * 1e6},
                                                 {"gf/cm2", gram_force * 1e4}}};
  return parse(text, units);
}

std::optional<double> parse_density(std::string_view text) {
  static constexpr std::array<Unit, 4> units = {
      {{"kg/m2", 1}, {"g/m2", 1e-3}, {"gsm", 1e-3}, {"oz/yd2", ounce_per_square_yard}}};
  return parse(text, units);
}

const std::vector<Fabric>& fabrics() {
  static const std::vector<Fabric> all = [] {
    const std::string table = "D. Zhang et al., SIGGRAPH 2025, Table 1";
    const auto isotropic = [&](const char* name, double bending, double modulus) {
      return Fabric{name, table, {bending, modulus}, {bending, modulus}, 0.3, {}, {}};
    };
    std::vector<Fabric> list = {
        isotropic("wine-style", 2e-6, 3e5),      isotropic("pinkish-puff", 2e-6, 8e5),
        isotropic("mint-melody", 7.8e-7, 6.6e4), isotropic("golden-grace", 2e-6, 1.1e5),
        isotropic("blue-ballet", 2.5e-6, 1.1e5), isotropic("dark-blue", 1.6e-4, 1.3e5),
        isotropic("khaki", 2e-5, 5e5),           isotropic("green", 2.6e-6, 2e6),
        isotropic("light-blue", 3.2e-7, 8.2e6),  isotropic("rose", 4e-8, 1.6e7),
    };
    list.push_back(isotropic("cantilever", 2e-6, 1e6));
    list.back().source = "D. Zhang et al., SIGGRAPH 2025, Fig. 18";
    // Weft of pinkish-puff, warp with the bending of dark-blue: the pair for tests of anisotropy.
    list.push_back({"two-way",
                    table + ": weft of pinkish-puff, warp of dark-blue",
                    {2e-6, 8e5},
                    {1.6e-4, 1.3e5},
                    0.3,
                    {},
                    {}});
    return list;
  }();
  return all;
}

const Fabric* find_fabric(std::string_view name) {
  for (const Fabric& fabric : fabrics()) {
    if (fabric.name == name) return &fabric;
  }
  return nullptr;
}

}  // namespace plisse::sizing
