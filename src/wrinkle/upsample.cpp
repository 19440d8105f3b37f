#include "wrinkle/upsample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "base/eigen_glm.h"
#include "base/error.h"
#include "mesh/corner_field.h"
#include "mesh/loop.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using std::numbers::pi;

void check(const BaseSurface& surface, const CoarseField& field) {
  const auto vertices = static_cast<Index>(surface.topology.vertex_count);
  if (field.amplitude.size() != vertices || field.phase.size() != surface.topology.faces.size() ||
      surface.positions.cols() != vertices)
    throw Error(
        ExitCode::bad_input,
        fmt::format("a field of {} vertices and {} faces on a surface of {} and {}", field.amplitude.size(),
                    field.phase.size(), vertices, surface.topology.faces.size()));
  bool finite = field.amplitude.allFinite() && surface.positions.allFinite();
  for (const auto& p : field.phase) finite = finite && std::isfinite(p[0] + p[1] + p[2]);
  if (!finite) throw Error(ExitCode::bad_input, "the wrinkle field or its surface is not finite");
}

// Vertices of the outline where its rest shape turns.
std::vector<std::uint32_t> sharp_corners(const shell::Topology& topology,
                                         const std::vector<shell::RestFace>& rest) {
  std::vector<double> angle(topology.vertex_count, 0);
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const Eigen::Matrix2d& e = rest[f].edges;
    const std::array<Eigen::Vector2d, 3> x{Eigen::Vector2d(0, 0), e.col(0), e.col(1)};
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector2d a = x[(c + 1) % 3] - x[c], b = x[(c + 2) % 3] - x[c];
      angle[topology.faces[f][c]] += std::atan2(std::abs(a.x() * b.y() - a.y() * b.x()), a.dot(b));
    }
  }
  std::vector<bool> outline(topology.vertex_count, false);
  for (const shell::Edge& edge : topology.edges) {
    if (edge.boundary()) outline[edge.vertex[0]] = outline[edge.vertex[1]] = true;
  }
  std::vector<std::uint32_t> sharp;
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v) {
    if (outline[v] && std::abs(angle[v] - pi) > pi / 3) sharp.push_back(v);
  }
  return sharp;
}

std::array<CornerField, 2> uv_fields(const LoopLevel& level,
                                     const std::vector<std::array<Eigen::Vector2d, 3>>& uv) {
  const auto axis = [&](Index i) {
    std::vector<std::array<double, 3>> values;
    for (const auto& corner : uv) values.push_back({corner[0][i], corner[1][i], corner[2][i]});
    return CornerField(level, std::move(values), std::vector<bool>(uv.size(), true), 0);
  };
  return {axis(0), axis(1)};
}

}  // namespace

