#include "wrinkle/start.h"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <tuple>

namespace plisse::wrinkle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

// Where a crest goes from a face's centre: so far (metres at rest) until it leaves the live faces, and
// whether amplitudes are 0 there.
struct CrestEnd {
  double length = 0;
  bool pinned = false;
};

class CrestLines {
 public:
  CrestLines(const std::vector<FaceForms>& forms, const shell::Topology& topology,
             const std::vector<bool>& live, const std::vector<bool>& pinned)
      : forms_(forms), topology_(topology), live_(live), pinned_(pinned) {
    for (const FaceForms& f : forms) crest_.push_back(principal_strain(f).crest);
  }

  CrestEnd follow(std::size_t face, double sign) const {
    Eigen::Vector3d at = Eigen::Vector3d::Constant(1.0 / 3);  // barycentric
    Vector2d direction = sign * crest_[face];
    CrestEnd end;
    // A line that circles would do so for ever.
    const int most = 20 + 4 * static_cast<int>(std::sqrt(static_cast<double>(forms_.size())));
    for (int step = 0; step < most; ++step) {
      const Eigen::Vector3d rate = forms_[face].rest.gradients.transpose() * direction;
      double time = std::numeric_limits<double>::infinity();
      int out = 0;
      for (int i = 0; i < 3; ++i) {
        if (rate[i] < 0 && at[i] / -rate[i] < time) {
          time = at[i] / -rate[i];
          out = i;
        }
      }
      end.length += time;
      at = (at + time * rate).cwiseMax(0);
      const auto side = static_cast<std::size_t>(out + 1) % 3;
      const std::uint32_t next = across(topology_, face, side);
      const std::uint32_t a = topology_.faces[face][side], b = topology_.faces[face][(side + 1) % 3];
      if (next == shell::none || !live_[next]) {
        end.pinned = pinned_[a] && pinned_[b];
        break;
      }
      Eigen::Vector3d entry = Eigen::Vector3d::Zero();
      int inward = 0;
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = topology_.faces[next][static_cast<std::size_t>(i)];
        if (v == a)
          entry[i] = at[static_cast<int>(side)];
        else if (v == b)
          entry[i] = at[static_cast<int>((side + 1) % 3)];
        else
          inward = i;
      }
      at = entry;
      face = next;
      direction = crest_[face];
      if (forms_[face].rest.gradients.col(inward).dot(direction) < 0) direction = -direction;
    }
    return end;
  }

  // π/L of amplitudes that vanish at both ends of the crest through a face; π/2L at one, 0 at none.
  double rate(std::size_t face) const {
    const CrestEnd one = follow(face, 1), other = follow(face, -1);
    const double ends = (one.pinned ? 0.5 : 0.0) + (other.pinned ? 0.5 : 0.0);
    return ends * std::numbers::pi / (one.length + other.length);
  }

 private:
  const std::vector<FaceForms>& forms_;
  const shell::Topology& topology_;
  const std::vector<bool>&live_, &pinned_;
  std::vector<Vector2d> crest_;
};

// √area of each component of live faces, for its faces.
std::vector<double> patch_sizes(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                                const std::vector<bool>& live) {
  std::vector<double> size(forms.size(), 0);
  std::vector<std::size_t> patch;
  for (std::size_t first = 0; first < forms.size(); ++first) {
    if (!live[first] || size[first] > 0) continue;
    patch.assign(1, first);
    size[first] = 1;
    double area = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      area += forms[patch[i]].rest.area;
      for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t next = across(topology, patch[i], side);
        if (next == shell::none || !live[next] || size[next] > 0) continue;
        size[next] = 1;
        patch.push_back(next);
      }
    }
    for (const std::size_t f : patch) size[f] = std::sqrt(area);
  }
  return size;
}

// Turns gradients so that neighbours agree, surest edges first.
void comb(std::vector<LocalWaves>& waves, const std::vector<FaceForms>& forms,
          const shell::Topology& topology, const std::vector<bool>& live) {
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
  for (const std::size_t seed : order) {
    if (done[seed]) continue;
    reach(seed);
    while (!queue.empty()) {
      const Link link = queue.top();
      queue.pop();
      if (done[link.to]) continue;
      // Whether the pair disagrees is seen from the sign that `from` had when it was reached, which is final.
      if (link.turn) waves[link.to].gradient *= -1;
      reach(link.to);
    }
  }
}

}  // namespace

