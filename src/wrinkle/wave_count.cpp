#include "wrinkle/wave_count.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wrinkle/patches.h"

namespace plisse::wrinkle {
namespace {

// More waves, or as many on a shorter line. Loops are preferred to paths: their number does not depend on
// their position.
void keep_better(WaveCount& best, const WaveCount& other) {
  constexpr double same = 1e-6;  // turns; sums of some hundred phases in double precision
  if (!(other.waves > same)) return;
  if (other.waves > best.waves + same ||
      (other.waves > best.waves - same &&
       (other.round != best.round ? other.round : other.length < best.length)))
    best = other;
}

// Paths and loops from a few vertices, each the far end of the one before.
void follow_ways(const PatchGraph& graph, std::uint32_t from, const Eigen::VectorXd& one_form,
                 WaveCount& best) {
  constexpr int sweeps = 4;  // on a sheet the second has found both ends
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const PatchGraph::Walk walk = graph.from(from, one_form);
    const auto less = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const auto far = std::max_element(walk.turns.begin(), walk.turns.end(), less) - walk.turns.begin();
    keep_better(best, {std::abs(walk.turns[static_cast<std::size_t>(far)]), false,
                       walk.distance[static_cast<std::size_t>(far)]});
    for (const PatchGraph::Edge& e : graph.edges()) {
      const auto [a, b] = e.vertex;
      const double round = walk.turns[a] + one_form[e.edge] / (2 * std::numbers::pi) - walk.turns[b];
      keep_better(best, {std::abs(round), true, walk.distance[a] + e.length + walk.distance[b]});
    }
    from = static_cast<std::uint32_t>(far);
  }
}

// The boundaries of a patch, each followed once around with its faces on the left.
void follow_rims(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                 const std::vector<bool>& visible, const std::vector<std::uint32_t>& patch,
                 const Eigen::VectorXd& one_form, WaveCount& best) {
  const auto beyond = [&](std::size_t face, std::size_t side) {
    const std::uint32_t n = across(topology, face, side);
    return n != shell::none && visible[n] ? n : shell::none;
  };
  std::vector<bool> done(topology.edges.size(), false);
  for (const std::uint32_t first : patch) {
    for (std::size_t start = 0; start < 3; ++start) {
      WaveCount rim{0, true, 0};
      std::size_t face = first, side = start;
      while (beyond(face, side) == shell::none && !done[side_edge(topology, face, side)]) {
        const std::uint32_t edge = side_edge(topology, face, side);
        done[edge] = true;
        rim.waves += side_sign(topology, face, side) * one_form[edge] / (2 * std::numbers::pi);
        const Eigen::Matrix2d& rest = forms[face].rest.edges;
        const Eigen::Vector2d along = side == 0   ? Eigen::Vector2d(rest.col(0))
                                      : side == 1 ? Eigen::Vector2d(rest.col(1) - rest.col(0))
                                                  : Eigen::Vector2d(rest.col(1));
        rim.length += along.norm();
        // Around the side's end to the next boundary side.
        side = (side + 1) % 3;
        for (std::uint32_t next = beyond(face, side); next != shell::none; next = beyond(face, side)) {
          const std::uint32_t crossed = side_edge(topology, face, side);
          face = next;
          side = 0;
          while (side_edge(topology, face, side) != crossed) ++side;
          side = (side + 1) % 3;
        }
      }
      rim.waves = std::abs(rim.waves);
      if (rim.length > 0) keep_better(best, rim);
    }
  }
}

}  // namespace

WaveCount count_waves(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                      const std::vector<bool>& live, const Eigen::VectorXd& amplitude,
                      const Eigen::VectorXd& one_form, double share) {
  WaveCount best;
  const double least = amplitude.size() > 0 ? share * amplitude.maxCoeff() : 0;
  if (!(least > 0)) return best;
  std::vector<bool> visible = live;
  for (std::size_t f = 0; f < visible.size(); ++f) {
    for (const std::uint32_t v : topology.faces[f]) visible[f] = visible[f] && amplitude[v] > least;
  }
  for (const auto& patch : patches(topology, visible)) {
    const PatchGraph graph(topology, forms, patch);
    const auto& vertices = graph.vertices();
    const auto highest =
        std::max_element(vertices.begin(), vertices.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return amplitude[a] < amplitude[b]; });
    follow_ways(graph, static_cast<std::uint32_t>(highest - vertices.begin()), one_form, best);
    follow_rims(topology, forms, visible, patch, one_form, best);
  }
  return best;
}

double wavelength_at_highest(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                             const std::vector<bool>& live, const Eigen::VectorXd& amplitude,
                             const Eigen::VectorXd& one_form) {
  Eigen::Index highest = 0;
  if (amplitude.size() == 0 || !(amplitude.maxCoeff(&highest) > 0)) return 0;
  double turns = 0, area = 0;
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const shell::Face& t = topology.faces[f];
    if (!live[f] || std::find(t.begin(), t.end(), highest) == t.end()) continue;
    const auto side = [&](std::size_t i) {
      return side_sign(topology, f, i) * one_form[side_edge(topology, f, i)];
    };
    const Eigen::Vector2d gradient = forms[f].rest.gradients * Eigen::Vector3d(0, side(0), side(0) + side(1));
    turns += forms[f].rest.area * gradient.norm() / (2 * std::numbers::pi);
    area += forms[f].rest.area;
  }
  return turns > 0 ? area / turns : 0;
}

}  // namespace plisse::wrinkle
