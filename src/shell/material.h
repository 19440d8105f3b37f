// An isotropic St. Venant–Kirchhoff sheet (Chen et al. 2021, eq. 4 and 33).
#pragma once

namespace plisse::shell {

struct Material {
  double young = 1e6;       // Y, Pa
  double poisson = 0.3;     // ν, 0 … 0.5
  double thickness = 1e-3;  // h, m
  double density = 0;       // kg/m³ of the rest volume

  // The Lamé parameters of plane stress, Pa: ‖M‖²_SV = α/2 tr²M + β tr M².
  double alpha() const { return young * poisson / (1 - poisson * poisson); }
  double beta() const { return young / (2 * (1 + poisson)); }
  // B = Y h³ / 12(1 − ν²), N·m: the bending stiffness per metre of width.
  double bending_stiffness() const {
    return young * thickness * thickness * thickness / (12 * (1 - poisson * poisson));
  }
};

// Throws Error(bad_input) with the allowed range where a value is out of range or not finite.
void check(const Material& material);

}  // namespace plisse::shell
