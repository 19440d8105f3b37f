#include "wrinkle/problem.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "wrinkle/local_waves.h"
#include "wrinkle/patches.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<bool> negated(std::vector<bool> flags) {
  flags.flip();
  return flags;
}

// No amplitude: clamped, on a wrinkle-free face, or on no face at all.
std::vector<bool> pinned_vertices(const shell::Topology& topology, const std::vector<bool>& wrinkle_free,
                                  const std::vector<bool>& clamped) {
  std::vector<bool> pinned(topology.vertex_count, true);
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (wrinkle_free[f]) continue;
    for (const std::uint32_t v : topology.faces[f]) pinned[v] = !clamped.empty() && clamped[v];
  }
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (!wrinkle_free[f]) continue;
    for (const std::uint32_t v : topology.faces[f]) pinned[v] = true;
  }
  return pinned;
}

// Faces that carry energy: those with a corner that may move.
std::vector<bool> live_faces(const shell::Topology& topology, const std::vector<bool>& wrinkle_free,
                             const std::vector<bool>& pinned) {
  std::vector<bool> live = negated(wrinkle_free);
  for (std::size_t f = 0; f < live.size(); ++f) {
    const shell::Face& t = topology.faces[f];
    if (pinned[t[0]] && pinned[t[1]] && pinned[t[2]]) live[f] = false;
  }
  return live;
}

// Less the negative eigenvalues, in the units given by `scale` (per row); 0 where there is none.
LocalMatrix nearest_lift(const LocalMatrix& matrix, const LocalVector& scale) {
  const LocalMatrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  LocalMatrix lift = LocalMatrix::Zero();
  // Most are positive definite already; a Cholesky factorisation finds this at a tenth of the cost.
  if (Eigen::LLT<LocalMatrix>(scaled).info() == Eigen::Success) return lift;
  const Eigen::SelfAdjointEigenSolver<LocalMatrix> eigen(scaled);
  for (Index k = 0; k < 5; ++k) {  // in ascending order
    if (!(eigen.eigenvalues()[k] < 0)) break;
    const LocalVector v = eigen.eigenvectors().col(k).cwiseQuotient(scale);
    lift -= eigen.eigenvalues()[k] * v * v.transpose();
  }
  return lift;
}

// The least of a few shares of the metric that makes the sum positive semidefinite; where none does, as
// above.
LocalMatrix metric_lift(const LocalMatrix& matrix, const LocalMatrix& metric, const LocalVector& scale) {
  const LocalMatrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal(),
                    measure = scale.asDiagonal() * metric * scale.asDiagonal();
  constexpr double rounding = 1e-10;
  const double shift = rounding * scaled.diagonal().cwiseAbs().sum();
  for (const double share : {0.0, 0.02, 0.1, 0.3, 0.7, 1.5, 3.0}) {
    LocalMatrix sum = scaled + share * measure;
    sum.diagonal().array() += shift;
    if (Eigen::LLT<LocalMatrix>(sum).info() == Eigen::Success) return share * metric;
  }
  return nearest_lift(matrix, scale);
}

}  // namespace

