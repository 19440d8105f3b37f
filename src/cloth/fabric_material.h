// A fabric of the one table (sizing/fabric.h) as the material of a shell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shell/material.h"
#include "sizing/fabric.h"

namespace plisse::cloth {

struct FabricMaterial {
  shell::Material material;
  double weight = 0;                 // kg/m²
  std::vector<std::string> assumed;  // values that the fabric lacks and that were assumed, in words
};

// A shell has one E, ν and h: those of the plate whose bending stiffness is the fabric's B and whose membrane
// stiffness Eh is E times its thickness. If it has no thickness, that of B/E is used (Kirchhoff–Love, h =
// (12(1 − ν²)B/E)^⅓) with its E. For different weft and warp the geometric means are used. The weight (kg/m²)
// is 0.15 if neither the fabric nor `weight` gives one. `poisson` takes the place of the fabric's.
FabricMaterial material_of(const sizing::Fabric& fabric, std::optional<double> poisson,
                           std::optional<double> weight);

}  // namespace plisse::cloth
