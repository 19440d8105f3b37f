// Rounding by L. Babai, On Lovász' lattice reduction and the nearest lattice point problem, 1986, in place of
// the paper's mixed-integer solver.
#include "wrinkle/periods.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double turn = 2 * std::numbers::pi;

// The energy's Hessian by the periods, the other unknowns following: their answers are −`follow` per radian.
struct Reduced {
  MatrixXd metric, follow;
};

Reduced reduced_hessian(const Problem& problem, const VectorXd& x) {
  const Index begin = problem.period_begin(), count = problem.size() - begin;
  Problem::Curvature curvature(problem);
  VectorXd first;
  curvature.at(x, first);
  Eigen::SparseMatrix<double> lower = curvature.exact() + curvature.nearest();
  MatrixXd columns(problem.size(), count);
  for (Index k = 0; k < count; ++k)
    columns.col(k) = lower.selfadjointView<Eigen::Lower>() * VectorXd::Unit(problem.size(), begin + k);
  const MatrixXd own = columns.bottomRows(count);
  // Periods, and amplitudes at their bounds, stay.
  const double mean = lower.diagonal().mean();
  std::vector<bool> held(static_cast<std::size_t>(problem.size()), false);
  for (Index i = 0; i < problem.size(); ++i) {
    held[static_cast<std::size_t>(i)] = i >= begin || (i < problem.amplitude_count() && x[i] <= 0);
    if (held[static_cast<std::size_t>(i)]) columns.row(i).setZero();
  }
  hold(lower, held, mean);
  for (Index i = 0; i < problem.size(); ++i) lower.coeffRef(i, i) += 1e-9 * mean;  // as in solve()
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(lower);
  Reduced reduced;
  reduced.follow = factor.solve(columns);
  reduced.metric = own - columns.transpose() * reduced.follow;
  return reduced;
}

// Integers n near y with (n − y)ᵀ metric (n − y) small.
VectorXd nearest_integers(MatrixXd metric, const VectorXd& y) {
  const Index count = y.size();
  // A period without influence on the energy (all waves along it have amplitude 0) is rounded separately.
  const double size = metric.diagonal().cwiseAbs().maxCoeff();
  metric.diagonal().array() += size > 0 ? 1e-9 * size : 1;
  const Eigen::LLT<MatrixXd> cholesky(metric);
  if (cholesky.info() != Eigen::Success) return y.array().round();
  const MatrixXd upper = cholesky.matrixU();
  VectorXd n = y;
  for (Index k = count - 1; k >= 0; --k) {
    double centre = y[k];
    for (Index j = k + 1; j < count; ++j) centre -= upper(k, j) / upper(k, k) * (n[j] - y[j]);
    n[k] = std::round(centre);
  }
  // Steps of one, as long as they help; each lowers the cost, of which there are finitely many below any.
  for (bool better = true; better;) {
    better = false;
    for (Index k = 0; k < count; ++k) {
      const double slope = metric.row(k).dot(n - y);
      for (const double step : {1.0, -1.0}) {
        if (2 * step * slope + metric(k, k) < -1e-9 * metric(k, k)) {
          n[k] += step;
          better = true;
          break;
        }
      }
    }
  }
  return n;
}

}  // namespace

Waves with_whole_periods(const Problem& problem, const Waves& waves) {
  if (waves.period.size() == 0) return waves;
  VectorXd x = problem.pack(waves);
  const Reduced reduced = reduced_hessian(problem, x);
  const VectorXd whole = turn * nearest_integers(reduced.metric, waves.period / turn);
  x -= reduced.follow * (whole - waves.period);
  x.head(problem.amplitude_count()) = x.head(problem.amplitude_count()).cwiseMax(0);
  x.tail(whole.size()) = whole;
  return problem.unpack(x);
}

double phase_residual(const Problem& problem, const Waves& real, const Waves& whole) {
  double difference = 0, all = 0;
  for (std::size_t f = 0; f < problem.forms().size(); ++f) {
    if (!problem.live()[f]) continue;
    const auto gradient = [&](const Waves& w) {
      return Eigen::Vector2d(problem.forms()[f].rest.gradients *
                             problem.complex().corner_phases(f, w.phase, w.period));
    };
    double a = 0;
    for (const std::uint32_t v : problem.topology().faces[f]) a += real.amplitude[v] / 3;
    const double weight = problem.forms()[f].rest.area * a * a;
    difference += weight * (gradient(whole) - gradient(real)).squaredNorm();
    all += weight * gradient(real).squaredNorm();
  }
  return all > 0 ? std::sqrt(difference / all) : 0;
}

std::vector<std::array<double, 3>> corner_phases(const Problem& problem, const Waves& whole) {
  const PhaseComplex& complex = problem.complex();
  std::vector<std::array<double, 3>> result(problem.forms().size(), {0, 0, 0});
  for (std::size_t f = 0; f < result.size(); ++f) {
    if (!complex.live[f]) continue;
    const Eigen::Vector3d phase = complex.corner_phases(f, whole.phase, whole.period);
    for (std::size_t c = 0; c < 3; ++c)
      result[f][c] = whole.phase[complex.phase_vertex[f][0]] + phase[static_cast<Index>(c)];
  }
  return result;
}

}  // namespace plisse::wrinkle