Problem::Problem(shell::Topology topology, std::vector<FaceForms> forms, const Model& model,
                 std::vector<bool> wrinkle_free, std::vector<bool> clamped)
    : topology_(std::move(topology)),
      forms_(std::move(forms)),
      model_(model),
      wrinkle_free_(std::move(wrinkle_free)),
      pinned_(pinned_vertices(topology_, wrinkle_free_, clamped)),
      live_(live_faces(topology_, wrinkle_free_, pinned_)),
      complex_(topology_, model.relaxed_integrability ? live_ : std::vector<bool>(live_.size(), true),
               model.relaxed_integrability ? pinned_ : std::vector<bool>(pinned_.size(), false)) {
  shell::check(model.material);
  for (std::size_t v = 0; v < pinned_.size(); ++v)
    amplitude_unknown_.push_back(pinned_[v] ? -1 : amplitude_count_++);
  size_ = period_begin() + static_cast<Index>(complex_.periods);

  own_waves_ = local_waves(forms_, topology_, live_, pinned_, model_);
  double amplitude = 0, frequency = 0;
  for (const LocalWaves& w : own_waves_) {
    const double rate = w.gradient.norm();
    frequency = std::max(frequency, rate);
    if (rate > 0) amplitude = std::max(amplitude, std::sqrt(2 * std::max(w.compression, 0.0)) / rate);
  }
  frequency_scale_ = frequency > 0 ? frequency : 1;
  amplitude_scale_ = amplitude > 0 ? amplitude : model_.material.thickness;
  upper_ = VectorXd::Zero(amplitude_count_);
  for (const auto& patch : patches(topology_, live_)) {
    double strongest = 0;
    for (const std::uint32_t f : patch) strongest = std::max(strongest, own_waves_[f].compression);
    const double longest = PatchGraph(topology_, forms_, patch).diameter() / (2 * std::numbers::pi),
                 most = std::max(std::sqrt(2 * strongest) * longest, model_.material.thickness) /
                        amplitude_scale_;
    for (const std::uint32_t f : patch) {
      for (const std::uint32_t v : topology_.faces[f])
        if (const Index i = amplitude_unknown_[v]; i >= 0) upper_[i] = std::max(upper_[i], most);
    }
  }
  constexpr double none = 1e-9;  // in the scale: a range for the solver, and nothing to see
  for (std::size_t f = 0; f < forms_.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c)
      if (const Index i = amplitude_unknown_[topology_.faces[f][c]]; i >= 0)
        upper_[i] = std::min(upper_[i], std::max(forms_[f].room[c] / amplitude_scale_, none));

  std::vector<Eigen::Triplet<double>> entries;
  for (std::uint32_t f = 0; f < topology_.faces.size(); ++f) {
    if (!live_[f]) {
      // All corners are pinned: flat in any state.
      const FaceEnergy still(forms_[f], model_);
      if (!wrinkle_free_[f]) relaxed_energy_ += still.relaxed() + still.value(LocalVector::Zero());
      continue;
    }
    Face face{f, FaceEnergy(forms_[f], model_), {}, {}};
    for (const std::uint32_t v : topology_.faces[f]) face.unknown.push_back(amplitude_unknown_[v]);
    relaxed_energy_ += face.energy.relaxed();
    const auto& jumps = complex_.jumps[f];
    face.phase.resize(2, static_cast<Index>(3 + jumps.size()));
    face.phase.leftCols<3>() = forms_[f].rest.gradients;
    for (const int v : complex_.phase_vertex[f]) face.unknown.push_back(phase_begin() + v);
    for (std::size_t j = 0; j < jumps.size(); ++j) {
      face.phase.col(static_cast<Index>(3 + j)) = forms_[f].rest.gradients * jumps[j].corners;
      face.unknown.push_back(period_begin() + jumps[j].period);
    }
    for (const Index i : face.unknown) {
      for (const Index j : face.unknown) {
        if (i >= j && j >= 0) entries.emplace_back(i, j, 0.0);
      }
    }
    face.part = part_count_;
    part_count_ += face.unknown.size() * (face.unknown.size() + 1) / 2;
    faces_.push_back(std::move(face));
  }
  for (Index i = 0; i < size_; ++i) entries.emplace_back(i, i, 0.0);
  pattern_.resize(size_, size_);
  pattern_.setFromTriplets(entries.begin(), entries.end());
  pattern_.makeCompressed();
  // Two unknowns of a face are never the same one but on the diagonal (phase vertices of a triangle are
  // distinct vertices).
  std::vector<Index> slots;  // of each face's number, −1 where none
  first_source_.assign(static_cast<std::size_t>(pattern_.nonZeros()) + 1, 0);
  for (const Face& face : faces_) {
    for (std::size_t i = 0; i < face.unknown.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const Index row = std::max(face.unknown[i], face.unknown[j]),
                    column = std::min(face.unknown[i], face.unknown[j]);
        if (column < 0) {
          slots.push_back(-1);
          continue;
        }
        const int* begin = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[column];
        const int* end = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[column + 1];
        slots.push_back(std::lower_bound(begin, end, row) - pattern_.innerIndexPtr());
        ++first_source_[static_cast<std::size_t>(slots.back()) + 1];
      }
    }
  }
  std::partial_sum(first_source_.begin(), first_source_.end(), first_source_.begin());
  source_.resize(first_source_.back());
  std::vector<std::uint32_t> next(first_source_.begin(), first_source_.end() - 1);
  for (std::size_t k = 0; k < slots.size(); ++k)
    if (slots[k] >= 0) source_[next[static_cast<std::size_t>(slots[k])]++] = static_cast<std::uint32_t>(k);
}

void Problem::gather(const std::vector<double>& parts, SparseMatrix& sum) const {
  constexpr std::size_t grain = 4096;
  double* values = sum.valuePtr();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, first_source_.size() - 1, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t slot = range.begin(); slot < range.end(); ++slot) {
                        double value = 0;
                        for (std::size_t k = first_source_[slot]; k < first_source_[slot + 1]; ++k)
                          value += parts[source_[k]];
                        values[slot] = value;
                      }
                    });
}

