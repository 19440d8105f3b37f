#include "shell/follow.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/interrupt.h"
#include "shell/bending_quadratic.h"
#include "shell/hessian_rows.h"
#include "shell/stretching.h"
#include "shell/walls.h"

namespace plisse::shell {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Triplet = Eigen::Triplet<double>;

// The two boundary edges at each vertex of a boundary curve: its neighbours there, and how long the edges are
// at rest. Vertices at which more boundaries meet, or one ends, are left out.
struct OnCurve {
  std::uint32_t vertex, before, after;
  double length_before, length_after;
};
std::vector<OnCurve> boundary_curves(const Topology& topology, const std::vector<RestFace>& rest) {
  struct End {
    std::uint32_t other;
    double length;
  };
  std::vector<std::vector<End>> ends(topology.vertex_count);
  for (const Edge& edge : topology.edges) {
    if (!edge.boundary()) continue;
    const Face& face = topology.faces[edge.face[0]];
    Eigen::Matrix<double, 2, 3> corner;
    corner << Eigen::Vector2d::Zero(), rest[edge.face[0]].edges;
    const auto place = [&](std::uint32_t v) {
      return corner.col(static_cast<Index>(std::find(face.begin(), face.end(), v) - face.begin())).eval();
    };
    const double length = (place(edge.vertex[0]) - place(edge.vertex[1])).norm();
    ends[edge.vertex[0]].push_back({edge.vertex[1], length});
    ends[edge.vertex[1]].push_back({edge.vertex[0], length});
  }
  std::vector<OnCurve> result;
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v)
    if (ends[v].size() == 2)
      result.push_back({v, ends[v][0].other, ends[v][1].other, ends[v][0].length, ends[v][1].length});
  return result;
}

// The stiffness of an isotropic membrane at rest that resists all directions alike: Yh/(1 − ν²) ∫ ∇u·∇u.
Eigen::SparseMatrix<double> membrane(const Topology& topology, const std::vector<RestFace>& rest,
                                     const Material& material) {
  const double stiffness = material.young * material.thickness / (1 - material.poisson * material.poisson);
  std::vector<Triplet> entries;
  for (std::size_t f = 0; f < rest.size(); ++f) {
    const Matrix3d form = stiffness * rest[f].area * rest[f].gradients.transpose() * rest[f].gradients;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        entries.emplace_back(static_cast<int>(topology.faces[f][k]), static_cast<int>(topology.faces[f][l]),
                             form(static_cast<Index>(k), static_cast<Index>(l)));
  }
  const auto count = static_cast<Index>(topology.vertex_count);
  Eigen::SparseMatrix<double> result(count, count);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// The rotation nearest to a matrix.
Matrix3d rotation_of(const Matrix3d& matrix) {
  const Eigen::JacobiSVD<Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d &u = svd.matrixU(), &v = svd.matrixV();
  return u * Vector3d(1, 1, (u * v.transpose()).determinant() < 0 ? -1 : 1).asDiagonal() * v.transpose();
}

}  // namespace

