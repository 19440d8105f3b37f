// The mesh resolution that a fabric needs, from its stiffness alone.
//
// D. Zhang et al., "Physics-inspired Estimation of Optimal Cloth Mesh Resolution", SIGGRAPH 2025 ("the
// paper"), 4.1.
#pragma once

namespace plisse::sizing {

// The softest and the stiffest fabric of a system, and their resolutions. SI units.
struct FabricRange {
  double bending_min = 1e-9, bending_max = 1e-3;           // B, N·m
  double modulus_min = 2e3, modulus_max = 2e6;             // E, N/m²
  double resolution_min = 2.5e-3, resolution_max = 50e-3;  // r, m

  double ratio_min() const { return bending_min / modulus_max; }  // y = B/E, m³
  double ratio_max() const { return bending_max / modulus_min; }
};

// c₁ r⁶ + c₂ r⁴ = y (eq. 4).
struct ResolutionLaw {
  double c1 = 0;  // m⁻³
  double c2 = 0;  // m⁻¹

  // The r of y = B/E, metres: the root on the branch where r grows with y. As y → 0 it tends to √(−c₂/c₁).
  // Throws Error(bad_input) where y is not a positive finite number.
  double resolution(double ratio) const;
};

// The law whose r is resolution_min at ratio_min and resolution_max at ratio_max (the paper's 2 × 2 system).
// Throws Error(bad_input) where a range is empty or not positive, or where r would not grow with y between
// its ends.
ResolutionLaw resolution_law(const FabricRange& range = {});

}  // namespace plisse::sizing
