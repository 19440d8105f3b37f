#include "shell/potential.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "shell/energy_terms.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Corners, then the vertices across; for a missing one the corner itself, with rows 0.
std::array<std::uint32_t, 6> stencil(const Topology& topology, std::size_t face) {
  std::array<std::uint32_t, 6> vertices{};
  for (std::size_t i = 0; i < 3; ++i) {
    vertices[i] = topology.faces[face][i];
    vertices[3 + i] = topology.flaps[face][i] != none ? topology.flaps[face][i] : topology.faces[face][i];
  }
  return vertices;
}

Matrix3d convex_part(const Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(symmetric);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

// A term's elements: evaluated on all cores, summed in order on one, so that the sum is the same on any
// number of cores.
template <int Vertices>
class Elements {
 public:
  Elements(const ElementTerm<Vertices>& term, std::size_t count, bool forces)
      : term_(&term), energy_(count), gradient_(forces ? count : 0) {}

  void evaluate(std::uint32_t element, const Positions& x) {
    energy_[element] = term_->element(element, x, gradient_.empty() ? nullptr : &gradient_[element], nullptr,
                                      Curvature::exact);
  }
  // `vertices`: of the element.
  void sum(std::uint32_t element, const std::uint32_t* vertices, EnergySum& energy, ForceSum* forces) const {
    energy.count(energy_[element]);
    if (!forces) return;
    for (int k = 0; k < Vertices; ++k)
      forces->push(vertices[k], gradient_[element].template segment<3>(3 * k));
  }

 private:
  const ElementTerm<Vertices>* term_;
  std::vector<double> energy_;
  std::vector<typename ElementTerm<Vertices>::Gradient> gradient_;
};

template <int Vertices>
std::vector<Elements<Vertices>> elements_of(const std::vector<const ElementTerm<Vertices>*>& terms,
                                            std::size_t count, bool forces) {
  std::vector<Elements<Vertices>> all;
  for (const auto* term : terms) all.emplace_back(*term, count, forces);
  return all;
}

// The sum of the terms' Hessians of one element.
template <int Vertices>
void sum_hessians(const std::vector<const ElementTerm<Vertices>*>& terms, std::uint32_t element,
                  const Positions& x, Curvature curvature, typename ElementTerm<Vertices>::Hessian& sum) {
  if (terms.empty()) sum.setZero();
  for (std::size_t t = 0; t < terms.size(); ++t) {
    if (t == 0) {
      terms[t]->element(element, x, nullptr, &sum, curvature);
      continue;
    }
    typename ElementTerm<Vertices>::Hessian one;
    terms[t]->element(element, x, nullptr, &one, curvature);
    sum += one;
  }
}

// Pairs of vertices that some term's Hessian is of.
std::vector<BlockMatrix::Pair> pairs_of(const Topology& topology, const Potential::Terms& terms) {
  bool flaps = false;
  std::vector<BlockMatrix::Pair> pairs;
  for (const auto& term : terms) {
    flaps = flaps || dynamic_cast<const FlapTerm*>(term.get());
    const auto* shell = dynamic_cast<const ShellTerm*>(term.get());
    const auto* constant = shell ? shell->constant_hessian() : nullptr;
    for (int column = 0; constant && column < constant->outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator it(*constant, column); it; ++it)
        pairs.emplace_back(static_cast<std::uint32_t>(it.row()), static_cast<std::uint32_t>(column));
  }
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const auto vertices = stencil(topology, f);
    for (std::size_t k = 0; k < (flaps ? 6u : 3u); ++k)
      for (std::size_t l = 0; l <= k; ++l) pairs.emplace_back(vertices[k], vertices[l]);
  }
  return pairs;
}

}  // namespace

bool Potential::Run::take(const EnergyTerm& term) {
  const bool any = !vertices.empty() || !faces.empty() || !flaps.empty() || shell;
  if (const auto* one = dynamic_cast<const VertexTerm*>(&term); one && (!any || !vertices.empty())) {
    vertices.push_back(one);
    return true;
  }
  const bool on_faces = !faces.empty() || !flaps.empty();
  if (const auto* one = dynamic_cast<const FaceTerm*>(&term); one && (!any || on_faces)) {
    faces.push_back(one);
    return true;
  }
  if (const auto* one = dynamic_cast<const FlapTerm*>(&term); one && (!any || on_faces)) {
    flaps.push_back(one);
    return true;
  }
  if (const auto* one = dynamic_cast<const ShellTerm*>(&term); one && !any) {
    shell = one;
    return true;
  }
  return false;
}

