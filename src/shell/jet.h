// Numbers that carry first, and if asked second, derivatives by N variables: forward differentiation of short
// formulas whose Hessians by hand would be pages.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace plisse::shell {

// Order 1: `second` is empty and costs nothing.
template <int N, int Order>
struct Jet {
  static constexpr int rows = Order == 2 ? N : 0;
  double value = 0;
  Eigen::Matrix<double, N, 1> first = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, rows, rows> second = Eigen::Matrix<double, rows, rows>::Zero();

  static Jet variable(double value, int index) {
    Jet jet;
    jet.value = value;
    jet.first[index] = 1;
    return jet;
  }
  // f(this), from f and its first two derivatives there.
  Jet through(double f, double df, double ddf) const {
    Jet result;
    result.value = f;
    result.first = df * first;
    if constexpr (Order == 2) result.second = df * second + (ddf * first) * first.transpose();
    return result;
  }
};

template <int N, int Order>
Jet<N, Order> operator+(const Jet<N, Order>& a, const Jet<N, Order>& b) {
  Jet<N, Order> sum;
  sum.value = a.value + b.value;
  sum.first = a.first + b.first;
  sum.second = a.second + b.second;
  return sum;
}

template <int N, int Order>
Jet<N, Order> operator-(const Jet<N, Order>& a, const Jet<N, Order>& b) {
  Jet<N, Order> difference;
  difference.value = a.value - b.value;
  difference.first = a.first - b.first;
  difference.second = a.second - b.second;
  return difference;
}

template <int N, int Order>
Jet<N, Order> operator*(const Jet<N, Order>& a, const Jet<N, Order>& b) {
  Jet<N, Order> product;
  product.value = a.value * b.value;
  product.first = a.value * b.first + b.value * a.first;
  if constexpr (Order == 2) {
    product.second = a.value * b.second + b.value * a.second;
    product.second += a.first * b.first.transpose();
    product.second += b.first * a.first.transpose();
  }
  return product;
}

template <int N, int Order>
Jet<N, Order> sqrt(const Jet<N, Order>& a) {
  const double root = std::sqrt(a.value);
  return a.through(root, 0.5 / root, -0.25 / (a.value * root));
}

template <int N, int Order>
Jet<N, Order> reciprocal(const Jet<N, Order>& a) {
  const double inverse = 1 / a.value;
  return a.through(inverse, -inverse * inverse, 2 * inverse * inverse * inverse);
}

}  // namespace plisse::shell
