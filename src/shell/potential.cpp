#include "shell/potential.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>
#include <limits>

#include "shell/bending_quadratic.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Corners, then the vertices across; where there is none, the corner itself: its rows are 0.
std::array<std::uint32_t, 6> stencil(const Topology& topology, std::size_t face) {
  std::array<std::uint32_t, 6> vertices{};
  for (std::size_t i = 0; i < 3; ++i) {
    vertices[i] = topology.faces[face][i];
    vertices[3 + i] = topology.flaps[face][i] != none ? topology.flaps[face][i] : topology.faces[face][i];
  }
  return vertices;
}

Eigen::Matrix2d rest_form(const Shell& shell, std::size_t face) {
  return shell.rest_forms.empty() ? Eigen::Matrix2d::Zero().eval() : shell.rest_forms[face];
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return m;
}

Matrix3d convex_part(const Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(symmetric);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

// What a barrier must be able to carry: the pressures of the loads and of the sheet's own weight.
double contact_stiffness(const Shell& shell, const Loads& loads) {
  if (loads.contact_stiffness > 0) return loads.contact_stiffness;
  double area = 0, force = 0;
  for (const RestFace& face : shell.rest) area += face.area;
  for (Eigen::Index v = 0; v < loads.forces.cols(); ++v) force += loads.forces.col(v).norm();
  const Material& m = shell.material;
  const double pressure = std::abs(loads.pressure) + m.density * m.thickness * loads.gravity.norm() +
                          force / area + m.young * m.thickness * 1e-6 / std::sqrt(area);
  // |b'| is about 1.2 gap at half of the gap: there it carries some ten times what the loads ask for on
  // average.
  return 10 * pressure / (1.2 * loads.gap);
}

}  // namespace

Potential::Potential(const Shell& shell, const Conditions& conditions, const Loads& loads,
                     const Vector3d& origin)
    : shell_(shell),
      loads_(loads),
      law_{shell.material, shell.stretching, shell.residual},
      vertex_areas_(vertex_areas(shell.topology, shell.rest)),
      contact_(contact_stiffness(shell, loads)),
      origin_(origin),
      mirrors_(conditions.mirrors),
      mirrored_(shell.topology.faces.size(), {-1, -1, -1}),
      open_sides_(open_sides(shell.topology, conditions)),
      some_vertex_(shell.topology.component_count, none) {
  if (shell.bending == Bending::quadratic) {
    quadratic_ = bending_quadratic(shell.material, shell.topology, shell.rest);
    quadratic_sizes_ = quadratic_.cwiseAbs();
  }
  for (std::uint32_t v = 0; v < shell.topology.vertex_count; ++v) {
    const std::uint32_t part = shell.topology.component[v];
    if (part == none) continue;
    some_vertex_[part] = v;
    offset_ -= dead_force(v).dot(origin_);
  }
  for (std::size_t f = 0; f < mirrored_.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      if (shell.topology.flaps[f][i] != none) continue;
      const std::uint32_t a = shell.topology.faces[f][(i + 1) % 3], b = shell.topology.faces[f][(i + 2) % 3];
      for (std::size_t m = 0; m < mirrors_.size(); ++m) {
        const auto [axis, at] = mirrors_[m];
        const auto in_it = [&](std::uint32_t v) {
          return conditions.held(axis, v) && conditions.at(axis, v) == at;
        };
        if (in_it(a) && in_it(b)) mirrored_[f][i] = static_cast<std::int8_t>(m);
      }
    }
  number_unknowns(conditions);
  build_pattern();
}

Potential::Flap Potential::flap_of(std::size_t face, const Positions& x) const {
  const Topology& topology = shell_.topology;
  Flap flap;
  for (std::size_t i = 0; i < 3; ++i) {
    auto across = flap.across.col(static_cast<int>(i));
    flap.has[i] = topology.flaps[face][i] != none;
    if (flap.has[i]) {
      across = x.col(topology.flaps[face][i]);
    } else if (mirrored_[face][i] >= 0) {
      const auto [axis, at] = mirrors_[static_cast<std::size_t>(mirrored_[face][i])];
      flap.has[i] = true;
      across = x.col(topology.faces[face][i]);
      across[axis] = 2 * at - across[axis];
    }
  }
  return flap;
}

