#include "wrinkle/between.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <queue>
#include <tuple>

#include "wrinkle/closed_form.h"
#include "wrinkle/patches.h"
#include "wrinkle/start.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
constexpr double turn = 2 * std::numbers::pi;

Vector2d gradient(const FaceForms& forms, const std::array<double, 3>& phase) {
  return forms.rest.gradients * Eigen::Vector3d(phase[0], phase[1], phase[2]);
}

// Whether new waves may have become possible at a free vertex.
bool due(const Problem& problem, const Eigen::VectorXd& amplitude) {
  for (std::size_t f = 0; f < problem.live().size(); ++f)
    for (const std::uint32_t v : problem.topology().faces[f])
      if (problem.live()[f] && !problem.pinned()[v] && !(amplitude[v] > 0)) return true;
  return false;
}

// How far the phases of `to` are ahead at every vertex, radians: one number, so that corners that agree go
// on to do so; continuous over the faces with waves of either.
std::vector<double> ahead(const shell::Topology& topology, const CoarseField& from, const CoarseField& to) {
  const std::size_t count = topology.vertex_count;
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> corners(count);  // face, corner
  for (std::uint32_t f = 0; f < topology.faces.size(); ++f) {
    const shell::Face& t = topology.faces[f];
    if (!has_waves(from, t) && !has_waves(to, t)) continue;
    for (std::uint32_t c = 0; c < 3; ++c) corners[t[c]].emplace_back(f, c);
  }
  const auto height = [&](std::uint32_t v) { return std::min(from.amplitude[v], to.amplitude[v]); };
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < count; ++v)
    if (!corners[v].empty()) order.push_back(v);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return height(a) > height(b); });
  std::vector<double> result(count, 0);
  std::vector<bool> done(count, false);
  using Step = std::tuple<double, std::uint32_t, double>;  // height, vertex, its number; the highest first
  const auto later = [](const Step& a, const Step& b) {
    return std::get<0>(a) < std::get<0>(b) ||
           (std::get<0>(a) == std::get<0>(b) && std::get<1>(a) > std::get<1>(b));
  };
  for (const std::uint32_t seed : order) {
    if (done[seed]) continue;
    const auto [face, corner] = corners[seed].front();
    std::priority_queue<Step, std::vector<Step>, decltype(later)> queue(later);
    queue.emplace(
        height(seed), seed,
        height(seed) > 0 ? std::remainder(to.phase[face][corner] - from.phase[face][corner], turn) : 0.0);
    while (!queue.empty()) {
      const auto [high, v, number] = queue.top();
      queue.pop();
      if (done[v]) continue;
      done[v] = true;
      result[v] = number;
      for (const auto& [f, c] : corners[v]) {
        const bool both = has_waves(from, topology.faces[f]) && has_waves(to, topology.faces[f]);
        for (std::size_t other = 0; other < 3; ++other) {
          const std::uint32_t w = topology.faces[f][other];
          if (done[w]) continue;
          const double further =
              both ? (to.phase[f][other] - to.phase[f][c]) - (from.phase[f][other] - from.phase[f][c]) : 0;
          queue.emplace(height(w), w, number + further);
        }
      }
    }
  }
  return result;
}

}  // namespace

bool has_waves(const CoarseField& field, const shell::Face& t) {
  return field.amplitude[t[0]] > 0 || field.amplitude[t[1]] > 0 || field.amplitude[t[2]] > 0;
}

double phase_step(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                  const CoarseField& before, const CoarseField& now) {
  double squares = 0, weights = 0;
  if (before.phase.empty()) return 0;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = topology.faces[f][c];
      const double weight = forms[f].rest.area * before.amplitude[v] * now.amplitude[v];
      squares += weight * std::pow(std::remainder(now.phase[f][c] - before.phase[f][c], turn), 2);
      weights += weight;
    }
  }
  return weights > 0 ? std::sqrt(squares / weights) : 0;
}

