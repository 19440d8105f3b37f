#include "shell/stretching.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace plisse::shell {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

StretchingDensity stvk_density(const Material& m, double l1, double l2) {
  const double a = m.alpha(), b = m.beta(), quarter = m.thickness / 4;
  StretchingDensity d;
  d.value = quarter * (a / 2 * (l1 + l2) * (l1 + l2) + b * (l1 * l1 + l2 * l2));
  d.first = quarter * Vector2d(a * (l1 + l2) + 2 * b * l1, a * (l1 + l2) + 2 * b * l2);
  d.second << a + 2 * b, a, a, a + 2 * b;
  d.second *= quarter;
  d.shear = quarter * 2 * b;
  return d;
}

// Where the larger stress is at the limit s, N/m².
StretchingDensity limited_density(const Material& m, double s, double l1, double l2) {
  const double quarter = m.thickness / 4, free = m.young * l2 + m.poisson * s;
  const double other = std::clamp(free, 0.0, s);
  StretchingDensity d;
  d.value =
      quarter * (s * l1 + other * l2 - (s * s + other * other - 2 * m.poisson * s * other) / (2 * m.young));
  d.first = quarter * Vector2d(s, other);
  if (other == free) d.second(1, 1) = quarter * m.young;
  if (other < s && l1 > l2) d.shear = (d.first[0] - d.first[1]) / (l1 - l2);  // σ₁ > σ₂ only where λ₁ > λ₂
  return d;
}

StretchingDensity relaxed_density(const Material& m, double l1, double l2) {
  switch (tension_state(m, l1, l2)) {
    case TensionState::slack:
      return {};
    case TensionState::taut:
      return stvk_density(m, l1, l2);
    case TensionState::wrinkled:
      break;
  }
  // W(λ₁, −νλ₁) = ½ Y λ₁².
  const double quarter = m.thickness / 4;
  StretchingDensity d;
  d.value = quarter * 0.5 * m.young * l1 * l1;
  d.first[0] = quarter * m.young * l1;
  d.second(0, 0) = quarter * m.young;
  d.shear = d.first[0] / (l1 - l2);  // λ₁ − λ₂ > (1 + ν)λ₁ > 0 here
  return d;
}

StretchingDensity tension_field_density(const StretchingLaw& law, double l1, double l2) {
  const Material& m = law.material;
  const StretchingDensity free = relaxed_density(m, l1, l2);
  const double s = m.young * law.tension_limit;
  return s > 0 && free.first[0] > m.thickness / 4 * s ? limited_density(m, s, l1, l2) : free;
}

}  // namespace

TensionState tension_state(const Material& material, double lambda1, double lambda2) {
  if (lambda1 <= 0) return TensionState::slack;
  return lambda2 < -material.poisson * lambda1 ? TensionState::wrinkled : TensionState::taut;
}

Vector2d elastic_strain(const StretchingLaw& law, double lambda1, double lambda2) {
  const Material& m = law.material;
  const Vector2d stress = stretching_density(law, lambda1, lambda2).first * 4 / m.thickness;
  const double s = m.young * law.tension_limit;
  Vector2d strain(lambda1, lambda2);
  if (!(s > 0) || stress[0] < s * (1 - 1e-12)) return strain;
  strain[0] = (stress[0] - m.poisson * stress[1]) / m.young;
  if (stress[1] >= s * (1 - 1e-12)) strain[1] = (stress[1] - m.poisson * stress[0]) / m.young;
  return strain;
}

StretchingDensity stretching_density(const StretchingLaw& law, double lambda1, double lambda2) {
  if (law.model == Stretching::stvk) return stvk_density(law.material, lambda1, lambda2);
  StretchingDensity density = tension_field_density(law, lambda1, lambda2);
  if (law.residual > 0) {
    const StretchingDensity full = stvk_density(law.material, lambda1, lambda2);
    const double kept = 1 - law.residual;
    density.value = kept * density.value + law.residual * full.value;
    density.first = kept * density.first + law.residual * full.first;
    density.second = kept * density.second + law.residual * full.second;
    density.shear = kept * density.shear + law.residual * full.shear;
  }
  return density;
}

double stretching(const StretchingLaw& law, const RestFace& rest, const Corners& corners, Vector9* gradient,
                  Matrix9* hessian, Curvature curvature) {
  const Eigen::Matrix<double, 3, 2> dr = deformation_gradient(rest, corners);
  const Principal strain = principal(dr.transpose() * dr - Matrix2d::Identity());
  const StretchingDensity density = stretching_density(law, strain.value[0], strain.value[1]);
  if (!gradient && !hessian) return rest.area * density.value;

  // In the principal directions v₁, v₂ the unknowns are the columns f_i = dr v_i, and C_ij = f_i·f_j:
  // dψ = Σ ψ_i dC_ii,  d²ψ = 2 Σ ψ_i |df_i|² + Σ ψ_ij dC_ii dC_jj + 2 shear dC₁₂².
  const Eigen::Matrix<double, 3, 2> f = dr * strain.direction;
  const Eigen::Matrix<double, 2, 3> weight = strain.direction.transpose() * rest.gradients;  // f_i by corner
  if (gradient) {
    Eigen::Matrix<double, 3, 2> stress;
    for (int i = 0; i < 2; ++i) stress.col(i) = 2 * rest.area * density.first[i] * f.col(i);
    Eigen::Map<Matrix3d>(gradient->data()) = stress * weight;
  }
  if (hessian) {
    Vector6 first = Vector6::Zero(), second = Vector6::Zero(), shear;
    first.head<3>() = 2 * f.col(0);
    second.tail<3>() = 2 * f.col(1);
    shear << f.col(1), f.col(0);
    const Matrix2d& p = density.second;
    Matrix6 h = p(0, 0) * first * first.transpose() + p(1, 1) * second * second.transpose() +
                p(0, 1) * (first * second.transpose() + second * first.transpose()) +
                2 * density.shear * shear * shear.transpose();
    for (int i = 0; i < 2; ++i) h.diagonal().segment<3>(3 * i).array() += 2 * density.first[i];
    if (curvature == Curvature::positive && density.first.minCoeff() < 0) {
      const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(h);
      h = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
          eigen.eigenvectors().transpose();
    }
    Eigen::Matrix<double, 6, 9> jacobian = Eigen::Matrix<double, 6, 9>::Zero();  // of (f₁, f₂) by the corners
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 3; ++k) jacobian.block<3, 3>(3 * i, 3 * k).diagonal().setConstant(weight(i, k));
    *hessian = rest.area * jacobian.transpose() * h * jacobian;
  }
  return rest.area * density.value;
}

}  // namespace plisse::shell