double Potential::midedge(std::size_t face, const Positions& x, Vector18* gradient, Matrix18* hessian,
                          Curvature curvature) const {
  const Flap flap = flap_of(face, x);
  const double energy = bending_midedge(shell_.material, shell_.rest[face], rest_form(shell_, face),
                                        corners_of(shell_.topology.faces[face], x), flap.across, flap.has,
                                        gradient, hessian, curvature);
  for (std::size_t i = 0; i < 3; ++i) {
    if (mirrored_[face][i] < 0) continue;
    const auto turned =
        static_cast<Eigen::Index>(9 + 3 * i) + mirrors_[static_cast<std::size_t>(mirrored_[face][i])].axis;
    if (gradient) (*gradient)[turned] *= -1;
    if (hessian) {
      hessian->row(turned) *= -1;
      hessian->col(turned) *= -1;
    }
  }
  return energy;
}

void Potential::number_unknowns(const Conditions& conditions) {
  const Topology& topology = shell_.topology;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const auto vertices = stencil(topology, f);
    const std::size_t count = shell_.bending == Bending::midedge ? 6 : 3;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t l = 0; l < count; ++l)
        entries.emplace_back(static_cast<int>(vertices[k]), static_cast<int>(vertices[l]), 1.0);
  }
  const auto vertex_count = static_cast<Eigen::Index>(topology.vertex_count);
  Eigen::SparseMatrix<double> graph(vertex_count, vertex_count);
  graph.setFromTriplets(entries.begin(), entries.end());
  if (quadratic_.size() > 0) graph += quadratic_;
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;  // new place → vertex
  Eigen::AMDOrdering<int>()(graph, order);
  place_.resize(topology.vertex_count);
  unknown_.assign(topology.vertex_count, {-1, -1, -1});
  for (std::uint32_t place = 0; place < topology.vertex_count; ++place) {
    const auto v = static_cast<std::uint32_t>(order.indices()[place]);
    place_[v] = place;
    if (topology.component[v] == none) continue;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      if (conditions.held(axis, v)) continue;
      unknown_[v][axis] = static_cast<std::int32_t>(scalar_.size());
      scalar_.push_back(3 * v + axis);
    }
  }
  unknown_areas_.resize(unknowns());
  for (std::size_t i = 0; i < scalar_.size(); ++i)
    unknown_areas_[static_cast<Eigen::Index>(i)] = vertex_areas_[scalar_[i] / 3];
}

void Potential::build_pattern() {
  const Topology& topology = shell_.topology;
  const bool flaps = shell_.bending == Bending::midedge;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // (column, row), places
  const auto want = [&](std::uint32_t a, std::uint32_t b) {
    pairs.emplace_back(std::min(place_[a], place_[b]), std::max(place_[a], place_[b]));
  };
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const auto vertices = stencil(topology, f);
    for (std::size_t k = 0; k < (flaps ? 6u : 3u); ++k)
      for (std::size_t l = 0; l <= k; ++l) want(vertices[k], vertices[l]);
  }
  for (int column = 0; column < quadratic_.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(quadratic_, column); it; ++it)
      if (it.row() >= column) want(static_cast<std::uint32_t>(it.row()), static_cast<std::uint32_t>(column));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

  std::vector<std::uint32_t> vertex_at(topology.vertex_count);
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v) vertex_at[place_[v]] = v;
  first_block_.assign(topology.vertex_count + 1, 0);
  blocks_.resize(pairs.size());
  for (std::size_t b = 0; b < pairs.size(); ++b) {
    blocks_[b] = {pairs[b].second, pairs[b].first, {-1, -1, -1, -1, -1, -1, -1, -1, -1}};
    ++first_block_[pairs[b].first + 1];
  }
  for (std::size_t c = 0; c < topology.vertex_count; ++c) first_block_[c + 1] += first_block_[c];

  std::vector<int> outer(scalar_.size() + 1, 0), inner;
  std::int32_t slot = 0;
  std::size_t column_unknown = 0;
  for (std::uint32_t column = 0; column < topology.vertex_count; ++column)
    for (std::size_t c = 0; c < 3; ++c) {
      if (unknown_[vertex_at[column]][c] < 0) continue;
      for (std::uint32_t b = first_block_[column]; b < first_block_[column + 1]; ++b)
        for (std::size_t r = 0; r < 3; ++r) {
          const std::int32_t row = unknown_[vertex_at[blocks_[b].row]][r];
          if (row < unknown_[vertex_at[column]][c]) continue;  // held, or in the upper half
          blocks_[b].slot[3 * r + c] = slot++;
          inner.push_back(row);
        }
      outer[++column_unknown] = slot;
    }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(slot);
  matrix_ = Eigen::Map<const Eigen::SparseMatrix<double>>(unknowns(), unknowns(), slot, outer.data(),
                                                          inner.data(), zero.data());

  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const auto vertices = stencil(topology, f);
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t l = 0; l <= k; ++l) {
        if (k < 3) face_blocks_.push_back(block_of(vertices[k], vertices[l]));
        if (flaps) flap_blocks_.push_back(block_of(vertices[k], vertices[l]));
      }
  }
  constant_ = Eigen::VectorXd::Zero(slot);
  for (int column = 0; column < quadratic_.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(quadratic_, column); it; ++it) {
      if (it.row() < column) continue;
      const Block& block =
          blocks_[block_of(static_cast<std::uint32_t>(it.row()), static_cast<std::uint32_t>(column))];
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (block.slot[4 * axis] >= 0) constant_[block.slot[4 * axis]] += it.value();
    }
}

