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
  std::vector<std::string> assumed;  // what the fabric does not tell and was taken instead, in words
};

// A shell has one E, ν and h: those of the plate whose bending stiffness is the fabric's B and whose membrane
// stiffness Eh is E times the thickness it tells. Where it tells none, thickness is that of B/E
// (Kirchhoff–Love, h = (12(1 − ν²)B/E)^⅓) and E stays what it is. Weft and warp that differ are taken by
// their geometric means. A weight (kg/m²) that neither the fabric nor `weight` tells is 0.15.
// `poisson` takes the place of the fabric's.
FabricMaterial material_of(const sizing::Fabric& fabric, std::optional<double> poisson,
                           std::optional<double> weight);

}  // namespace plisse::cloth
