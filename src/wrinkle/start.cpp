#include "wrinkle/start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "wrinkle/closed_form.h"
#include "wrinkle/local_waves.h"
#include "wrinkle/patches.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Chooses the signs of gradients so that neighbours agree, in the order of certainty of the edges; `known`:
// one flag for each face whose sign is fixed.
void comb(std::vector<LocalWaves>& waves, const Problem& problem, const std::vector<bool>& known) {
  const std::vector<FaceForms>& forms = problem.forms();
  const shell::Topology& topology = problem.topology();
  const std::vector<bool>& live = problem.live();
  struct Link {
    double surety;
    std::size_t from, to;
    bool turn;
    bool operator<(const Link& other) const {
      return std::tie(surety, other.to) < std::tie(other.surety, to);
    }
  };
  std::vector<bool> done(forms.size(), false);
  std::priority_queue<Link> queue;
  const auto reach = [&](std::size_t f) {
    done[f] = true;
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t to = across(topology, f, side);
      if (to == shell::none || !live[to] || done[to]) continue;
      // Components along and across the shared edge compare the two frames.
      std::size_t back = 0;
      while (side_edge(topology, to, back) != side_edge(topology, f, side)) ++back;
      const auto frame = [&](std::size_t face, std::size_t s) {
        const Eigen::Matrix2d& rest = forms[face].rest.edges;
        const std::array<Vector2d, 3> corner{Vector2d(0, 0), rest.col(0), rest.col(1)};
        const Vector2d e = (corner[(s + 1) % 3] - corner[s]).normalized() * side_sign(topology, face, s);
        return std::pair(e.dot(waves[face].gradient),
                         e.x() * waves[face].gradient.y() - e.y() * waves[face].gradient.x());
      };
      const auto [x, y] = frame(f, side);
      const auto [u, v] = frame(to, back);
      const double dot = x * u + y * v, size = std::hypot(x, y) * std::hypot(u, v);
      const double weight = std::min(waves[f].compression, waves[to].compression);
      queue.push({size > 0 ? std::abs(dot) / size * std::max(weight, 0.0) : 0, f, to, dot < 0});
    }
  };
  std::vector<std::size_t> order;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    if (live[f]) order.push_back(f);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return waves[a].compression > waves[b].compression; });
  const auto follow = [&] {
    while (!queue.empty()) {
      const Link link = queue.top();
      queue.pop();
      if (done[link.to]) continue;
      // The sign of `from` was final when it was reached, so it decides whether the pair disagrees.
      if (link.turn) waves[link.to].gradient *= -1;
      reach(link.to);
    }
  };
  done = known;
  for (const std::size_t f : order) {
    if (known[f]) reach(f);
  }
  follow();
  for (const std::size_t seed : order) {
    if (done[seed]) continue;
    reach(seed);
    follow();
  }
}

// The target of the one-form on each face, and its weight.
struct Target {
  std::vector<LocalWaves> local;
  std::vector<double> weight;
};

void fit(const Problem& problem, const Target& target, Waves& waves) {
  std::vector<Vector2d> gradients;
  for (const LocalWaves& local : target.local) gradients.push_back(local.gradient);
  Waves closed = nearest_closed(problem, gradients, target.weight);
  waves.phase = std::move(closed.phase);
  waves.period = std::move(closed.period);
}

Vector2d gradient_of(const Problem& problem, const Waves& waves, std::size_t face) {
  return problem.forms()[face].rest.gradients *
         problem.complex().corner_phases(face, waves.phase, waves.period);
}

// For every free vertex, the mean of the amplitudes of the faces around it: for the one-form of the state,
// `frequency` times as dense; or √(2s₀)/|ω| for their own waves, whether they need more compression than
// there is or not.
enum class Suits { projected, uncritical };
VectorXd suiting_amplitudes(const Problem& problem, const std::vector<LocalWaves>& local, const Waves& waves,
                            Suits suits = Suits::projected, double frequency = 1) {
  VectorXd amplitude = VectorXd::Zero(static_cast<Index>(problem.pinned().size())), weight = amplitude;
  for (std::size_t f = 0; f < local.size(); ++f) {
    if (!problem.live()[f]) continue;
    const double area = problem.forms()[f].rest.area;
    const double best = suits == Suits::uncritical
                            ? std::sqrt(2 * std::max(local[f].compression, 0.0)) / local[f].gradient.norm()
                            : best_amplitude(problem.forms()[f], problem.model(), local[f],
                                             frequency * gradient_of(problem, waves, f));
    for (const std::uint32_t v : problem.topology().faces[f]) {
      amplitude[v] += area * best;
      weight[v] += area;
    }
  }
  for (Index v = 0; v < weight.size(); ++v) {
    const bool free = weight[v] > 0 && !problem.pinned()[static_cast<std::size_t>(v)];
    amplitude[v] = free ? amplitude[v] / weight[v] : 0;
  }
  return amplitude;
}

double sum_over(const std::vector<std::uint32_t>& faces, const VectorXd& of_faces) {
  double sum = 0;
  for (const std::uint32_t f : faces) sum += of_faces[f];
  return sum;
}

// Consistent signs, and weights from area and compression.
Target combed(const Problem& problem, std::vector<LocalWaves> local) {
  Target target;
  target.local = std::move(local);
  double most = 0;
  for (const LocalWaves& l : target.local) most = std::max(most, l.compression);
  comb(target.local, problem, std::vector<bool>(target.local.size(), false));
  // Faces without compression keep a small weight, to connect the form.
  for (std::size_t f = 0; f < target.local.size(); ++f)
    target.weight.push_back(problem.forms()[f].rest.area *
                            (most > 0 ? std::max(target.local[f].compression / most, 1e-3) : 1));
  return target;
}

}  // namespace