std::uint32_t Potential::block_of(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t column = std::min(place_[a], place_[b]), row = std::max(place_[a], place_[b]);
  const auto first = blocks_.begin() + first_block_[column],
             last = blocks_.begin() + first_block_[column + 1];
  return static_cast<std::uint32_t>(
      std::lower_bound(first, last, row, [](const Block& block, std::uint32_t r) { return block.row < r; }) -
      blocks_.begin());
}

void Potential::add(std::uint32_t block, const Matrix3d& values, bool turned) {
  double* into = matrix_.valuePtr();
  const auto& slot = blocks_[block].slot;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const std::int32_t at = slot[static_cast<std::size_t>(3 * r + c)];
      if (at >= 0) into[at] += turned ? values(c, r) : values(r, c);
    }
}

Contact Potential::contact_at(std::uint32_t vertex, const Vector3d& x, bool curvature) const {
  Contact sum;
  const double stiffness = contact_ * vertex_areas_[vertex];
  for (const Obstacle& obstacle : loads_.obstacles) {
    const Contact one = contact(obstacle, x, loads_.gap, curvature);
    sum.value += stiffness * one.value;
    sum.first += stiffness * one.first;
    sum.second += stiffness * one.second;
  }
  return sum;
}

std::vector<Contact> Potential::contacts(const Positions& x, bool curvature) const {
  const std::uint32_t count = shell_.topology.vertex_count;
  std::vector<Contact> all(loads_.obstacles.empty() ? 0 : count);
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t v) {
    const auto vertex = static_cast<std::uint32_t>(v);
    if (shell_.topology.component[v] != none) all[v] = contact_at(vertex, x.col(vertex), curvature);
  });
  for (const Grip& grip : grips_) {
    const Contact rub = friction(grip, x.col(grip.vertex), loads_.friction, loads_.slip_length());
    all[grip.vertex].value += rub.value;
    all[grip.vertex].first += rub.first;
    all[grip.vertex].second += rub.second;
  }
  return all;
}

void Potential::grip(const Positions& x, bool first) {
  std::vector<Grip> grips;
  auto old = grips_.begin();
  for (std::uint32_t v = 0; v < shell_.topology.vertex_count; ++v) {
    if (shell_.topology.component[v] == none) continue;
    const double stiffness = contact_ * vertex_areas_[v];
    for (std::uint32_t o = 0; o < loads_.obstacles.size(); ++o) {
      while (old != grips_.end() && std::pair(old->vertex, old->obstacle) < std::pair(v, o)) ++old;
      const Vector3d push = -stiffness * contact(loads_.obstacles[o], x.col(v), loads_.gap, false).first;
      const double force = push.norm();
      if (!(force > 0)) continue;
      Grip grip{v, o, x.col(v), push / force, force};
      if (old != grips_.end() && old->vertex == v && old->obstacle == o) {
        grip.anchor = old->anchor;
      } else if (first && !loads_.anchors.empty() && loads_.anchors[o].col(v).allFinite()) {
        grip.anchor = loads_.anchors[o].col(v);
      }
      grips.push_back(grip);
    }
  }
  grips_ = std::move(grips);
}

std::vector<Positions> Potential::anchors(const Positions& x) const {
  // What touches nothing sticks to nothing.
  std::vector<Positions> anchors(loads_.obstacles.size(),
                                 Positions::Constant(3, x.cols(), std::numeric_limits<double>::quiet_NaN()));
  const double slip = loads_.slip_length();
  for (const Grip& grip : grips_) {
    const Vector3d from = x.col(grip.vertex) - grip.anchor;
    const Vector3d way = from - grip.normal.dot(from) * grip.normal;
    const double length = way.norm();
    anchors[grip.obstacle].col(grip.vertex) =
        x.col(grip.vertex) - (length > slip ? Vector3d(slip / length * way) : way);
  }
  return anchors;
}