Follower::Follower(Topology topology, std::vector<RestFace> rest, const Positions& rest_positions,
                   const FollowSettings& settings, const std::vector<bool>& held)
    : topology_(std::move(topology)),
      rest_(std::move(rest)),
      settings_(settings),
      free_(topology_.vertex_count, true) {
  const auto count = static_cast<Index>(topology_.vertex_count);
  if (rest_.size() != topology_.faces.size() || (rest_positions.size() > 0 && rest_positions.cols() != count))
    throw Error(ExitCode::bad_input,
                fmt::format("{} faces and {} vertices, but {} rest triangles and {} rest positions",
                            topology_.faces.size(), count, rest_.size(), rest_positions.cols()));
  material_.young = material_.thickness = 1;
  material_.poisson = settings.poisson;
  areas_ = vertex_areas(topology_, rest_);
  for (std::uint32_t v = 0; v < topology_.vertex_count; ++v)
    free_[v] = areas_[v] > 0 && !(v < held.size() && held[v]);
  if (!(settings.wavelength > 0)) return;
  const double reach = settings.reach * settings.wavelength,
               cut = std::pow(settings.wavelength / (2 * std::numbers::pi), 4);
  tether_ = material_.young * material_.thickness / (reach * reach);

  const VectorXd cells = cell_laplacian(topology_, rest_).areas;
  std::vector<Triplet> entries;
  std::vector<double> weights;
  for (const HessianRows& hessian : hessian_rows(topology_, rest_))
    for (const auto& integral : hessian.integral) {
      for (const auto& [v, value] : integral)
        entries.emplace_back(static_cast<int>(weights.size()), static_cast<int>(v), value);
      weights.push_back(tether_ * cut / cells[hessian.vertex]);
      row_vertex_.push_back(hessian.vertex);
    }
  // A corner of the rest shape is no part of a smooth curve; and where only its triangles are known, not
  // where it is in space, curves that turn within it are left out as well.
  const double straight = (rest_positions.size() > 0 ? 30 : 5) * std::numbers::pi / 180;
  VectorXd angle = VectorXd::Zero(count);  // of all faces at a vertex
  for (std::size_t f = 0; f < rest_.size(); ++f) {
    Eigen::Matrix<double, 2, 3> corner;
    corner << Eigen::Vector2d::Zero(), rest_[f].edges;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d u = corner.col((i + 1) % 3) - corner.col(i),
                            v = corner.col((i + 2) % 3) - corner.col(i);
      angle[topology_.faces[f][static_cast<std::size_t>(i)]] +=
          std::acos(std::clamp(u.dot(v) / (u.norm() * v.norm()), -1.0, 1.0));
    }
  }
  for (const OnCurve& at : boundary_curves(topology_, rest_)) {
    if (std::abs(angle[at.vertex] - std::numbers::pi) > straight) continue;
    const int row = static_cast<int>(weights.size()), v = static_cast<int>(at.vertex);
    entries.emplace_back(row, static_cast<int>(at.before), 1 / at.length_before);
    entries.emplace_back(row, static_cast<int>(at.after), 1 / at.length_after);
    entries.emplace_back(row, v, -1 / at.length_before - 1 / at.length_after);
    // ∫ |x''|² ds of the strip of cells along it, as wide as they are: x'' is the row over the length at the
    // vertex.
    const double length = (at.length_before + at.length_after) / 2;
    weights.push_back(tether_ * cut * (areas_[v] / length) / length);
    row_vertex_.push_back(at.vertex);
  }
  const auto rows = static_cast<Index>(weights.size());
  weights_ = Eigen::Map<const VectorXd>(weights.data(), rows);
  curvature_.resize(rows, count);
  curvature_.setFromTriplets(entries.begin(), entries.end());
  form_ = curvature_.transpose() * (weights_.asDiagonal() * curvature_).eval();
  form_.makeCompressed();
  const Eigen::SparseMatrix<double> smoothing =
      form_ + Eigen::SparseMatrix<double>((tether_ * areas_).asDiagonal());
  smoothing_.emplace(smoothing, free_);
  matrix_ = smoothing + membrane(topology_, rest_, material_);
  metric_.emplace(matrix_, free_);

  if (rest_positions.size() == 0) return;
  rest_curvature_ = rest_positions * curvature_.transpose();
  for (std::size_t f = 0; f < rest_.size(); ++f) {
    const Corners corners = corners_of(topology_.faces[f], rest_positions);
    const Eigen::Matrix<double, 3, 2> axes = deformation_gradient(rest_[f], corners);
    Matrix3d frame;
    frame << axes, axes.col(0).cross(axes.col(1)).normalized();
    frames_.push_back(frame);
  }
}

Positions Follower::turned_curvature(const Positions& pose) const {
  Positions target = Positions::Zero(3, pose.cols());
  if (frames_.empty()) return target;
  std::vector<Matrix3d> ring(topology_.vertex_count,
                             Matrix3d::Zero());  // area times the deformation, of the faces
  for (std::size_t f = 0; f < rest_.size(); ++f) {
    const Eigen::Matrix<double, 3, 2> axes =
        deformation_gradient(rest_[f], corners_of(topology_.faces[f], pose));
    const Vector3d normal = axes.col(0).cross(axes.col(1));
    Matrix3d frame;
    frame << axes, normal.norm() > 0 ? Vector3d(normal.normalized()) : Vector3d(Vector3d::Zero());
    const Matrix3d moved = rest_[f].area / 3 * frame * frames_[f].transpose();
    for (const std::uint32_t v : topology_.faces[f]) ring[v] += moved;
  }
  // Where a ring is crushed its rotation means little, and the curvature fades out.
  constexpr double crushed = 0.2, sound = 0.6;  // (σ₂ + σ₃)/2 of the mean deformation
  Positions turned = rest_curvature_;
  std::vector<Matrix3d> rotation(topology_.vertex_count);
  for (std::uint32_t v = 0; v < topology_.vertex_count; ++v) {
    const Matrix3d mean = areas_[v] > 0 ? Matrix3d(ring[v] / areas_[v]) : Matrix3d(Matrix3d::Identity());
    const Vector3d sigma = Eigen::JacobiSVD<Matrix3d>(mean).singularValues();
    const double share = std::clamp(((sigma[1] + sigma[2]) / 2 - crushed) / (sound - crushed), 0.0, 1.0);
    rotation[v] = share * share * (3 - 2 * share) * rotation_of(mean);
  }
  for (std::size_t r = 0; r < row_vertex_.size(); ++r) {
    const auto row = static_cast<Index>(r);
    turned.col(row) = weights_[row] * (rotation[row_vertex_[r]] * rest_curvature_.col(row));
  }
  return turned * curvature_;
}

