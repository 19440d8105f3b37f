#include "cloth/keep_outside.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/weighted_median.h"
#include "wrinkle/local_waves.h"
#include "wrinkle/upsample.h"
#include "wrinkle/wrinkle_free.h"

namespace plisse::cloth {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// The nearest of the bodies.
shell::Distance distance_from(const Bodies& bodies, const Vector3d& point) {
  shell::Distance nearest = bodies.front()->distance(point);
  for (std::size_t b = 1; b < bodies.size(); ++b)
    if (const shell::Distance other = bodies[b]->distance(point); other.value < nearest.value)
      nearest = other;
  return nearest;
}

// Of a point that has to be away from a body by `least`: the plane of its nearest point there.
shell::HalfSpace half_space(const Bodies& bodies, const Vector3d& point, double least) {
  const shell::Distance here = distance_from(bodies, point);
  const Vector3d normal = here.first.normalized(), on_body = point - here.value * normal;
  return {{}, normal, normal.dot(on_body) + least};
}

}  // namespace

ShellPoints::ShellPoints(const shell::Topology& topology, const std::vector<shell::RestFace>& rest) {
  constexpr int levels = 1;
  std::vector<Eigen::Triplet<double>> entries;
  int row = 0;
  const auto add = [&](std::initializer_list<std::uint32_t> vertices) {
    for (const std::uint32_t v : vertices)
      entries.emplace_back(row, static_cast<int>(v), 1.0 / static_cast<double>(vertices.size()));
    ++row;
  };
  std::vector<bool> used(topology.vertex_count, false);
  for (const shell::Face& face : topology.faces)
    for (const std::uint32_t v : face) used[v] = true;
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v)
    if (used[v]) add({v});
  for (const shell::Edge& edge : topology.edges) add({edge.vertex[0], edge.vertex[1]});
  try {
    const Eigen::SparseMatrix<double, Eigen::RowMajor> limit = wrinkle::limit_points(topology, rest, levels);
    for (Index k = 0; k < limit.rows(); ++k, ++row)
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(limit, k); it; ++it)
        entries.emplace_back(row, static_cast<int>(it.col()), it.value());
  } catch (const Error& error) {
    // Such surfaces are not drawn smooth either.
    log::info(error.what());
  }
  weights_.resize(row, topology.vertex_count);
  weights_.setFromTriplets(entries.begin(), entries.end());
}

Eigen::Matrix3Xd ShellPoints::at(const shell::Positions& vertices) const {
  return (weights_ * vertices.transpose()).transpose();
}

Eigen::VectorXd ShellPoints::at(const Eigen::VectorXd& values) const {
  return weights_ * values;
}

std::vector<std::pair<std::uint32_t, double>> ShellPoints::of(Index point) const {
  std::vector<std::pair<std::uint32_t, double>> result;
  for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(weights_, point); it; ++it)
    result.emplace_back(static_cast<std::uint32_t>(it.col()), it.value());
  return result;
}

Clearance::Clearance(const ShellPoints& points, const shell::Positions& pose, const Bodies& bodies)
    : places(points.at(pose)), distance(static_cast<std::size_t>(points.count())) {
  tbb::parallel_for(std::size_t{0}, distance.size(), [&](std::size_t k) {
    distance[k] = distance_from(bodies, places.col(static_cast<Index>(k))).value;
  });
}