Vector3d Potential::dead_force(std::uint32_t vertex) const {
  Vector3d force =
      shell_.material.density * shell_.material.thickness * vertex_areas_[vertex] * loads_.gravity;
  if (loads_.forces.size() > 0) force += loads_.forces.col(vertex);
  return force;
}

Vector3d Potential::apex(std::uint32_t part, const Positions& x) const {
  return open_sides_[part].open ? open_sides_[part].apex : Vector3d(x.col(some_vertex_[part]));
}

double Potential::pressure_energy(const Positions& x, Positions* sum, Positions* size) const {
  const Topology& topology = shell_.topology;
  double volume = 0;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const Face& face = topology.faces[f];
    const Vector3d from = apex(topology.component[face[0]], x);
    const Corners corners = corners_of(face, x).colwise() - from;
    volume += corners.col(0).dot(corners.col(1).cross(corners.col(2))) / 6;
    if (!sum) continue;
    const Vector3d area = 0.5 * (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
    for (int k = 0; k < 3; ++k) {
      sum->col(face[static_cast<std::size_t>(k)]) -= loads_.pressure / 3 * area;
      size->col(face[static_cast<std::size_t>(k)]) += (loads_.pressure / 3 * area).cwiseAbs();
      if (topology.flaps[f][static_cast<std::size_t>(k)] != none) continue;
      const int a = (k + 1) % 3, b = (k + 2) % 3;  // the boundary edge runs from a to b
      const Vector3d side = loads_.pressure / 6 * corners.col(a).cross(corners.col(b));
      sum->col(face[static_cast<std::size_t>(a)]) += side;
      sum->col(face[static_cast<std::size_t>(b)]) += side;
    }
  }
  return -loads_.pressure * volume;
}

Potential::Value Potential::value(const Positions& x, Eigen::VectorXd* gradient) const {
  const Topology& topology = shell_.topology;
  const std::size_t faces = topology.faces.size();
  std::vector<double> stretch(faces), bend(shell_.bending == Bending::midedge ? faces : 0);
  std::vector<Vector9> stretch_force(gradient ? faces : 0);
  std::vector<Vector18> bend_force(gradient ? bend.size() : 0);
  tbb::parallel_for(std::size_t{0}, faces, [&](std::size_t f) {
    const Corners corners = corners_of(topology.faces[f], x);
    stretch[f] = stretching(law_, shell_.rest[f], corners, gradient ? &stretch_force[f] : nullptr);
    if (!bend.empty())
      bend[f] = midedge(f, x, gradient ? &bend_force[f] : nullptr, nullptr, Curvature::exact);
  });

  Value value;
  const auto count = [&](double part) {
    value.energy += part;
    value.terms += std::abs(part);
  };
  Positions sum, size;  // forces, and their absolute values
  if (gradient) sum = size = Positions::Zero(3, x.cols());
  const auto push = [&](std::uint32_t v, const Vector3d& force) {
    sum.col(v) += force;
    size.col(v) += force.cwiseAbs();
  };
  for (std::size_t f = 0; f < faces; ++f) {
    count(stretch[f]);
    if (!bend.empty()) count(bend[f]);
    if (!gradient) continue;
    const auto vertices = stencil(topology, f);
    for (int k = 0; k < 3; ++k)
      push(vertices[static_cast<std::size_t>(k)], stretch_force[f].segment<3>(3 * k));
    if (!bend.empty())
      for (int k = 0; k < 6; ++k)
        push(vertices[static_cast<std::size_t>(k)], bend_force[f].segment<3>(3 * k));
  }
  if (quadratic_.size() > 0)
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd u = x.row(axis).transpose().array() - origin_[axis], force = quadratic_ * u;
      value.energy += 0.5 * u.dot(force);
      // Almost all of its summands cancel; what rounding leaves of them does not.
      value.terms += 0.5 * u.cwiseAbs().dot(quadratic_sizes_ * u.cwiseAbs());
      if (!gradient) continue;
      sum.row(axis) += force.transpose();
      size.row(axis) += force.cwiseAbs().transpose();
    }
  const std::vector<Contact> touching = contacts(x, false);
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v) {
    if (topology.component[v] == none) continue;
    const Vector3d force = dead_force(v);
    count(-force.dot(x.col(v) - origin_));
    if (gradient) push(v, -force);
    if (touching.empty()) continue;
    count(touching[v].value);
    if (gradient) push(v, touching[v].first);
  }
  for (const Grip& grip : grips_)
    value.friction += friction(grip, x.col(grip.vertex), loads_.friction, loads_.slip_length()).value;
  if (loads_.pressure != 0) count(pressure_energy(x, gradient ? &sum : nullptr, &size));
  if (gradient) {
    gradient->resize(unknowns());
    for (std::size_t i = 0; i < scalar_.size(); ++i) {
      const std::uint32_t v = scalar_[i] / 3, axis = scalar_[i] % 3;
      (*gradient)[static_cast<Eigen::Index>(i)] = sum(axis, v);
      value.force_scale = std::max(value.force_scale, size(axis, v));
    }
  }
  return value;
}

