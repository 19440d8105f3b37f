// Fabrics by name, and their units of measurement. All commands share this table.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sizing/rules.h"

namespace plisse::sizing {

struct Fabric {
  std::string name;    // as written in files: "wine-style"
  std::string source;  // the source of the numbers
  Stiffness weft;      // across the grain: a panel's x at grain 90°
  Stiffness warp;      // along the grain
  double poisson_ratio = 0.3;
  std::optional<double> thickness;  // m
  std::optional<double> density;    // kg/m²

  bool isotropic() const { return weft == warp; }
};

// The known fabrics, all from printed tables, with their sources.
const std::vector<Fabric>& fabrics();
const Fabric* find_fabric(std::string_view name);

// "2e-6", "2e-6 N·m", "0.05 gf·cm²/cm", "0.05 gf cm^2/cm", "20 µN·m", "20 mg·cm" … → N·m. Empty: not such a
// text.
std::optional<double> parse_bending(std::string_view text);
// "3e5", "3e5 Pa", "0.3 MPa", "300 kPa", "3e5 N/m²", "3 gf/mm²" … → N/m². Empty: not such a text.
std::optional<double> parse_modulus(std::string_view text);
// "0.12", "0.12 kg/m²", "120 g/m²", "3.5 oz/yd²" → kg/m². Empty: not such a text.
std::optional<double> parse_density(std::string_view text);
inline constexpr std::string_view bending_units = "N·m, mN·m, µN·m, gf·cm²/cm or mg·cm";
inline constexpr std::string_view modulus_units = "N/m², Pa, kPa, MPa, GPa, N/mm² or gf/mm²";
inline constexpr std::string_view density_units = "kg/m², g/m² or oz/yd²";

}  // namespace plisse::sizing