VectorXd Problem::pack(const Waves& waves) const {
  VectorXd x(size_);
  for (std::size_t v = 0; v < pinned_.size(); ++v) {
    if (amplitude_unknown_[v] >= 0)
      x[amplitude_unknown_[v]] = waves.amplitude[static_cast<Index>(v)] / amplitude_scale_;
  }
  x.segment(phase_begin(), waves.phase.size()) = waves.phase;
  x.tail(waves.period.size()) = waves.period;
  return x;
}

Waves Problem::unpack(const VectorXd& x) const {
  Waves waves;
  waves.amplitude = VectorXd::Zero(static_cast<Index>(pinned_.size()));
  for (std::size_t v = 0; v < pinned_.size(); ++v) {
    if (amplitude_unknown_[v] >= 0)
      waves.amplitude[static_cast<Index>(v)] = amplitude_scale_ * x[amplitude_unknown_[v]];
  }
  waves.phase = x.segment(phase_begin(), static_cast<Index>(complex_.vertices));
  waves.period = x.tail(static_cast<Index>(complex_.periods));
  return waves;
}

void Problem::copy_patch(const std::vector<std::uint32_t>& faces, const Waves& from, Waves& to,
                         double height) const {
  for (const std::uint32_t f : faces) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = topology_.faces[f][c];
      const int p = complex_.phase_vertex[f][c];
      to.amplitude[v] = height * from.amplitude[v];
      to.phase[p] = from.phase[p];
    }
    for (const auto& jump : complex_.jumps[f]) to.period[jump.period] = from.period[jump.period];
  }
}

LocalVector Problem::scales() const {
  LocalVector scale;
  scale << amplitude_scale_, amplitude_scale_, amplitude_scale_, frequency_scale_, frequency_scale_;
  return scale;
}

LocalVector Problem::local(const Face& face, const VectorXd& x) const {
  LocalVector result;
  for (Index i = 0; i < 3; ++i) {
    const Index unknown = face.unknown[static_cast<std::size_t>(i)];
    result[i] = unknown >= 0 ? amplitude_scale_ * x[unknown] : 0;
  }
  result.tail<2>().setZero();
  for (Index i = 0; i < face.phase.cols(); ++i)
    result.tail<2>() += face.phase.col(i) * x[face.unknown[static_cast<std::size_t>(3 + i)]];
  return result;
}

void Problem::add_gradient(const Face& face, const LocalVector& first, VectorXd& sum) const {
  for (Index i = 0; i < 3; ++i) {
    const Index unknown = face.unknown[static_cast<std::size_t>(i)];
    if (unknown >= 0) sum[unknown] += amplitude_scale_ * first[i];
  }
  for (Index i = 0; i < face.phase.cols(); ++i)
    sum[face.unknown[static_cast<std::size_t>(3 + i)]] += face.phase.col(i).dot(first.tail<2>());
}

// Of each live face on all cores, then summed in their order.
template <typename Value>
double Problem::sum_over_faces(const VectorXd& x, const Value& value) const {
  std::vector<double> values(faces_.size());
  constexpr std::size_t grain = 512;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces_.size(), grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t f = range.begin(); f < range.end(); ++f)
                        values[f] = value(faces_[f].energy, local(faces_[f], x));
                    });
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double Problem::energy(const VectorXd& x) const {
  return sum_over_faces(x, [](const FaceEnergy& energy, const LocalVector& at) { return energy.value(at); });
}

double Problem::rounding(const VectorXd& x) const {
  return 4 * std::numeric_limits<double>::epsilon() *
         sum_over_faces(x,
                        [](const FaceEnergy& energy, const LocalVector& at) { return energy.magnitude(at); });
}

VectorXd Problem::face_energies(const VectorXd& x) const {
  VectorXd result = VectorXd::Zero(static_cast<Index>(forms_.size()));
  for (const Face& face : faces_) result[face.face] = face.energy.value(local(face, x));
  return result;
}

VectorXd Problem::taken_up(const VectorXd& x) const {
  VectorXd result = VectorXd::Zero(size_);
  for (const Face& face : faces_) {
    const double share = face.energy.taken_up(local(face, x)) / 3 * amplitude_scale_ * amplitude_scale_;
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = face.unknown[c];
      if (a < 0) continue;
      result[phase_begin() + complex_.phase_vertex[face.face][c]] += share * x[a] * x[a];
    }
  }
  return result;
}

double Problem::gradient(const VectorXd& x, VectorXd& first) const {
  first = VectorXd::Zero(size_);
  double sum = 0;
  LocalVector gradient;
  for (const Face& face : faces_) {
    sum += face.energy.gradient(local(face, x), gradient);
    add_gradient(face, gradient, first);
  }
  return sum;
}