template <int Vertices>
void Potential::scatter(std::size_t face, const Eigen::Matrix<double, 3 * Vertices, 3 * Vertices>& element,
                        const std::vector<std::uint32_t>& blocks) {
  constexpr std::size_t pairs = Vertices * (Vertices + 1) / 2;
  const auto vertices = stencil(shell_.topology, face);
  std::size_t at = pairs * face;
  for (int k = 0; k < Vertices; ++k)
    for (int l = 0; l <= k; ++l, ++at) {
      const std::uint32_t a = vertices[static_cast<std::size_t>(k)],
                          b = vertices[static_cast<std::size_t>(l)];
      Matrix3d block = element.template block<3, 3>(3 * k, 3 * l);
      // One vertex across two edges (it has three triangles), or none across one, whose rows are 0.
      if (a == b && k != l) block += block.transpose().eval();
      add(blocks[at], block, place_[a] < place_[b]);
    }
}

const Eigen::SparseMatrix<double>& Potential::hessian(const Positions& x, Curvature curvature) {
  const Topology& topology = shell_.topology;
  const std::size_t faces = topology.faces.size();
  Eigen::Map<Eigen::VectorXd>(matrix_.valuePtr(), matrix_.nonZeros()) = constant_;

  // Elements on all cores, their sum in order on one, so that it is the same on any number of cores; not all
  // at once, since one with flaps has 3 kB.
  constexpr std::size_t batch = 2048;
  std::vector<Matrix9> stretch(std::min(batch, faces));
  std::vector<Matrix18> bend(shell_.bending == Bending::midedge ? stretch.size() : 0);
  for (std::size_t first = 0; first < faces; first += batch) {
    const std::size_t count = std::min(batch, faces - first);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
      const std::size_t f = first + k;
      stretch[k] = stretching_hessian(f, x, curvature);
      if (!bend.empty()) midedge(f, x, nullptr, &bend[k], curvature);
    });
    for (std::size_t k = 0; k < count; ++k) {
      scatter<3>(first + k, stretch[k], face_blocks_);
      if (!bend.empty()) scatter<6>(first + k, bend[k], flap_blocks_);
    }
  }
  const std::vector<Contact> touching = contacts(x, true);
  for (std::uint32_t v = 0; v < touching.size(); ++v)
    if (topology.component[v] != none)
      add(block_of(v, v),
          curvature == Curvature::exact ? touching[v].second : convex_part(touching[v].second), false);
  return matrix_;
}

Matrix9 Potential::stretching_hessian(std::size_t face, const Positions& x, Curvature curvature) const {
  const Topology& topology = shell_.topology;
  const Corners corners = corners_of(topology.faces[face], x);
  Matrix9 hessian;
  stretching(law_, shell_.rest[face], corners, nullptr, &hessian, curvature);
  if (curvature == Curvature::positive || loads_.pressure == 0) return hessian;
  // −p V, V trilinear: the block of corners k and k + 1 is −p/6 times the cross product's with corner k + 2.
  const Vector3d from = apex(topology.component[topology.faces[face][0]], x);
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const Matrix3d block = -loads_.pressure / 6 * cross_matrix(corners.col(last) - from);
    hessian.block<3, 3>(3 * k, 3 * next) -= block;
    hessian.block<3, 3>(3 * next, 3 * k) += block;
  }
  return hessian;
}

void Potential::advance(Positions& x, const Eigen::VectorXd& direction, double step) const {
  for (std::size_t i = 0; i < scalar_.size(); ++i)
    x.data()[scalar_[i]] += step * direction[static_cast<Eigen::Index>(i)];
}

double Potential::safe_step(const Positions& x, const Eigen::VectorXd& direction) const {
  if (loads_.obstacles.empty()) return 1;
  Positions moved = Positions::Zero(3, x.cols());
  advance(moved, direction, 1);
  std::vector<double> steps(static_cast<std::size_t>(x.cols()), 1);
  tbb::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t v) {
    const auto column = static_cast<Eigen::Index>(v);
    for (const Obstacle& obstacle : loads_.obstacles)
      steps[v] = std::min(steps[v], free_way(obstacle, x.col(column), x.col(column) + moved.col(column)));
  });
  return *std::min_element(steps.begin(), steps.end());
}

}  // namespace plisse::shell
