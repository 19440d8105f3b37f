#include "wrinkle/local_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "base/error.h"
#include "wrinkle/local_waves.h"
#include "wrinkle/start.h"

namespace plisse::wrinkle {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Of every vertex from the nearest clamped one, over all faces, metres at rest.
std::vector<double> distances(const Problem& problem, const std::vector<bool>& clamped) {
  const shell::Topology& topology = problem.topology();
  std::vector<std::vector<std::pair<std::uint32_t, double>>> links(topology.vertex_count);
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    const shell::Face& t = topology.faces[f];
    const Eigen::Matrix2d& rest = problem.forms()[f].rest.edges;
    const std::array<double, 3> length{rest.col(0).norm(), (rest.col(1) - rest.col(0)).norm(),
                                       rest.col(1).norm()};
    for (std::size_t side = 0; side < 3; ++side) {
      links[t[side]].emplace_back(t[(side + 1) % 3], length[side]);
      links[t[(side + 1) % 3]].emplace_back(t[side], length[side]);
    }
  }
  std::vector<double> distance(topology.vertex_count, infinite);
  using Reached = std::pair<double, std::uint32_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  for (std::uint32_t v = 0; v < topology.vertex_count; ++v) {
    if (v >= clamped.size() || !clamped[v]) continue;
    distance[v] = 0;
    queue.emplace(0, v);
  }
  while (!queue.empty()) {
    const auto [far, v] = queue.top();
    queue.pop();
    if (far > distance[v]) continue;
    for (const auto& [to, length] : links[v]) {
      if (far + length >= distance[to]) continue;
      distance[to] = far + length;
      queue.emplace(distance[to], to);
    }
  }
  return distance;
}

}  // namespace

double vandeparre_wavelength(const shell::Material& material, double distance, double tension,
                             double compression) {
  constexpr double pi = std::numbers::pi;
  const double h = material.thickness, slim = 1 - material.poisson * material.poisson;
  // Young's modulus is in B and in T alike.
  const double pulled =
      tension > 0 ? 2 * std::sqrt(pi * distance) * std::sqrt(std::sqrt(h * h / (6 * slim * tension)))
                  : infinite;
  const double slack =
      compression > 0
          ? std::cbrt(4 * pi * pi / std::sqrt(3 * slim) * h / std::sqrt(compression) * distance * distance)
          : infinite;
  return std::min(pulled, slack);
}

Waves vandeparre_waves(const Problem& problem, const std::vector<bool>& clamped) {
  if (std::find(clamped.begin(), clamped.end(), true) == clamped.end())
    throw Error(ExitCode::bad_input,
                "Vandeparre's law counts from a clamped edge, and nothing of this surface is held without "
                "amplitude");
  const std::vector<double> distance = distances(problem, clamped);
  std::vector<LocalWaves> local =
      local_waves(problem.forms(), problem.topology(), problem.live(), problem.pinned(), problem.model());
  for (std::size_t f = 0; f < local.size(); ++f) {
    if (!problem.live()[f]) continue;
    double mean = 0;
    for (const std::uint32_t v : problem.topology().faces[f]) mean += distance[v] / 3;
    const PrincipalStrain principal = principal_strain(problem.forms()[f]);
    const double wavelength = vandeparre_wavelength(problem.model().material, mean, principal.tension,
                                                    std::max(local[f].compression, 0.0));
    // Where the law gives no waves, their length is that of their patch (local_waves.h).
    if (std::isfinite(wavelength)) local[f].gradient = 2 * std::numbers::pi / wavelength * principal.wave;
  }
  return waves_of(problem, std::move(local));
}

}  // namespace plisse::wrinkle