KeptOutside follow_outside(const shell::Follower& follower, const ShellPoints& points,
                           const shell::Positions& pose, const Clearance& clearance, const Bodies& bodies,
                           double gap, const Eigen::VectorXd& lift) {
  constexpr int most_rounds = 6;
  // What the follower lets in, and as much again.
  const double slack = std::max(0.25 * gap, 2e-4 * follower.wavelength());
  Eigen::VectorXd least = Eigen::VectorXd::Constant(points.count(), gap);
  least.head(lift.size()) += lift;  // vertices come first; what is between them follows
  KeptOutside result;
  result.followed = follower.follow(pose);
  std::vector<shell::HalfSpace> walls;
  std::vector<char> has_own(static_cast<std::size_t>(points.count()), 0);
  std::vector<double> distance(has_own.size());
  for (int round = 0; round <= most_rounds && !interrupted(); ++round) {
    const Eigen::Matrix3Xd here = points.at(result.followed.base);
    tbb::parallel_for(std::size_t{0}, distance.size(), [&](std::size_t k) {
      const auto point = static_cast<Index>(k);
      distance[k] = clearance.least(point, here.col(point));
      if (distance[k] < least[point]) distance[k] = distance_from(bodies, here.col(point)).value;
    });
    result.outside = true;
    const std::size_t before = walls.size();
    for (std::size_t k = 0; k < distance.size(); ++k) {
      const auto point = static_cast<Index>(k);
      if (distance[k] >= least[point] - slack) continue;
      const auto of = points.of(point);
      if (std::ranges::none_of(of, [&](const auto& part) { return follower.moves(part.first); })) continue;
      result.outside = false;
      if (round == most_rounds) continue;
      shell::HalfSpace wall =
          half_space(bodies, has_own[k] ? here.col(point) : clearance.places.col(point), least[point]);
      // The pose's own plane may be far from where the point has gone.
      if (!has_own[k] && wall.normal.dot(here.col(point)) > wall.least - slack)
        wall = half_space(bodies, here.col(point), least[point]);
      has_own[k] = 1;
      wall.of = of;
      walls.push_back(std::move(wall));
    }
    if (walls.size() == before) break;
    const shell::Positions start = result.followed.base;
    result.followed = follower.follow(pose, &start, walls);
    if (!result.followed.converged) break;  // more walls leave less way
  }
  return result;
}

std::vector<double> room_of(const ShellPoints& points, const Clearance& clearance,
                            const shell::Positions& base, const Bodies& bodies, double reach,
                            double& nearest) {
  const Eigen::Matrix3Xd here = points.at(base);
  std::vector<double> distance(static_cast<std::size_t>(points.count()), INFINITY);
  tbb::parallel_for(std::size_t{0}, distance.size(), [&](std::size_t k) {
    const auto point = static_cast<Index>(k);
    if (clearance.least(point, here.col(point)) <= reach)
      distance[k] = distance_from(bodies, here.col(point)).value;
  });
  // Heights between vertices are means of theirs, so that none is above the largest.
  std::vector<double> room(static_cast<std::size_t>(base.cols()), INFINITY);
  constexpr double part = 0.02;  // what a vertex has less part in than this it hardly raises
  for (std::size_t k = 0; k < distance.size(); ++k) {
    nearest = std::min(nearest, distance[k]);
    if (distance[k] > reach) continue;
    for (const auto& [v, weight] : points.of(static_cast<Index>(k)))
      if (weight > part) room[v] = std::min(room[v], std::max(distance[k], 0.0));
  }
  return room;
}

Eigen::VectorXd wanted_heights(const wrinkle::BaseSurface& surface,
                               const std::vector<wrinkle::FaceForms>& forms,
                               const shell::Material& material) {
  const wrinkle::Model model{material};
  const auto free = wrinkle::wrinkle_free_faces(forms, surface.topology, wrinkle::WrinkleFreeRule::paper);
  std::vector<bool> live;
  for (const bool f : free) live.push_back(!f);
  const auto waves = wrinkle::local_waves(forms, surface.topology, live,
                                          std::vector<bool>(surface.topology.vertex_count, false), model);
  // Waves longer than the middle one, by area times compression, belong to faces that are nearly flat and
  // slack, whose neighbours make them shorter.
  std::vector<std::pair<double, double>> frequencies;  // radians per metre, weights
  for (std::size_t f = 0; f < forms.size(); ++f)
    if (live[f] && waves[f].compression > 0)
      frequencies.emplace_back(waves[f].gradient.norm(), forms[f].rest.area * waves[f].compression);
  const double middle = weighted_median(std::move(frequencies));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(surface.positions.cols()), area = sum;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    const double frequency = waves[f].gradient.norm(),
                 own = live[f] ? wrinkle::best_amplitude(forms[f], model, waves[f], waves[f].gradient) : 0,
                 height = own * std::min(frequency / std::max(middle, 1e-300), 1.0);
    for (const std::uint32_t v : surface.topology.faces[f]) {
      sum[v] += forms[f].rest.area * height;
      area[v] += forms[f].rest.area;
    }
  }
  for (Index v = 0; v < sum.size(); ++v)
    if (area[v] > 0) sum[v] /= area[v];
  return sum;
}

}  // namespace plisse::cloth