Potential::Terms Potential::all_terms(const Shell& shell, const Conditions& conditions, const Loads& loads,
                                      const Vector3d& origin) {
  const Eigen::VectorXd areas = vertex_areas(shell.topology, shell.rest);
  Terms terms;
  for (MakeTerm* make : energy_terms)
    if (auto term = make({shell, conditions, loads, origin, areas})) terms.push_back(std::move(term));
  return terms;
}

Potential::Potential(const Shell& shell, const Conditions& conditions, const Loads& loads,
                     const Vector3d& origin)
    : Potential(shell, conditions, all_terms(shell, conditions, loads, origin)) {}

Potential::Potential(const Shell& shell, const Conditions& conditions, Terms terms)
    : topology_(shell.topology),
      terms_(std::move(terms)),
      matrix_(pairs_of(topology_, terms_), topology_, conditions),
      unknown_areas_(unknowns()) {
  for (const auto& term : terms_) {
    if (runs_.empty() || !runs_.back().take(*term)) runs_.emplace_back().take(*term);
    if (term->linear()) continue;
    if (const auto* one = dynamic_cast<const VertexTerm*>(term.get())) curved_vertices_.push_back(one);
    if (const auto* one = dynamic_cast<const FaceTerm*>(term.get())) curved_faces_.push_back(one);
    if (const auto* one = dynamic_cast<const FlapTerm*>(term.get())) curved_flaps_.push_back(one);
    if (const auto* one = dynamic_cast<const ShellTerm*>(term.get())) curved_shells_.push_back(one);
  }
  const Eigen::VectorXd areas = vertex_areas(topology_, shell.rest);
  for (Eigen::Index i = 0; i < unknowns(); ++i)
    unknown_areas_[i] = areas[matrix_.scalars()[static_cast<std::size_t>(i)] / 3];

  for (std::size_t f = 0; f < topology_.faces.size(); ++f) {
    const auto vertices = stencil(topology_, f);
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t l = 0; l <= k; ++l) {
        if (k < 3) face_blocks_.push_back(matrix_.block(vertices[k], vertices[l]));
        if (!curved_flaps_.empty()) flap_blocks_.push_back(matrix_.block(vertices[k], vertices[l]));
      }
  }
  for (const ShellTerm* term : curved_shells_) {
    const auto* constant = term->constant_hessian();
    for (int column = 0; constant && column < constant->outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator it(*constant, column); it; ++it) {
        const auto a = static_cast<std::uint32_t>(it.row()), b = static_cast<std::uint32_t>(column);
        if (a >= b) matrix_.add(matrix_.block(a, b), a, b, it.value() * Matrix3d::Identity());
      }
  }
  constant_ = matrix_.values();
}

double Potential::offset() const {
  double offset = 0;
  for (const auto& term : terms_) offset += term->offset();
  return offset;
}

void Potential::sum_run(const Run& run, const Positions& x, EnergySum& energy, ForceSum* forces) const {
  if (run.shell) return run.shell->add(x, energy, forces);
  const std::size_t count = run.vertices.empty() ? topology_.faces.size() : topology_.vertex_count;
  auto vertices = elements_of(run.vertices, count, forces);
  auto faces = elements_of(run.faces, count, forces);
  auto flaps = elements_of(run.flaps, count, forces);
  const auto there = [&](std::uint32_t element) {
    return run.vertices.empty() || topology_.component[element] != none;
  };
  tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(count), [&](std::uint32_t e) {
    if (!there(e)) return;
    for (auto& term : vertices) term.evaluate(e, x);
    for (auto& term : faces) term.evaluate(e, x);
    for (auto& term : flaps) term.evaluate(e, x);
  });
  for (std::uint32_t e = 0; e < count; ++e) {
    if (!there(e)) continue;
    for (const auto& term : vertices) term.sum(e, &e, energy, forces);
    if (faces.empty() && flaps.empty()) continue;
    const auto corners = stencil(topology_, e);
    for (const auto& term : faces) term.sum(e, corners.data(), energy, forces);
    for (const auto& term : flaps) term.sum(e, corners.data(), energy, forces);
  }
}

Potential::Value Potential::value(const Positions& x, Eigen::VectorXd* gradient) const {
  EnergySum energy;
  ForceSum forces;
  if (gradient) forces.force = forces.size = Positions::Zero(3, x.cols());
  for (const Run& run : runs_) sum_run(run, x, energy, gradient ? &forces : nullptr);
  Value value{energy.energy, 0, energy.summands, 0};
  for (const auto& term : terms_) value.friction += term->friction(x);
  if (!gradient) return value;
  gradient->resize(unknowns());
  for (Eigen::Index i = 0; i < unknowns(); ++i) {
    const std::uint32_t scalar = matrix_.scalars()[static_cast<std::size_t>(i)];
    (*gradient)[i] = forces.force.data()[scalar];
    value.force_scale = std::max(value.force_scale, forces.size.data()[scalar]);
  }
  return value;
}