FineField upsample(const BaseSurface& surface, const CoarseField& field, int levels, const Extras& extras) {
  check(surface, field);
  const LoopSubdivision loop = subdivide_loop(surface.topology.faces, surface.topology.vertex_count, levels,
                                              sharp_corners(surface.topology, surface.rest));
  std::vector<bool> waves;
  for (const shell::Face& t : surface.topology.faces)
    waves.push_back(field.amplitude[t[0]] > 0 || field.amplitude[t[1]] > 0 || field.amplitude[t[2]] > 0);
  std::vector<double> amplitude(field.amplitude.begin(), field.amplitude.end());
  std::vector<glm::dvec3> positions = points_to_glm(surface.positions), lean = points_to_glm(extras.lean);
  CornerField phase(loop.levels.front(), field.phase, waves, 2 * pi, amplitude);
  std::vector<CornerField> uv;
  if (!extras.uv.empty()) {
    for (CornerField& axis : uv_fields(loop.levels.front(), extras.uv)) uv.push_back(std::move(axis));
  }
  for (std::size_t l = 1; l < loop.levels.size(); ++l) {
    const LoopLevel &coarse = loop.levels[l - 1], &fine = loop.levels[l];
    phase = phase.refined(coarse, fine, positions);
    for (CornerField& axis : uv) axis = axis.refined(coarse, fine, positions);
    positions = applied(fine.masks, positions);
    if (!lean.empty()) lean = applied(fine.masks, lean);
    amplitude = applied(fine.masks, amplitude);
    shut(amplitude, fine, phase);
  }

  const LoopLevel& last = loop.levels.back();
  FineField result;
  result.faces.assign(last.faces.begin(), last.faces.end());
  result.base_face.resize(last.faces.size());
  for (std::size_t f = 0; f < last.faces.size(); ++f) {
    std::uint32_t at = static_cast<std::uint32_t>(f);
    for (std::size_t l = loop.levels.size() - 1; l > 0; --l) at = loop.levels[l].parent[at];
    result.base_face[f] = at;
  }
  const std::array<std::vector<glm::dvec3>, 2> tangents{applied(loop.tangents[0], positions),
                                                        applied(loop.tangents[1], positions)};
  result.positions = points_to_eigen(applied(loop.limit, positions));
  if (!lean.empty()) result.lean = points_to_eigen(applied(loop.limit, lean));
  amplitude = applied(loop.limit, amplitude);
  shut(amplitude, last, phase);
  result.amplitude =
      Eigen::Map<const Eigen::VectorXd>(amplitude.data(), static_cast<Index>(amplitude.size()));

  // Where tangents are undefined (at some sharp corners, on collapsed faces), the faces' own normal is used.
  result.normals = vertex_normals(result.faces, result.positions);
  result.phase = Eigen::VectorXd::Zero(result.positions.cols());
  result.gradient = Eigen::Matrix3Xd::Zero(3, result.positions.cols());
  const auto limits = phase.limits(loop, positions);
  std::vector<bool> done(last.vertex_count, false);
  for (std::size_t f = 0; f < last.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = last.faces[f][c];
      if (done[v]) continue;
      const glm::dvec3 t = tangents[0][v], u = tangents[1][v], n = glm::cross(t, u);
      const double area = glm::length(n);
      const bool spans = span(t, u);
      const auto column = static_cast<Index>(v);
      if (spans) result.normals.col(column) << n.x / area, n.y / area, n.z / area;
      if (!phase.known()[f] || !(amplitude[v] > 0)) continue;
      done[v] = true;
      const CornerField::Limit& limit = limits[f][c];
      result.phase[column] = limit.value;
      if (!spans) continue;
      const glm::dvec3 g = gradient(t, u, limit);
      result.gradient.col(column) << g.x, g.y, g.z;
    }
  }
  if (!uv.empty()) {
    const auto u = uv[0].limits(loop, positions), v = uv[1].limits(loop, positions);
    for (std::size_t f = 0; f < last.faces.size(); ++f) {
      auto& corners = result.uv.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) corners[c] = {u[f][c].value, v[f][c].value};
    }
  }
  if (!result.positions.allFinite() || !result.amplitude.allFinite() || !result.gradient.allFinite())
    throw Error(ExitCode::check_failed, "the up-sampled field is not finite");
  return result;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> limit_points(const shell::Topology& topology,
                                                          const std::vector<shell::RestFace>& rest,
                                                          int levels) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const LoopSubdivision loop =
      subdivide_loop(topology.faces, topology.vertex_count, levels, sharp_corners(topology, rest));
  const auto matrix = [](const Rows<LoopWeight>& rows, Index columns) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t v = 0; v + 1 < rows.offsets.size(); ++v)
      for (std::uint32_t i = rows.offsets[v]; i < rows.offsets[v + 1]; ++i)
        entries.emplace_back(static_cast<int>(v), static_cast<int>(rows.items[i].vertex),
                             rows.items[i].weight);
    Matrix result(static_cast<Index>(rows.offsets.size()) - 1, columns);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  };
  Matrix all(static_cast<Index>(topology.vertex_count), static_cast<Index>(topology.vertex_count));
  all.setIdentity();
  for (std::size_t l = 1; l < loop.levels.size(); ++l)
    all = Matrix(matrix(loop.levels[l].masks, all.rows()) * all);
  return matrix(loop.limit, all.rows()) * all;
}

