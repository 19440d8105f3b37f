#include "cloth/fabric_material.h"

#include <fmt/format.h>

#include <cmath>

#include "sizing/rules.h"

namespace plisse::cloth {
namespace {

constexpr double usual_weight =
    0.15;  // kg/m²: of plain woven cotton, between a blouse's 100 g and jeans' 300

}  // namespace

FabricMaterial material_of(const sizing::Fabric& fabric, std::optional<double> poisson,
                           std::optional<double> weight) {
  FabricMaterial result;
  sizing::Stiffness stiffness = fabric.weft;
  if (!fabric.isotropic()) {
    stiffness = {std::sqrt(fabric.weft.bending * fabric.warp.bending),
                 std::sqrt(fabric.weft.modulus * fabric.warp.modulus)};
    result.assumed.push_back(fmt::format(
        "one stiffness both ways, the geometric mean of weft and warp: B = {:.4g} N·m, E = {:.4g} "
        "N/m²",
        stiffness.bending, stiffness.modulus));
  }
  shell::Material& material = result.material;
  material.poisson = poisson.value_or(fabric.poisson_ratio);
  material.young = stiffness.modulus;
  material.thickness = sizing::effective_thickness(stiffness, material.poisson);
  if (fabric.thickness) {
    const double membrane = stiffness.modulus * *fabric.thickness;
    material.thickness =
        std::sqrt(12 * (1 - material.poisson * material.poisson) * stiffness.bending / membrane);
    material.young = membrane / material.thickness;
  } else {
    result.assumed.push_back(fmt::format("the thickness of B/E, {:.3g} mm", 1e3 * material.thickness));
  }
  if (weight || fabric.density) {
    result.weight = weight ? *weight : *fabric.density;
  } else {
    result.weight = usual_weight;
    result.assumed.push_back(fmt::format("{:g} g/m²", 1e3 * usual_weight));
  }
  material.density = result.weight / material.thickness;
  return result;
}

}  // namespace plisse::cloth