std::vector<Potential::Part> Potential::parts(const Positions& x) const {
  std::vector<Part> parts;
  for (const auto& term : terms_) {
    EnergySum energy;
    Run alone;
    alone.take(*term);
    sum_run(alone, x, energy, nullptr);
    parts.push_back({std::string(term->name()), energy.energy});
  }
  return parts;
}

bool Potential::lags() const {
  return std::any_of(terms_.begin(), terms_.end(), [](const auto& term) { return term->lags(); });
}

void Potential::look_up(const Positions& x, bool first) {
  for (const auto& term : terms_) term->look_up(x, first);
}

std::vector<Positions> Potential::anchors(const Positions& x) const {
  std::vector<Positions> all;
  for (const auto& term : terms_)
    for (Positions& anchors : term->anchors(x)) all.push_back(std::move(anchors));
  return all;
}

template <int Vertices>
void Potential::scatter(std::size_t face, const Eigen::Matrix<double, 3 * Vertices, 3 * Vertices>& element,
                        const std::vector<std::uint32_t>& blocks) {
  constexpr std::size_t pairs = Vertices * (Vertices + 1) / 2;
  const auto vertices = stencil(topology_, face);
  std::size_t at = pairs * face;
  for (int k = 0; k < Vertices; ++k)
    for (int l = 0; l <= k; ++l, ++at) {
      const std::uint32_t a = vertices[static_cast<std::size_t>(k)],
                          b = vertices[static_cast<std::size_t>(l)];
      Matrix3d block = element.template block<3, 3>(3 * k, 3 * l);
      // One vertex across two edges (it has three triangles), or none across one, whose rows are 0.
      if (a == b && k != l) block += block.transpose().eval();
      matrix_.add(blocks[at], a, b, block);
    }
}

const Eigen::SparseMatrix<double>& Potential::hessian(const Positions& x, Curvature curvature) {
  const std::size_t faces = topology_.faces.size();
  matrix_.values() = constant_;

  // Elements on all cores, their sum in order on one; not all at once, since one with flaps has 3 kB.
  constexpr std::size_t batch = 2048;
  std::vector<Matrix9> corners(std::min(batch, faces));
  std::vector<Matrix18> flaps(curved_flaps_.empty() ? 0 : corners.size());
  for (std::size_t first = 0; first < faces; first += batch) {
    const std::size_t count = std::min(batch, faces - first);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
      const auto f = static_cast<std::uint32_t>(first + k);
      sum_hessians(curved_faces_, f, x, curvature, corners[k]);
      for (const ShellTerm* term : curved_shells_) term->add_face_hessian(f, x, curvature, corners[k]);
      if (!flaps.empty()) sum_hessians(curved_flaps_, f, x, curvature, flaps[k]);
    });
    for (std::size_t k = 0; k < count; ++k) {
      scatter<3>(first + k, corners[k], face_blocks_);
      if (!flaps.empty()) scatter<6>(first + k, flaps[k], flap_blocks_);
    }
  }
  if (curved_vertices_.empty()) return matrix_.lower();
  std::vector<Matrix3d> points(topology_.vertex_count);
  tbb::parallel_for(std::uint32_t{0}, topology_.vertex_count, [&](std::uint32_t v) {
    if (topology_.component[v] == none) return;
    sum_hessians(curved_vertices_, v, x, curvature, points[v]);
    if (curvature == Curvature::positive) points[v] = convex_part(points[v]);
  });
  for (std::uint32_t v = 0; v < topology_.vertex_count; ++v)
    if (topology_.component[v] != none) matrix_.add(matrix_.block(v, v), v, v, points[v]);
  return matrix_.lower();
}

void Potential::advance(Positions& x, const Eigen::VectorXd& direction, double step) const {
  for (Eigen::Index i = 0; i < unknowns(); ++i)
    x.data()[matrix_.scalars()[static_cast<std::size_t>(i)]] += step * direction[i];
}

double Potential::safe_step(const Positions& x, const Eigen::VectorXd& direction) const {
  Positions moved = Positions::Zero(3, x.cols());
  advance(moved, direction, 1);
  std::vector<double> steps(static_cast<std::size_t>(x.cols()), 1);
  tbb::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t v) {
    const auto column = static_cast<Eigen::Index>(v);
    for (const auto& term : terms_)
      steps[v] = std::min(steps[v], term->safe_share(x.col(column), x.col(column) + moved.col(column)));
  });
  return *std::min_element(steps.begin(), steps.end());
}

}  // namespace plisse::shell
