// Uses Eigen's decompositions where docs/passes.md has closed forms, so that each checks the other.
#include "reference/crush.h"

#include <cmath>

#include "reference/functions.h"

namespace plisse::reference {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix2Xd;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;

namespace {

constexpr double least_singular_value = 0.05;  // r_min

// k moves toward this frame's k̂, by more the more certain k̂ is (docs/contract.md, "State over time", rule 2).
// The direction of an idle vertex counts as unset.
Vector2d updated_direction(const Vector2d& k, bool unset, const Vector2d& minimum, double gap) {
  if (unset) return gap > 0.01 ? minimum : k;
  return (k + std::min(gap / 0.01, 1.0) * (minimum - k)).normalized();
}

Status updated_status(Status previous, double shortening, double mask, bool has_direction,
                      const CrushSettings& settings) {
  if (!settings.smooth) return Status::set;
  if (previous == Status::idle)
    return shortening > settings.dead_zone && mask > 0 && has_direction ? Status::fresh : Status::idle;
  return shortening < settings.dead_zone / 2 || mask == 0 || !has_direction ? Status::idle : previous;
}

}  // namespace

Matrix2d regression(const Matrix2Xd& v, const Matrix2Xd& posed) {
  const Matrix2d S = v * v.transpose();
  if (!(S.trace() > 0)) return Matrix2d::Identity();
  const Matrix2d muE = 1e-6 * S.trace() * Matrix2d::Identity();
  return (posed * v.transpose() + muE) * (S + muE).inverse();
}

Vector2d wave_vector(const Matrix2d& M, const Vector2d& k) {
  // M = UΣVᵀ, so M⁻ᵀ = UΣ⁻¹Vᵀ.
  const Eigen::JacobiSVD<Matrix2d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector2d floored = svd.singularValues().cwiseMax(least_singular_value);
  return svd.matrixU() * (svd.matrixV().transpose() * k).cwiseQuotient(floored);
}

double relative_height(double r, double dead_zone) {
  const double ease = smoothstep(dead_zone / 2, dead_zone, 1 - r);
  return 0.25 * std::sqrt(std::max((1 - r) * (1 + r), 0.0)) * ease;
}

CrushResult crush_vertex(const Matrix2d& M, double wavelength, double mask, const CrushSettings& settings,
                         const CrushState& previous) {
  CrushResult result;
  result.M = M;
  const Eigen::JacobiSVD<Matrix2d> svd(M, Eigen::ComputeFullV);
  result.stretch = svd.singularValues()[0];
  result.r = svd.singularValues()[1];
  const double largest = result.stretch * result.stretch, smallest = result.r * result.r;
  result.gap = largest > 0 ? (largest - smallest) / (largest + smallest) : 0;

  result.minimum = svd.matrixV().col(1);
  // As v₂ = (−sin θ, cos θ) with cos θ ≥ 0; then along the kept direction where there is one.
  if (result.minimum.y() < 0) result.minimum = -result.minimum;
  if (previous.direction.dot(result.minimum) < 0) result.minimum = -result.minimum;
  const bool unset = previous.direction.isZero(0) || (settings.smooth && previous.status == Status::idle);
  result.direction = updated_direction(previous.direction, unset, result.minimum, result.gap);
  result.wave_vector = wave_vector(M, result.direction);
  result.wavenumber = result.wave_vector / wavelength;

  const double relative = mask * relative_height(result.r, settings.dead_zone);  // h/W
  result.height = wavelength * relative;
  result.weight = std::clamp((relative - 0.0125) / 0.0625, 0.0, 1.0);
  result.status = updated_status(previous.status, 1 - result.r, mask, !unset || result.gap > 0.01, settings);
  return result;
}

Matrix2d biased(const Matrix2d& M, const Eigen::Matrix<double, 3, 2>& rest_basis, const Eigen::Vector3d& p) {
  Vector2d q = rest_basis.transpose() * p;
  if (q.norm() > 0.99) q = 0.99 * q.normalized();
  const Matrix2d shortening = Matrix2d::Identity() - q * q.transpose();
  return M * shortening;
}

Matrix2d without_stretch_along(const Matrix2d& M, const Vector2d& direction) {
  const double stretch = std::max((M * direction).norm(), least_singular_value);
  const Matrix2d change = Matrix2d::Identity() + (1 / stretch - 1) * direction * direction.transpose();
  return M * change;
}

void begin_as_solved(const Vector2d& q, double phase, const CrushState& previous, CrushResult& vertex) {
  const auto is_along = [&](const Vector2d& k) { return std::abs(k.dot(q)) >= std::sqrt(0.5) * q.norm(); };
  if (vertex.status == Status::idle || !is_along(vertex.direction)) return;
  if (previous.status != Status::idle && is_along(previous.direction)) return;
  vertex.status = Status::set;
  vertex.phase = std::copysign(1.0, vertex.direction.dot(q)) * phase;
}

std::vector<CrushResult> crush(const Topology& topology, const Frames& rest_frames,
                               const Matrix3Xd& positions, const Frames& frames,
                               const Eigen::VectorXd& wavelength, const Eigen::VectorXd& mask,
                               const CrushSettings& settings, const std::vector<CrushState>& previous,
                               const Bias& bias) {
  std::vector<CrushResult> results;
  results.reserve(static_cast<std::size_t>(topology.size()));
  for (Index vertex = 0; vertex < topology.size(); ++vertex) {
    const auto index = static_cast<std::size_t>(vertex);
    if (settings.unstrained) {
      const Matrix2d M = biased(Matrix2d::Identity(), frames.basis(vertex), bias.p.col(vertex));
      results.push_back(crush_vertex(M, wavelength[vertex], mask[vertex], settings, previous[index]));
      continue;
    }
    const auto neighbours = row(topology.neighbours, vertex);
    Matrix2Xd v(2, neighbours.size()), posed(2, neighbours.size());
    Index column = 0;
    for (const std::uint32_t i : neighbours) {
      v.col(column) =
          rest_frames.basis(vertex).transpose() * (topology.rest.col(i) - topology.rest.col(vertex));
      posed.col(column) = frames.basis(vertex).transpose() * (positions.col(i) - positions.col(vertex));
      ++column;
    }
    Matrix2d M = regression(v, posed);
    if (bias.carried.cols() > 0 && !bias.carried.col(vertex).isZero(0))
      M = without_stretch_along(
          M, (rest_frames.basis(vertex).transpose() * bias.carried.col(vertex)).normalized());
    if (bias.p.cols() > 0) M = biased(M, rest_frames.basis(vertex), bias.p.col(vertex));
    results.push_back(crush_vertex(M, wavelength[vertex], mask[vertex], settings, previous[index]));
    if (settings.smooth && !bias.phase.empty() && bias.phase[index])
      begin_as_solved(rest_frames.basis(vertex).transpose() * bias.p.col(vertex), *bias.phase[index],
                      previous[index], results.back());
  }
  return results;
}

}  // namespace plisse::reference
