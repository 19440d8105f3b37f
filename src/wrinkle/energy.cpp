// Equations (20)–(26) with the corrections of docs/wrinkle.md, each face a polynomial of degree eight.
#include "wrinkle/energy.h"

#include <algorithm>
#include <cmath>

#include "shell/stretching.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Complete homogeneous symmetric polynomials h_n: with them ∫a² = area·h₂/6 and ∫a⁴ = area·h₄/15, and the
// derivative of h_n by one of its variables is h_{n−1} with that variable twice.
double h2(double sum1, double sum2) {
  return (sum1 * sum1 + sum2) / 2;
}
double h3(double sum1, double sum2, double sum3) {
  return (sum1 * sum1 * sum1 + 3 * sum1 * sum2 + 2 * sum3) / 6;
}
double h4(double sum1, double sum2, double sum3, double sum4) {
  return (sum1 * sum1 * sum1 * sum1 + 6 * sum1 * sum1 * sum2 + 3 * sum2 * sum2 + 8 * sum1 * sum3 + 6 * sum4) /
         24;
}

// Means of a² and a⁴ over a triangle, with derivatives by the corner values where they are asked for.
struct Means {
  Vector3d a;
  double s1, s2, s3;  // sums of powers
  double second, fourth;

  explicit Means(const Vector3d& corners)
      : a(corners), s1(a.sum()), s2(a.squaredNorm()), s3(a.array().cube().sum()) {
    const double s4 = a.array().square().square().sum();
    second = h2(s1, s2) / 6;
    fourth = h4(s1, s2, s3, s4) / 15;
  }
  Vector3d second_gradient() const { return (a.array() + s1) / 6; }
  static Matrix3d second_hessian() { return (Matrix3d::Constant(1) + Matrix3d::Identity()) / 6; }
  Vector3d fourth_gradient() const {
    Vector3d gradient;
    for (int i = 0; i < 3; ++i) gradient[i] = h3(s1 + a[i], s2 + a[i] * a[i], s3 + a[i] * a[i] * a[i]) / 15;
    return gradient;
  }
  Matrix3d fourth_hessian() const {
    Matrix3d hessian;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j)
        hessian(i, j) = hessian(j, i) =
            (i == j ? 2 : 1) * h2(s1 + a[i] + a[j], s2 + a[i] * a[i] + a[j] * a[j]) / 15;
    return hessian;
  }
};

double squared_norm(const Matrix2d& m, double alpha, double beta) {
  return alpha / 2 * m.trace() * m.trace() + beta * (m * m).trace();
}

}  // namespace

Matrix2d wrinkled_strain(const FaceForms& forms, const Model& model) {
  const PrincipalStrain principal = principal_strain(forms);
  if (model.crest_compression || principal.tension >= 0) return forms.strain;
  return forms.strain - principal.tension * principal.crest * principal.crest.transpose();
}

FaceEnergy::FaceEnergy(const FaceForms& forms, const Model& model) : gradient_(forms.rest.gradients) {
  const double h = model.material.thickness, alpha = model.material.alpha(), beta = model.material.beta();
  const Matrix2d strain = wrinkled_strain(forms, model);
  scale_ = forms.rest.area * h / 4;
  constant_ = squared_norm(strain, alpha, beta);
  stress_ = alpha / 2 * strain.trace() * Matrix2d::Identity() + beta * strain;
  square_ = alpha / 2 + beta;
  const PrincipalStrain principal = principal_strain(forms);
  const double relaxed =
      shell::stretching_density({model.material}, principal.tension, principal.compression).value;
  relaxed_ = forms.rest.area * relaxed;
  constant_ -= 4 / h * relaxed;
  if (!model.v1) {
    curvature_ = 2 * squared_norm(forms.second_form, alpha, beta);
  } else if (principal.compression < 0) {  // otherwise w has no meaning, and a stays near 0 (section 4.2)
    const double bent = principal.crest.dot(forms.second_form * principal.crest);
    curvature_ = model.material.young * bent * bent;
  }
  compression_ =
      std::max(-(principal.compression + model.material.poisson * std::max(principal.tension, 0.0)), 0.0);
  curvature_ *= model.curvature_factor;
  // W³ = shear a² ‖dφᵀda + daᵀdφ‖². Without v₂ the cos 2φ part of the strain, ½(daᵀda − a²dφᵀdφ), stays
  // whole.
  const double cross = model.v2 ? 0.5 : 0.25, shear = model.v2 ? 1.0 / 32 : 1.0 / 8;
  aligned_ = cross * alpha / 2 + 2 * shear * beta;
  crossed_ = cross * beta + 2 * shear * (alpha + beta);
  quartic_a_ = square_ * (1.0 / 4 + 1.0 / 8);
  quartic_ = square_ * (model.v2 ? 1.0 / 4 : 1.0 / 4 + 1.0 / 8);
  bending_ = square_ * h * h / 6;
}

