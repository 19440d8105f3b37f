#include "shell/bending_midedge.h"

#include <Eigen/Geometry>

#include "shell/jet.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector3d;

// A hinge by the three vectors from corner i: to the edge's ends p, q, and to d beyond it.
template <int Order>
using Vector = std::array<Jet<9, Order>, 3>;

template <int Order>
Vector<Order> cross(const Vector<Order>& a, const Vector<Order>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <int Order>
Jet<9, Order> dot(const Vector<Order>& a, const Vector<Order>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <int Order>
Vector<Order> minus(const Vector<Order>& a, const Vector<Order>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <int Order>
Vector<Order> unit(const Vector<Order>& a) {
  const Jet<9, Order> inverse = reciprocal(sqrt(dot(a, a)));
  return {a[0] * inverse, a[1] * inverse, a[2] * inverse};
}

// What fundamental_forms.cpp calls a rise, (p − corner i)·n_i, and its derivatives by p, q, d.
struct Rise {
  double value = 0;
  Eigen::Matrix<double, 9, 1> first;
  Eigen::Matrix<double, 9, 9> second;  // where it was asked for
};

template <int Order>
Rise rise_of(const Vector3d& p, const Vector3d& q, const Vector3d& d) {
  Vector<Order> to_p, to_q, to_d;
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    to_p[at] = Jet<9, Order>::variable(p[k], k);
    to_q[at] = Jet<9, Order>::variable(q[k], 3 + k);
    to_d[at] = Jet<9, Order>::variable(d[k], 6 + k);
  }
  const Vector<Order> normal = unit<Order>(cross<Order>(to_p, to_q));
  const Vector<Order> beyond = unit<Order>(cross<Order>(minus<Order>(to_d, to_p), minus<Order>(to_q, to_p)));
  const Vector<Order> sum = {normal[0] + beyond[0], normal[1] + beyond[1], normal[2] + beyond[2]};
  // p is perpendicular to the face's own normal, so of the sum only the other one counts.
  const Jet<9, Order> jet = dot<Order>(to_p, beyond) * reciprocal(sqrt(dot<Order>(sum, sum)));
  Rise rise{jet.value, jet.first, {}};
  if constexpr (Order == 2) rise.second = jet.second;
  return rise;
}

bool usable(const Vector3d& p, const Vector3d& q, const Vector3d& d) {
  const Vector3d one = p.cross(q), two = (d - p).cross(q - p);
  if (!(one.squaredNorm() > 0) || !(two.squaredNorm() > 0)) return false;
  return (one.normalized() + two.normalized()).squaredNorm() > 1e-12;
}

}  // namespace

double bending_midedge(const Material& material, const RestFace& rest, const Matrix2d& rest_form,
                       const Corners& corners, const Corners& across, const std::array<bool, 3>& has,
                       Vector18* gradient, Matrix18* hessian, Curvature curvature) {
  const double thickness = material.thickness;
  const double scale = rest.area * thickness * thickness * thickness / 12;
  const double alpha = material.alpha(), beta = material.beta();

  // II − II_u = −2 Σ rise_i G_i − II_u, G_i = ∇λ_i ∇λ_iᵀ: the energy is quadratic in the rises.
  std::array<Matrix2d, 3> shape;
  std::array<Rise, 3> rise;
  std::array<bool, 3> live{};
  Matrix2d difference = -rest_form;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    shape[at] = -2 * rest.gradients.col(i) * rest.gradients.col(i).transpose();
    if (!has[at]) continue;
    const Vector3d origin = corners.col(i);
    const Vector3d p = corners.col((i + 1) % 3) - origin, q = corners.col((i + 2) % 3) - origin;
    const Vector3d d = across.col(i) - origin;
    live[at] = usable(p, q, d);
    if (!live[at]) continue;
    if (hessian && curvature == Curvature::exact) {
      rise[at] = rise_of<2>(p, q, d);
    } else if (gradient || hessian) {
      rise[at] = rise_of<1>(p, q, d);
    } else {
      const Vector3d beyond = (d - p).cross(q - p).normalized();
      rise[at].value = p.dot(beyond) / (p.cross(q).normalized() + beyond).norm();
    }
    difference += rise[at].value * shape[at];
  }
  const auto product = [&](const Matrix2d& a, const Matrix2d& b) {  // the bilinear form of ‖·‖²_SV
    return alpha / 2 * a.trace() * b.trace() + beta * (a * b).trace();
  };
  if (gradient) gradient->setZero();
  if (hessian) hessian->setZero();
  if (gradient || hessian) {
    std::array<Vector18, 3> slope;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!live[at]) continue;
      // p, q, d are what these have beyond corner i, which they all begin at.
      const std::array<int, 3> moved = {(i + 1) % 3, (i + 2) % 3, 3 + i};
      slope[at].setZero();
      for (int k = 0; k < 3; ++k) {
        const Vector3d part = rise[at].first.segment<3>(3 * k);
        slope[at].segment<3>(3 * moved[static_cast<std::size_t>(k)]) += part;
        slope[at].segment<3>(3 * i) -= part;
      }
      const double force = 2 * scale * product(shape[at], difference);
      if (gradient) *gradient += force * slope[at];
      if (!hessian || curvature != Curvature::exact) continue;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
          const Eigen::Matrix3d part = force * rise[at].second.block<3, 3>(3 * k, 3 * l);
          const int row = 3 * moved[static_cast<std::size_t>(k)],
                    column = 3 * moved[static_cast<std::size_t>(l)];
          hessian->block<3, 3>(row, column) += part;
          hessian->block<3, 3>(3 * i, column) -= part;
          hessian->block<3, 3>(row, 3 * i) -= part;
          hessian->block<3, 3>(3 * i, 3 * i) += part;
        }
    }
    if (hessian)
      for (std::size_t j = 0; j < 3; ++j) {
        if (!live[j]) continue;
        Vector18 sum = Vector18::Zero();
        for (std::size_t i = 0; i < 3; ++i)
          if (live[i]) sum += 2 * scale * product(shape[i], shape[j]) * slope[i];
        hessian->noalias() += sum * slope[j].transpose();
      }
  }
  return scale * product(difference, difference);
}

}  // namespace plisse::shell