void Problem::place(const Face& face, const LocalMatrix& matrix, std::vector<double>& parts) const {
  double* part = &parts[face.part];
  const double scale = amplitude_scale_;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j <= i; ++j) *part++ = scale * scale * matrix(i, j);
  for (Index i = 0; i < face.phase.cols(); ++i) {
    const Eigen::Vector2d p = face.phase.col(i);
    for (Index j = 0; j < 3; ++j) *part++ = scale * (p.x() * matrix(3, j) + p.y() * matrix(4, j));
    const Eigen::Vector2d across = matrix.bottomRightCorner<2, 2>() * p;
    for (Index j = 0; j <= i; ++j) *part++ = across.dot(face.phase.col(j));
  }
}

Problem::Curvature::Curvature(const Problem& problem)
    : problem_(problem),
      exact_(problem.pattern()),
      states_(problem.faces_.size()),
      hessians_(problem.faces_.size()),
      parts_(problem.part_count_) {}

// each(index of a face) gives its part, on all cores.
template <typename Each>
void Problem::Curvature::sum(SparseMatrix& matrix, const Each& each) {
  constexpr std::size_t grain = 256;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, problem_.faces_.size(), grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t f = range.begin(); f < range.end(); ++f)
                        problem_.place(problem_.faces_[f], each(f), parts_);
                    });
  problem_.gather(parts_, matrix);
}

template <typename Each>
const Problem::SparseMatrix& Problem::Curvature::made(Part& part, const Each& each) {
  if (!part.known) {
    if (part.matrix.size() == 0) part.matrix = problem_.pattern();
    sum(part.matrix, each);
    part.known = true;
  }
  return part.matrix;
}

double Problem::Curvature::at(const VectorXd& x, VectorXd& first) {
  const std::vector<Face>& faces = problem_.faces_;
  std::vector<double> values(faces.size());
  std::vector<LocalVector> gradients(faces.size());
  nearest_.known = lift_.known = metric_.known = false;
  sum(exact_, [&](std::size_t f) -> const LocalMatrix& {
    states_[f] = problem_.local(faces[f], x);
    values[f] = faces[f].energy.hessian(states_[f], gradients[f], hessians_[f]);
    return hessians_[f];
  });
  first = VectorXd::Zero(problem_.size_);
  double energy = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    energy += values[f];
    problem_.add_gradient(faces[f], gradients[f], first);
  }
  return energy;
}

const Problem::SparseMatrix& Problem::Curvature::nearest() {
  return made(nearest_, [&](std::size_t f) { return nearest_lift(hessians_[f], problem_.scales()); });
}

const Problem::SparseMatrix& Problem::Curvature::lift() {
  return made(lift_, [&](std::size_t f) {
    LocalMatrix metric;
    problem_.faces_[f].energy.metric(states_[f], metric);
    return metric_lift(hessians_[f], metric, problem_.scales());
  });
}

const Problem::SparseMatrix& Problem::Curvature::metric() {
  return made(metric_, [&](std::size_t f) {
    LocalMatrix metric;
    problem_.faces_[f].energy.metric(states_[f], metric);
    return metric;
  });
}

double Problem::one_form_energy(const VectorXd& amplitude, const VectorXd& one_form, VectorXd& first) const {
  first = VectorXd::Zero(size_);
  double sum = 0;
  LocalVector x, gradient;
  for (const Face& face : faces_) {
    for (std::size_t i = 0; i < 3; ++i) x[static_cast<Index>(i)] = amplitude[topology_.faces[face.face][i]];
    const auto side = [&](std::size_t i) {
      return side_sign(topology_, face.face, i) * one_form[side_edge(topology_, face.face, i)];
    };
    x.tail<2>() = forms_[face.face].rest.gradients * Eigen::Vector3d(0, side(0), side(0) + side(1));
    sum += face.energy.gradient(x, gradient);
    add_gradient(face, gradient, first);
  }
  return sum;
}

VectorXd Problem::one_form(const Waves& waves) const {
  VectorXd result = VectorXd::Zero(static_cast<Index>(topology_.edges.size()));
  for (const Face& face : faces_) {
    const Eigen::Vector3d phase = complex_.corner_phases(face.face, waves.phase, waves.period);
    for (std::size_t i = 0; i < 3; ++i) {
      result[side_edge(topology_, face.face, i)] =
          side_sign(topology_, face.face, i) *
          (phase[static_cast<Index>((i + 1) % 3)] - phase[static_cast<Index>(i)]);
    }
  }
  return result;
}

}  // namespace plisse::wrinkle