struct FaceEnergy::Terms {
  Vector2d p, g;
  double pp, gg, gp;
  double density;  // what multiplies a²
  double value;
  Means means;
};

FaceEnergy::Terms FaceEnergy::terms(const LocalVector& x) const {
  Terms t{x.tail<2>(), gradient_ * x.head<3>(), 0, 0, 0, 0, 0, Means(x.head<3>())};
  t.pp = t.p.squaredNorm();
  t.gg = t.g.squaredNorm();
  t.gp = t.g.dot(t.p);
  t.density = t.p.dot(stress_ * t.p) + aligned_ * t.gg * t.pp + crossed_ * t.gp * t.gp + curvature_ +
              bending_ * t.pp * t.pp;
  t.value = scale_ * (constant_ + t.g.dot(stress_ * t.g) + quartic_a_ * t.gg * t.gg +
                      t.means.second * t.density + quartic_ * t.means.fourth * t.pp * t.pp);
  return t;
}

double FaceEnergy::value(const LocalVector& x) const {
  return terms(x).value;
}

double FaceEnergy::gradient(const LocalVector& x, LocalVector& first) const {
  const Terms t = terms(x);
  const double m2 = t.means.second, m4 = t.means.fourth;
  const Vector2d density_p =
      2 * (stress_ * t.p) + (2 * aligned_ * t.gg + 4 * bending_ * t.pp) * t.p + 2 * crossed_ * t.gp * t.g;
  const Vector2d by_g = 2 * (stress_ * t.g) + 4 * quartic_a_ * t.gg * t.g +
                        m2 * (2 * aligned_ * t.pp * t.g + 2 * crossed_ * t.gp * t.p);
  first.head<3>() = gradient_.transpose() * by_g + t.density * t.means.second_gradient() +
                    quartic_ * t.pp * t.pp * t.means.fourth_gradient();
  first.tail<2>() = m2 * density_p + 4 * quartic_ * m4 * t.pp * t.p;
  first *= scale_;
  return t.value;
}

