#include "wrinkle/closed_form.h"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <utility>

namespace plisse::wrinkle {

using Eigen::Index;
using Eigen::Vector2d;

Waves nearest_closed(const Problem& problem, const std::vector<Vector2d>& gradients,
                     const std::vector<double>& weights, const Eigen::VectorXd* fixed) {
  const PhaseComplex& complex = problem.complex();
  const auto vertices = static_cast<Index>(complex.vertices), periods = static_cast<Index>(complex.periods),
             size = fixed ? vertices : vertices + periods;
  Waves result;
  result.amplitude = Eigen::VectorXd::Zero(static_cast<Index>(problem.pinned().size()));
  result.phase = Eigen::VectorXd::Zero(vertices);
  result.period = fixed ? *fixed : Eigen::VectorXd::Zero(periods);
  if (size == 0) return result;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  double trace = 0;
  for (std::size_t f = 0; f < gradients.size(); ++f) {
    if (!complex.live[f]) continue;
    const auto& hats = problem.forms()[f].rest.gradients;
    Vector2d wanted = gradients[f];
    std::vector<std::pair<Index, Vector2d>> terms;
    for (Index c = 0; c < 3; ++c)
      terms.emplace_back(complex.phase_vertex[f][static_cast<std::size_t>(c)], hats.col(c));
    for (const auto& jump : complex.jumps[f]) {
      const Vector2d along = hats * jump.corners;
      if (fixed)
        wanted -= (*fixed)[jump.period] * along;
      else
        terms.emplace_back(vertices + static_cast<Index>(jump.period), along);
    }
    for (const auto& [i, x] : terms) {
      right[i] += weights[f] * x.dot(wanted);
      for (const auto& [j, y] : terms) entries.emplace_back(i, j, weights[f] * x.dot(y));
      trace += weights[f] * x.squaredNorm();
    }
  }
  for (Index i = 0; i < size; ++i)
    entries.emplace_back(i, i, trace > 0 ? 1e-12 * trace / static_cast<double>(size) : 1);
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solution = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  result.phase = solution.head(vertices);
  if (!fixed) result.period = solution.tail(periods);
  return result;
}

}  // namespace plisse::wrinkle