Waves carried(const Problem& problem, const CoarseField& field) {
  const PhaseComplex& complex = problem.complex();
  const std::vector<shell::Face>& triangles = problem.topology().faces;
  const double most = field.amplitude.maxCoeff();
  std::vector<Vector2d> gradients(triangles.size(), Vector2d::Zero());
  std::vector<double> weights(triangles.size(), 0);
  std::vector<bool> known(triangles.size(), false);
  bool fresh = false;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    if (!complex.live[f]) continue;
    const shell::Face& t = triangles[f];
    const FaceForms& forms = problem.forms()[f];
    known[f] = has_waves(field, t);
    fresh = fresh || !known[f];
    const double a = (field.amplitude[t[0]] + field.amplitude[t[1]] + field.amplitude[t[2]]) / (3 * most);
    gradients[f] = gradient(forms, field.phase[f]);
    weights[f] = forms.rest.area * (known[f] ? std::max(a * a, 1e-4) : 1e-6);
  }
  if (fresh) gradients = completed(problem, known, gradients);
  Waves waves = nearest_closed(problem, gradients, weights);
  const Eigen::VectorXd whole = turn * (waves.period / turn).array().round();
  if ((whole - waves.period).cwiseAbs().sum() > 1e-9)
    waves = nearest_closed(problem, gradients, weights, &whole);
  waves.period = whole;
  for (Index v = 0; v < waves.amplitude.size(); ++v)
    waves.amplitude[v] = problem.pinned()[static_cast<std::size_t>(v)] ? 0 : field.amplitude[v];
  return waves;
}

Eigen::VectorXd seeded(const Problem& problem, const Waves& waves) {
  constexpr double seed = 0.05;
  if (!due(problem, waves.amplitude)) return waves.amplitude;
  return waves.amplitude.cwiseMax(seed * initial_waves(problem).amplitude);
}

CoarseField interpolated(const shell::Topology& topology, const CoarseField& from, const CoarseField& to,
                         double share) {
  const std::vector<double> number = ahead(topology, from, to);
  CoarseField result{(1 - share) * from.amplitude + share * to.amplitude, {}};
  result.phase.assign(topology.faces.size(), {0, 0, 0});
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const shell::Face& t = topology.faces[f];
    const bool first = has_waves(from, t), second = has_waves(to, t);
    if (!first && !second) continue;
    // What follows from the vertices: each up to whole turns, which the gradient of the face decides.
    std::array<double, 3> given;
    std::size_t high = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      given[c] = from.amplitude[t[c]] > 0 ? from.phase[f][c] + share * number[t[c]]
                                          : to.phase[f][c] - (1 - share) * number[t[c]];
      if (result.amplitude[t[c]] > result.amplitude[t[high]]) high = c;
    }
    const double weight = first && second ? share : second ? 1 : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double near = given[high] + (1 - weight) * (from.phase[f][c] - from.phase[f][high]) +
                          weight * (to.phase[f][c] - to.phase[f][high]);
      result.phase[f][c] = result.amplitude[t[c]] > 0 ? near + std::remainder(given[c] - near, turn) : near;
    }
  }
  return result;
}

CoarseField cross_faded(const std::vector<shell::Face>& faces, const CoarseField& from, const CoarseField& to,
                        double share) {
  const bool later = share >= 0.5;
  const CoarseField &main = later ? to : from, &other = later ? from : to;
  const double small = later ? 1 - share : share;
  CoarseField result = main;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = faces[f][c];
      const double turn_to = other.phase[f][c] - main.phase[f][c];
      const auto turned = std::polar(1.0, turn_to);
      // Where a field has no amplitude its corners' phases need not agree, and the other one's count alone.
      const bool here = main.amplitude[v] > 0, there = other.amplitude[v] > 0;
      if (here && there) result.phase[f][c] += std::arg(1 - small + small * turned);
      if (there && !here) result.phase[f][c] += std::remainder(turn_to, turn);
      if (here || there)
        result.amplitude[v] = std::abs((1 - small) * main.amplitude[v] + small * other.amplitude[v] * turned);
    }
  }
  return result;
}

void align(const shell::Topology& topology, const std::vector<FaceForms>& forms, const CoarseField& reference,
           CoarseField& field) {
  if (reference.phase.empty()) return;
  std::vector<bool> waves;
  for (const shell::Face& t : topology.faces) waves.push_back(has_waves(field, t));
  for (const auto& patch : patches(topology, waves)) {
    const auto weight = [&](std::uint32_t f, std::size_t c) {
      const std::uint32_t v = topology.faces[f][c];
      return forms[f].rest.area * reference.amplitude[v] * field.amplitude[v];
    };
    double agreement = 0;
    for (const std::uint32_t f : patch)
      agreement += (weight(f, 0) + weight(f, 1) + weight(f, 2)) *
                   gradient(forms[f], reference.phase[f]).dot(gradient(forms[f], field.phase[f]));
    std::complex<double> overlap = 0;
    for (const std::uint32_t f : patch) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (agreement < 0) field.phase[f][c] = -field.phase[f][c];
        overlap += std::polar(weight(f, c), reference.phase[f][c] - field.phase[f][c]);
      }
    }
    if (std::abs(overlap) == 0) continue;
    for (const std::uint32_t f : patch)
      for (double& phase : field.phase[f]) phase += std::arg(overlap);
  }
}

}  // namespace plisse::wrinkle