Waves waves_of(const Problem& problem, std::vector<LocalWaves> local) {
  const Target target = combed(problem, std::move(local));
  Waves waves;
  fit(problem, target, waves);
  waves.amplitude = suiting_amplitudes(problem, target.local, waves, Suits::uncritical);
  return waves;
}

Waves initial_waves(const Problem& problem, double frequency) {
  std::vector<LocalWaves> local = problem.own_waves();
  for (LocalWaves& l : local) l.gradient *= frequency;
  const Target target = combed(problem, std::move(local));
  Waves fitted;
  fit(problem, target, fitted);

  // A closed form does not have each face's own frequency. For each patch: the amplitudes for the closed
  // form, multiplied by the best scale t (the energy is c₀ + c₂t² + c₄t⁴), and if that gives t = 0, other
  // frequencies.
  Waves start = fitted;
  start.amplitude = VectorXd::Zero(static_cast<Index>(problem.pinned().size()));
  const VectorXd flat = problem.face_energies(problem.pack(start));
  const auto faces = patches(problem.topology(), problem.live());
  std::vector<bool> done(faces.size(), false);
  std::vector<double> gained(faces.size(), 0);
  for (const int step : {0, 1, -1, 2, -2, 3, -3, 4, -4, 6, -6, 8, -8}) {
    if (std::find(done.begin(), done.end(), false) == done.end()) break;
    const double factor = std::exp2(step / 4.0);
    Waves trial{suiting_amplitudes(problem, target.local, fitted, Suits::projected, factor),
                factor * fitted.phase, factor * fitted.period};
    const VectorXd once = problem.face_energies(problem.pack(trial)) - flat;
    trial.amplitude *= 2;
    const VectorXd twice = problem.face_energies(problem.pack(trial)) - flat;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (done[i]) continue;
      const double e1 = sum_over(faces[i], once), e2 = sum_over(faces[i], twice), c4 = (e2 - 4 * e1) / 12,
                   c2 = e1 - c4;
      if (!(c2 < 0) || !(c4 > 0) || !(c2 * c2 / (4 * c4) > gained[i])) continue;
      gained[i] = c2 * c2 / (4 * c4);
      problem.copy_patch(faces[i], trial, start, std::sqrt(-c2 / (2 * c4)) / 2);
      done[i] = step == 0;
    }
    if (step == 0) {  // a patch without compression stays flat
      for (std::size_t i = 0; i < faces.size(); ++i)
        done[i] = done[i] || std::none_of(faces[i].begin(), faces[i].end(),
                                          [&](std::uint32_t f) { return target.local[f].compression > 0; });
    }
  }
  // In a patch with compression only in places, equal amplitudes are too low or too high: begin with higher
  // ones; the solver reduces them.
  fitted.amplitude = suiting_amplitudes(problem, target.local, fitted, Suits::uncritical);
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (!done[i] && gained[i] == 0) problem.copy_patch(faces[i], fitted, start);
  return start;
}

std::vector<Vector2d> completed(const Problem& problem, const std::vector<bool>& known,
                                const std::vector<Vector2d>& gradients) {
  std::vector<LocalWaves> local = problem.own_waves();
  for (std::size_t f = 0; f < local.size(); ++f)
    if (known[f]) local[f].gradient = gradients[f];
  comb(local, problem, known);
  std::vector<Vector2d> result;
  for (const LocalWaves& l : local) result.push_back(l.gradient);
  return result;
}

Waves continued_waves(const Problem& to, const Problem& from, const Waves& waves) {
  const std::size_t count = to.forms().size();
  Target target;
  target.local = to.own_waves();
  const double most = waves.amplitude.size() > 0 ? waves.amplitude.maxCoeff() : 0;
  std::vector<bool> known(count, false);
  for (std::size_t f = 0; f < count; ++f) {
    const shell::Face& t = to.topology().faces[f];
    const double mean = (waves.amplitude[t[0]] + waves.amplitude[t[1]] + waves.amplitude[t[2]]) / 3;
    known[f] = to.live()[f] && from.live()[f] && mean > 0;
    if (known[f]) target.local[f].gradient = gradient_of(from, waves, f);
    // Existing waves are kept, with a weight that grows with their height; the others follow freely.
    target.weight.push_back(to.forms()[f].rest.area * ((known[f] ? mean * mean / (most * most) : 0) + 1e-3));
  }
  comb(target.local, to, known);
  Waves result;
  fit(to, target, result);
  result.amplitude = suiting_amplitudes(to, target.local, result);
  const VectorXd fresh = result.amplitude;
  VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (const double height : {0.0, 0.1, 0.25, 0.5, 1.0}) {
    for (Index v = 0; v < fresh.size(); ++v) {
      const bool free = !to.pinned()[static_cast<std::size_t>(v)];
      result.amplitude[v] = free && waves.amplitude[v] == 0 ? height * fresh[v]
                            : free                          ? waves.amplitude[v]
                                                            : 0;
    }
    const double energy = to.energy(to.pack(result));
    // Not flat again, even if its energy is lower: the solver could not leave that state.
    if (height > 0 && !(energy < least)) continue;
    if (height > 0) least = energy;
    best = result.amplitude;
  }
  result.amplitude = best;
  return result;
}

}  // namespace plisse::wrinkle
