// Stretching energy of a triangle: St. Venant–Kirchhoff (Chen et al. 2021, eq. 2 and 34) and its relaxation
// by tension field theory (appendix B; Pipkin 1986), where compression costs nothing.
//
// Energies are those of eq. 1 without its leading ½ (docs/drape.md): per rest area ψ = h/4 W(λ₁, λ₂), with
// λ₁ ≥ λ₂ the eigenvalues of I − I_u, twice the Green strain.
#pragma once

#include <Eigen/Core>

#include "shell/fundamental_forms.h"
#include "shell/material.h"

namespace plisse::shell {

enum class Stretching { stvk, tension_field };

struct StretchingLaw {
  Material material;
  Stretching model = Stretching::tension_field;
  // η: ψ = (1 − η) ψ_tension_field + η ψ_stvk, so that slack cloth keeps a little of its stiffness. 0 … 1; 0:
  // none. Distributes strain that tension field theory leaves undetermined.
  double residual = 0;
  // Of tension field theory alone: no principal stress is above that of the uniaxial strain λ₁ = limit; 0: no
  // limit. What a rig stretches beyond it is no tension, as if the rest shape had grown by it.
  double tension_limit = 0;
};

// The states of tension field theory: zero, one or two principal stresses.
enum class TensionState { slack, wrinkled, taut };

// The state changes where the stress of the relaxed law is continuous: at λ₁ = 0 and λ₂ = −νλ₁.
TensionState tension_state(const Material& material, double lambda1, double lambda2);

// With a tension limit ℓ, s = Yℓ: ψ = h/4 max {σ₁λ₁ + σ₂λ₂ − (σ₁² + σ₂² − 2νσ₁σ₂)/2Y : 0 ≤ σ₂, σ₁ ≤ s}, the
// relaxed law where σ₁ ≤ s. Beyond: σ₁ = s and σ₂ = min(max(Yλ₂ + νs, 0), s), so that ψ goes on linearly in
// λ₁ (in both at σ₂ = s). A maximum of linear functions of the strain that grow with it, ψ stays convex in
// the positions and has continuous stress; clamping λ₁ would do neither.
//
// The strain that carries this stress: (λ₁, λ₂) less what is beyond the limit.
Eigen::Vector2d elastic_strain(const StretchingLaw& law, double lambda1, double lambda2);

// ψ and its derivatives by the two eigenvalues, J/m².
struct StretchingDensity {
  double value = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();  // of a wrinkled or slack branch: its own one-sided one
  double shear = 0;  // (ψ₁ − ψ₂)/(λ₁ − λ₂), its limit where both are equal
};
StretchingDensity stretching_density(const StretchingLaw& law, double lambda1, double lambda2);

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

// exact: the second derivative. positive: without the negative eigenvalues that compressed triangles have;
// tension field alone has none.
enum class Curvature { exact, positive };

// Energy of a triangle, J; its gradient and Hessian by the corners x₀ y₀ z₀ x₁ … are written where asked for.
// Finite for every finite position, collapsed and inverted triangles included.
double stretching(const StretchingLaw& law, const RestFace& rest, const Corners& corners,
                  Vector9* gradient = nullptr, Matrix9* hessian = nullptr,
                  Curvature curvature = Curvature::exact);

}  // namespace plisse::shell
