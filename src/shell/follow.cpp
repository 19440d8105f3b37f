#include "shell/follow.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "base/error.h"
#include "base/interrupt.h"
#include "shell/bending_quadratic.h"
#include "shell/cholesky.h"
#include "shell/energy_terms.h"
#include "shell/potential.h"

namespace plisse::shell {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Triplet = Eigen::Triplet<double>;

// ½ xᵀ(F + cM)x − xᵀ(T + cMX), less what does not depend on x.
class FollowTerm : public ShellTerm {
 public:
  FollowTerm(const Eigen::SparseMatrix<double>& form, const VectorXd& tether) : form_(form), tether_(tether) {
    for (Index v = 0; v < tether.size(); ++v) form_.coeffRef(v, v) += tether[v];
    sizes_ = form_.cwiseAbs();
  }
  // X, and T: they may change from solve to solve, the Hessian does not.
  void aim(const Positions& pose, const Positions& target) { pull_ = target + pose * tether_.asDiagonal(); }

  std::string_view name() const override { return "follow"; }
  void add(const Positions& x, EnergySum& energy, ForceSum* forces) const override {
    const Positions force = x * form_;
    energy.energy += 0.5 * x.cwiseProduct(force).sum() - x.cwiseProduct(pull_).sum();
    // Almost all of the summands cancel, but their rounding errors do not.
    energy.summands += 0.5 * x.cwiseAbs().cwiseProduct(x.cwiseAbs() * sizes_).sum() +
                       x.cwiseAbs().cwiseProduct(pull_.cwiseAbs()).sum();
    if (!forces) return;
    forces->force += force - pull_;
    forces->size += force.cwiseAbs() + pull_.cwiseAbs();
  }
  const Eigen::SparseMatrix<double>* constant_hessian() const override { return &form_; }

 private:
  Eigen::SparseMatrix<double> form_, sizes_;  // and its absolute values
  VectorXd tether_;
  Positions pull_;
};

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

// The rotation nearest to a matrix.
Matrix3d rotation_of(const Matrix3d& matrix) {
  const Eigen::JacobiSVD<Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d &u = svd.matrixU(), &v = svd.matrixV();
  return u * Vector3d(1, 1, (u * v.transpose()).determinant() < 0 ? -1 : 1).asDiagonal() * v.transpose();
}

}  // namespace

