// Bending energy of a triangle and its flaps from mid-edge normals (Chen et al. 2021, eq. 3 and appendix A;
// Grinspun 2003): the bending part of the St. Venant–Kirchhoff shell.
#pragma once

#include <Eigen/Core>
#include <array>

#include "shell/fundamental_forms.h"
#include "shell/material.h"
#include "shell/stretching.h"

namespace plisse::shell {

using Vector18 = Eigen::Matrix<double, 18, 1>;
using Matrix18 = Eigen::Matrix<double, 18, 18>;

// h³/12 ‖II − II_u‖²_SV times the rest area, J (eq. 1 without its leading ½). Derivatives are by the corners
// and then the vertices across them; rows of a missing vertex are 0. Where a face has no area or is folded
// flat onto itself, normals do not exist, and that hinge adds nothing. `positive` leaves out the normals' own
// second derivatives (Gauss–Newton).
double bending_midedge(const Material& material, const RestFace& rest, const Eigen::Matrix2d& rest_form,
                       const Corners& corners, const Corners& across, const std::array<bool, 3>& has,
                       Vector18* gradient = nullptr, Matrix18* hessian = nullptr,
                       Curvature curvature = Curvature::exact);

}  // namespace plisse::shell