Eigen::Matrix3Xd leaning(const BaseSurface& surface, const std::vector<FaceForms>& forms, double poisson,
                         const CoarseField& field) {
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, surface.positions.cols());
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(surface.positions.cols());
  for (std::size_t f = 0; f < forms.size(); ++f) {
    const shell::Face& t = surface.topology.faces[f];
    const auto& gradients = forms[f].rest.gradients;
    const Eigen::Vector2d w = gradients * Vector3d(field.phase[f][0], field.phase[f][1], field.phase[f][2]);
    const double squared = w.squaredNorm(),
                 a = (field.amplitude[t[0]] + field.amplitude[t[1]] + field.amplitude[t[2]]) / 3;
    if (!(squared > 0) || !(a > 0)) continue;
    // α/(α + 2β) = ν, 2β/(α + 2β) = 1 − ν; I_u is the identity here.
    const Eigen::Vector2d across(-w.y(), w.x());
    const Eigen::Matrix2d& second = forms[f].second_form;
    const Eigen::Vector2d v =
        (poisson * second.trace() / squared + (1 - poisson) * w.dot(second * w) / (squared * squared)) * w +
        2 * w.dot(second * across) / (squared * squared) * across;
    Eigen::Matrix3d x;
    for (Index c = 0; c < 3; ++c) x.col(c) = surface.positions.col(t[static_cast<std::size_t>(c)]);
    const Eigen::Matrix<double, 3, 2> frame = x * gradients.transpose();
    const Eigen::Matrix2d first = frame.transpose() * frame;
    if (!(std::abs(first.determinant()) > 1e-12 * first.squaredNorm())) continue;  // collapsed: undefined
    const double weight = forms[f].rest.area * a * a;
    for (const std::uint32_t vertex : t) {
      sum.col(vertex) += weight * (frame * first.inverse() * v);
      weights[vertex] += weight;
    }
  }
  for (Index v = 0; v < sum.cols(); ++v) {
    if (weights[v] > 0) sum.col(v) /= weights[v];
  }
  return sum;
}

// With the ⅛ of v₂ the strain is constant along a wave, but beyond a slope of 2 points along it would pass
// each other: d(x + c s² sin 2φ/k)/dx = 1 + 2 c s² cos 2φ is below 0 at the flanks where c > 1/(2s²).
double tangential_shift(double slope) {
  return slope > 2 ? 0.5 / (slope * slope) : 0.125;
}

shell::Positions displaced(const FineField& field, bool with_v2) {
  shell::Positions result = field.positions;
  for (Index v = 0; v < result.cols(); ++v) {
    const double a = field.amplitude[v], phase = field.phase[v];
    if (!(a > 0)) continue;
    const double slope = a * field.gradient.col(v).norm();
    result.col(v) += a * std::cos(phase) * field.normals.col(v);
    if (with_v2)
      result.col(v) += tangential_shift(slope) * std::sin(2 * phase) * a * a * field.gradient.col(v);
    if (field.lean.cols() > 0) result.col(v) += a * std::sin(phase) * field.lean.col(v);
  }
  return result;
}

Eigen::Matrix3Xd vertex_normals(const std::vector<shell::Face>& faces, const shell::Positions& positions) {
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, positions.cols());
  for (const shell::Face& t : faces) {
    const Vector3d a = positions.col(t[0]);
    const Vector3d normal = (Vector3d(positions.col(t[1])) - a).cross(Vector3d(positions.col(t[2])) - a);
    for (const std::uint32_t v : t) normals.col(v) += normal;
  }
  for (Index v = 0; v < normals.cols(); ++v) {
    const double length = normals.col(v).norm();
    normals.col(v) = length > 0 ? Vector3d(normals.col(v) / length) : Vector3d(0, 1, 0);
  }
  return normals;
}

double largest_step(const BaseSurface& surface, const CoarseField& field) {
  const double least = field.amplitude.size() > 0 ? 0.01 * field.amplitude.maxCoeff() : 0;
  double most = 0;
  for (std::size_t f = 0; f < field.phase.size(); ++f) {
    const shell::Face& t = surface.topology.faces[f];
    for (std::size_t s = 0; s < 3; ++s) {
      if (std::max(field.amplitude[t[s]], field.amplitude[t[(s + 1) % 3]]) > least)
        most = std::max(most, std::abs(field.phase[f][(s + 1) % 3] - field.phase[f][s]));
    }
  }
  return most;
}

}  // namespace plisse::wrinkle