EnergyValue Follower::value(const Positions& pose, const Positions& moved, const Positions& pull) const {
  const StretchingLaw law{material_, Stretching::tension_field, 0, settings_.tension_limit};
  const Positions x = pose + moved, bent = moved * form_;
  std::vector<double> energies(rest_.size());
  std::vector<Vector9> gradients(rest_.size());
  tbb::parallel_for(std::size_t{0}, rest_.size(), [&](std::size_t f) {
    energies[f] = stretching(law, rest_[f], corners_of(topology_.faces[f], x), &gradients[f]);
  });
  EnergyValue result;
  result.gradient = bent + pull;
  const auto count = [&](double summand) {
    result.energy += summand;
    result.summands += std::abs(summand);
  };
  for (std::size_t f = 0; f < rest_.size(); ++f) {
    count(energies[f]);
    for (std::size_t k = 0; k < 3; ++k)
      result.gradient.col(topology_.faces[f][k]) += gradients[f].segment<3>(static_cast<Index>(3 * k));
  }
  for (Index v = 0; v < x.cols(); ++v) {
    const Vector3d u = moved.col(v);
    count(0.5 * u.dot(bent.col(v)));
    count(u.dot(pull.col(v)));
    count(0.5 * tether_ * areas_[v] * u.squaredNorm());
    if (free_[static_cast<std::size_t>(v)])
      result.gradient.col(v) += tether_ * areas_[v] * u;
    else
      result.gradient.col(v).setZero();
  }
  return result;
}

Followed Follower::follow(const Positions& pose, const Positions* start,
                          const std::vector<HalfSpace>& outside) const {
  if (pose.cols() != areas_.size() || !pose.allFinite())
    throw Error(ExitCode::bad_input,
                pose.allFinite()
                    ? fmt::format("a pose of {} vertices for a shell of {}", pose.cols(), areas_.size())
                    : std::string("a pose with positions that are not finite"));
  Followed result;
  result.base = pose;
  if (!(settings_.wavelength > 0)) {
    result.converged = true;
    return result;
  }
  const Vector3d origin = pose.rowwise().mean();  // near the shell rounding is least
  const Positions given = pose.colwise() - origin, bent = given * form_;
  Positions pull = bent - turned_curvature(given), moved = smoothing_->solve(-pull);
  for (int pass = 1; pass < settings_.passes; ++pass) {
    pull = -(moved * form_);
    moved = smoothing_->solve(-pull);
  }
  if (start)
    for (Index v = 0; v < pose.cols(); ++v)
      if (free_[static_cast<std::size_t>(v)]) moved.col(v) = start->col(v) - pose.col(v);
  MinimumSettings search;
  search.max_iterations = settings_.max_iterations;
  search.tolerance = settings_.tolerance * settings_.wavelength;
  search.good_enough = 1e-5 * settings_.wavelength;  // a hundredth of what an eye sees in a wave
  const auto metric = [&](const Positions& gradient) { return metric_->solve(gradient); };
  Minimum minimum;
  if (outside.empty()) {
    minimum = find_minimum(
        moved, [&](const Positions& u) { return value(given, u, pull); }, metric, search);
    result.converged = minimum.converged;
    result.iterations = minimum.iterations;
  } else {
    // Early searches need not end: what they are for changes with the multipliers.
    constexpr int most_rounds = 40, early = 4, early_steps = 12, later_steps = 100, hopeless = 6;
    double deepest = std::numeric_limits<double>::infinity();
    int best = 0;
    search.memory = 20;
    search.tolerance = 1e-6 * settings_.wavelength;
    Walls walls(outside, pose, matrix_.diagonal(), free_);
    const WallMetric with_walls(matrix_, free_, outside, walls.stiffness());
    minimum.x = moved;
    for (int round = 0; round < most_rounds && !result.converged && !interrupted(); ++round) {
      search.max_iterations = round < early ? early_steps : later_steps;
      minimum = find_minimum(
          minimum.x,
          [&](const Positions& u) {
            EnergyValue sum = value(given, u, pull);
            walls.add(u, sum);
            for (Index v = 0; v < u.cols(); ++v)
              if (!free_[static_cast<std::size_t>(v)]) sum.gradient.col(v).setZero();
            return sum;
          },
          [&](const Positions& gradient) { return with_walls.solve(gradient); }, search);
      result.iterations += minimum.iterations;
      const double deep = walls.take(minimum.x);
      result.converged = deep <= 1e-4 * settings_.wavelength && minimum.converged;
      // Bodies that leave no way between them: pushing on ends nowhere.
      if (deep < 0.5 * deepest) {
        deepest = deep;
        best = round;
      } else if (round - best >= hopeless && deep > 1e-4 * settings_.wavelength) {
        break;
      }
    }
  }
  result.base += minimum.x;
  double sum = 0;
  Index used = 0;
  for (Index v = 0; v < pose.cols(); ++v) {
    if (!(areas_[v] > 0)) continue;
    const double squared = minimum.x.col(v).squaredNorm();
    sum += squared;
    result.moved_most = std::max(result.moved_most, std::sqrt(squared));
    ++used;
  }
  result.moved_rms = used > 0 ? std::sqrt(sum / static_cast<double>(used)) : 0;
  return result;
}

}  // namespace plisse::shell