Follower::Follower(Topology topology, std::vector<RestFace> rest, const Positions& rest_positions,
                   const FollowSettings& settings, std::vector<bool> held)
    : topology_(std::move(topology)),
      rest_(std::move(rest)),
      settings_(settings),
      held_(std::move(held)),
      idle_(std::make_unique<Idle>()) {
  const auto count = static_cast<Index>(topology_.vertex_count);
  if (rest_.size() != topology_.faces.size() || (rest_positions.size() > 0 && rest_positions.cols() != count))
    throw Error(ExitCode::bad_input,
                fmt::format("{} faces and {} vertices, but {} rest triangles and {} rest positions",
                            topology_.faces.size(), count, rest_.size(), rest_positions.cols()));
  material_.young = material_.thickness = 1;
  material_.poisson = settings.poisson;
  areas_ = vertex_areas(topology_, rest_);
  if (!(settings.wavelength > 0)) return;
  const double reach = settings.reach * settings.wavelength,
               cut = std::pow(settings.wavelength / (2 * std::numbers::pi), 4);
  tether_ = material_.young * material_.thickness / (reach * reach);

  const CellLaplacian laplacian = cell_laplacian(topology_, rest_);
  std::vector<Triplet> entries;
  std::vector<double> weights;
  for (Index column = 0; column < count; ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(laplacian.integral, column); it; ++it)
      entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(column), it.value());
  for (std::uint32_t v = 0; v < topology_.vertex_count; ++v) {
    const double area = laplacian.areas[v];
    weights.push_back(area > 0 ? tether_ * cut / area : 0);
    row_vertex_.push_back(v);
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

// What a solve needs and the next can have again: everything but the pose.
struct Follower::Workspace {
  Shell shell;
  Conditions conditions;
  Loads loads;
  FollowTerm* term = nullptr;  // of the potential
  std::unique_ptr<Potential> potential;
  Cholesky cholesky;
  bool analysed = false;

  Workspace(const Follower& follower, const VectorXd& tether)
      : shell{follower.topology_,
              follower.rest_,
              follower.material_,
              Stretching::tension_field,
              Bending::off,
              0,
              follower.settings_.tension_limit,
              {}},
        conditions(follower.topology_.vertex_count) {
    for (std::uint32_t v = 0; v < follower.held_.size(); ++v)
      if (follower.held_[v]) conditions.hold(v, Vector3d::Zero());  // where each pose has it, not there
    Potential::Terms terms;
    terms.push_back(stretching_term({shell, conditions, loads, Vector3d::Zero(), follower.areas_}));
    auto own = std::make_unique<FollowTerm>(follower.form_, tether);
    term = own.get();
    terms.push_back(std::move(own));
    potential = std::make_unique<Potential>(shell, conditions, std::move(terms));
  }
};

struct Follower::Idle {
  std::mutex mutex;
  std::vector<std::unique_ptr<Workspace>> workspaces;
};

std::unique_ptr<Follower::Workspace> Follower::borrow() const {
  {
    const std::lock_guard lock(idle_->mutex);
    if (!idle_->workspaces.empty()) {
      auto own = std::move(idle_->workspaces.back());
      idle_->workspaces.pop_back();
      return own;
    }
  }
  VectorXd tether = tether_ * areas_;
  for (Index v = 0; v < tether.size(); ++v)
    if (!(tether[v] > 0)) tether[v] = 1;  // a vertex without faces stays where it is
  return std::make_unique<Workspace>(*this, tether);
}

void Follower::give_back(std::unique_ptr<Workspace> workspace) const {
  const std::lock_guard lock(idle_->mutex);
  idle_->workspaces.push_back(std::move(workspace));
}

Follower::Follower(Follower&&) noexcept = default;
Follower::~Follower() = default;

Followed Follower::follow(const Positions& pose) const {
  if (pose.cols() != areas_.size() || !pose.allFinite())
    throw Error(ExitCode::bad_input,
                pose.allFinite()
                    ? fmt::format("a pose of {} vertices for a shell of {}", pose.cols(), areas_.size())
                    : std::string("a pose with positions that are not finite"));
  Followed result;
  if (!(settings_.wavelength > 0)) {
    result.base = pose;
    result.converged = true;
    return result;
  }
  const Vector3d origin = pose.rowwise().mean();  // near the shell rounding is least
  const Positions given = pose.colwise() - origin;
  std::unique_ptr<Workspace> own = borrow();
  Potential& potential = *own->potential;
  Positions x = given, target = turned_curvature(given);
  for (int pass = 0; pass < settings_.passes; ++pass) {
    if (pass > 0) target = x * form_;
    own->term->aim(given, target);
    result.converged = false;
    VectorXd gradient;
    double energy = potential.value(x, &gradient).energy;
    for (int step = 0; step < settings_.max_iterations && !interrupted(); ++step) {
      const Eigen::SparseMatrix<double>& hessian = potential.hessian(x, Curvature::positive);
      if (!own->analysed) own->cholesky.analyse(hessian);
      own->analysed = true;
      if (!own->cholesky.factorise(hessian)) break;
      const VectorXd direction = own->cholesky.solve(-gradient);
      // E is convex and its tether strong: a Newton step that is nothing is the end.
      if (direction.cwiseAbs().maxCoeff() <= settings_.tolerance * settings_.wavelength) {
        result.converged = true;
        break;
      }
      const double slope = gradient.dot(direction);
      double length = 1;
      Positions next;
      VectorXd there;
      bool down = false;
      for (int halving = 0; halving < 30 && !down; ++halving, length /= 2) {
        next = x;
        potential.advance(next, direction, length);
        const Potential::Value value = potential.value(next, &there);
        // Where the energy's rounding hides the fall, the slope tells.
        const double rounding = 1e-14 * value.summands;
        down = value.energy <= energy + 1e-4 * length * slope + rounding;
        if (down) energy = value.energy;
      }
      if (!down) {
        // No step lowers the energy's digits any more: good where hardly one was left.
        constexpr double left = 1e-5;  // of Λ: a hundredth of what an eye sees in a wave
        result.converged = direction.cwiseAbs().maxCoeff() <= left * settings_.wavelength;
        break;
      }
      x = std::move(next);
      gradient = std::move(there);
      ++result.iterations;
    }
    if (!result.converged) break;
  }
  give_back(std::move(own));
  result.base = x.colwise() + origin;
  const Eigen::RowVectorXd moved = (result.base - pose).colwise().squaredNorm();
  double sum = 0, most = 0;
  Index used = 0;
  for (Index v = 0; v < moved.size(); ++v) {
    if (!(areas_[v] > 0)) continue;
    sum += moved[v];
    most = std::max(most, moved[v]);
    ++used;
  }
  result.moved_rms = used > 0 ? std::sqrt(sum / static_cast<double>(used)) : 0;
  result.moved_most = std::sqrt(most);
  return result;
}

}  // namespace plisse::shell