double FaceEnergy::hessian(const LocalVector& x, LocalVector& first, LocalMatrix& second) const {
  const Terms t = terms(x);
  const double m2 = t.means.second, m4 = t.means.fourth;
  const Vector3d m2_gradient = t.means.second_gradient(), m4_gradient = t.means.fourth_gradient();
  const Matrix2d id = Matrix2d::Identity(), ppt = t.p * t.p.transpose(), ggt = t.g * t.g.transpose(),
                 gpt = t.g * t.p.transpose();
  const Matrix2d fourth = t.pp * id + 2 * ppt;  // ¼ of the Hessian of |p|⁴
  const Vector2d density_p =
      2 * (stress_ * t.p) + (2 * aligned_ * t.gg + 4 * bending_ * t.pp) * t.p + 2 * crossed_ * t.gp * t.g;
  const Vector2d density_g = 2 * aligned_ * t.pp * t.g + 2 * crossed_ * t.gp * t.p;
  const Vector2d by_g = 2 * (stress_ * t.g) + 4 * quartic_a_ * t.gg * t.g + m2 * density_g;
  first.head<3>() =
      gradient_.transpose() * by_g + t.density * m2_gradient + quartic_ * t.pp * t.pp * m4_gradient;
  first.tail<2>() = m2 * density_p + 4 * quartic_ * m4 * t.pp * t.p;
  first *= scale_;

  const Matrix2d by_pp =
      m2 * (2 * stress_ + 2 * aligned_ * t.gg * id + 2 * crossed_ * ggt + 4 * bending_ * fourth) +
      4 * quartic_ * m4 * fourth;
  const Matrix2d by_gg = 2 * stress_ + 4 * quartic_a_ * (t.gg * id + 2 * ggt) +
                         m2 * (2 * aligned_ * t.pp * id + 2 * crossed_ * ppt);
  const Matrix2d by_gp = m2 * (4 * aligned_ * gpt + 2 * crossed_ * (t.gp * id + gpt.transpose()));
  const Matrix3d mixed = m2_gradient * (density_g.transpose() * gradient_);
  second.topLeftCorner<3, 3>() = gradient_.transpose() * by_gg * gradient_ + mixed + mixed.transpose() +
                                 t.density * Means::second_hessian() +
                                 quartic_ * t.pp * t.pp * t.means.fourth_hessian();
  second.topRightCorner<3, 2>() = gradient_.transpose() * by_gp + m2_gradient * density_p.transpose() +
                                  4 * quartic_ * t.pp * m4_gradient * t.p.transpose();
  second.bottomLeftCorner<2, 3>() = second.topRightCorner<3, 2>().transpose();
  second.bottomRightCorner<2, 2>() = by_pp;
  second *= scale_;
  return t.value;
}

double FaceEnergy::magnitude(const LocalVector& x) const {
  const Terms t = terms(x);
  const double stress = stress_.cwiseAbs().maxCoeff();
  return scale_ *
         (std::abs(constant_) + 2 * stress * (t.gg + t.means.second * t.pp) + quartic_a_ * t.gg * t.gg +
          t.means.second *
              (aligned_ * t.gg * t.pp + crossed_ * t.gp * t.gp + curvature_ + bending_ * t.pp * t.pp) +
          quartic_ * t.means.fourth * t.pp * t.pp);
}

double FaceEnergy::metric_weight(const LocalVector& x, double second_mean) const {
  const double pp = x.tail<2>().squaredNorm(), gg = (gradient_ * x.head<3>()).squaredNorm();
  // The base surface's stress along dφ, what amplitudes take up, and s₀, which they ought to.
  const double along = pp > 0 ? (stress_ * x.tail<2>()).norm() / std::sqrt(pp) : 0;
  return 2 * scale_ * (along + square_ * (second_mean * pp / 2 + gg / 2 + compression_));
}

double FaceEnergy::taken_up(const LocalVector& x) const {
  return metric_weight(x, Means(x.head<3>()).second) * x.tail<2>().squaredNorm();
}

void FaceEnergy::metric(const LocalVector& x, LocalMatrix& metric) const {
  const Means means(x.head<3>());
  const double pp = x.tail<2>().squaredNorm(), weight = metric_weight(x, means.second);
  // Where amplitudes are next to nothing phases still change no faster than their neighbours'.
  constexpr double least = 1e-2;
  const double height = means.second + least * 2 * compression_ / (pp + 1e-6 * gradient_.squaredNorm());
  metric.setZero();
  metric.topLeftCorner<3, 3>() = weight * (pp * Means::second_hessian() + gradient_.transpose() * gradient_);
  metric.bottomRightCorner<2, 2>() = weight * height * Matrix2d::Identity();
}

}  // namespace plisse::wrinkle