LocalWaves local_waves(const FaceForms& forms, const Model& model, double rate, double least, double factor) {
  const PrincipalStrain principal = principal_strain(forms);
  const double nu = model.material.poisson, h = model.material.thickness,
               tension = std::max(principal.tension, 0.0);
  LocalWaves result;
  result.compression = -(principal.compression + nu * tension);
  const double curvature = principal.crest.dot(forms.second_form * principal.crest);
  const double stiffness = model.curvature_factor * curvature * curvature + tension / 2 * rate * rate;
  const double frequency = factor * std::max(std::sqrt(std::sqrt(12 * (1 - nu * nu) * stiffness) / h), least);
  result.gradient = frequency * principal.wave;
  const double critical =
      2 * (1 - nu * nu) * stiffness / (frequency * frequency) + h * h * frequency * frequency / 6;
  result.amplitude = std::sqrt(2 * std::max(result.compression - critical, 0.0)) / frequency;
  return result;
}

std::vector<LocalWaves> local_waves(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                                    const std::vector<bool>& live, const std::vector<bool>& pinned,
                                    const Model& model, double frequency) {
  const std::vector<double> size = patch_sizes(forms, topology, live);
  const CrestLines crests(forms, topology, live, pinned);
  std::vector<LocalWaves> result(forms.size());
  for (std::size_t f = 0; f < forms.size(); ++f) {
    if (live[f]) result[f] = local_waves(forms[f], model, crests.rate(f), 2 * pi / size[f], frequency);
  }
  return result;
}

Waves initial_waves(const Problem& problem, double frequency) {
  const auto& forms = problem.forms();
  const shell::Topology& topology = problem.topology();
  const PhaseComplex& complex = problem.complex();
  const std::vector<bool>& pinned = problem.pinned();
  std::vector<LocalWaves> local =
      local_waves(forms, topology, complex.live, pinned, problem.model(), frequency);
  comb(local, forms, topology, complex.live);

  Waves waves;
  waves.amplitude = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(pinned.size()));
  Eigen::VectorXd weight = waves.amplitude;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    if (!complex.live[f]) continue;
    for (const std::uint32_t v : topology.faces[f]) {
      waves.amplitude[v] += forms[f].rest.area * local[f].amplitude;
      weight[v] += forms[f].rest.area;
    }
  }
  for (Eigen::Index v = 0; v < weight.size(); ++v) {
    const bool free = weight[v] > 0 && !pinned[static_cast<std::size_t>(v)];
    waves.amplitude[v] = free ? waves.amplitude[v] / weight[v] : 0;
  }

  // min Σ area s₀ |dφ + Στγ − gradient|². Faces without compression still hold the form together.
  double most = 0;
  for (const LocalWaves& l : local) most = std::max(most, l.compression);
  const auto size = static_cast<Eigen::Index>(complex.vertices + complex.periods);
  waves.phase = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(complex.vertices));
  waves.period = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(complex.periods));
  if (size == 0) return waves;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  double trace = 0;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    if (!complex.live[f]) continue;
    const double w = forms[f].rest.area * (most > 0 ? std::max(local[f].compression / most, 1e-3) : 1);
    std::vector<std::pair<Eigen::Index, Vector2d>> terms;
    for (Eigen::Index c = 0; c < 3; ++c)
      terms.emplace_back(complex.phase_vertex[f][static_cast<std::size_t>(c)],
                         forms[f].rest.gradients.col(c));
    for (const auto& jump : complex.jumps[f])
      terms.emplace_back(static_cast<Eigen::Index>(complex.vertices + jump.period),
                         forms[f].rest.gradients * jump.corners);
    for (const auto& [i, x] : terms) {
      right[i] += w * x.dot(local[f].gradient);
      for (const auto& [j, y] : terms) entries.emplace_back(i, j, w * x.dot(y));
      trace += w * x.squaredNorm();
    }
  }
  // One phase of every component is free: a trace of the identity picks the smallest solution.
  for (Eigen::Index i = 0; i < size; ++i)
    entries.emplace_back(i, i, 1e-12 * trace / static_cast<double>(size));
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const Eigen::VectorXd solution = factor.solve(right);
  waves.phase = solution.head(waves.phase.size());
  waves.period = solution.tail(waves.period.size());
  return waves;
}

}  // namespace plisse::wrinkle
