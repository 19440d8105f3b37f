#include "wrinkle/phase_complex.h"

#include <map>
#include <numeric>

namespace plisse::wrinkle {
namespace {

// Disjoint sets with union.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // Returns whether they were different sets.
  bool join(std::size_t a, std::size_t b) {
    const std::size_t x = find(a), y = find(b);
    parent_[x] = y;
    return x != y;
  }

 private:
  std::vector<std::size_t> parent_;
};

bool is_live_edge(const PhaseComplex& complex, const shell::Topology& topology, std::size_t edge) {
  for (const std::uint32_t f : topology.edges[edge].face) {
    if (f != shell::none && complex.live[f]) return true;
  }
  return false;
}

std::uint32_t live_neighbour(const PhaseComplex& complex, const shell::Topology& topology, std::size_t face,
                             std::size_t side) {
  const std::uint32_t n = across(topology, face, side);
  return n != shell::none && complex.live[n] ? n : shell::none;
}

// Fans of live faces round pinned vertices, whole vertices elsewhere.
void number_vertices(PhaseComplex& complex, const shell::Topology& topology,
                     const std::vector<bool>& pinned) {
  Groups corners(3 * topology.faces.size());
  std::vector<std::size_t> first(pinned.size(), SIZE_MAX);
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (!complex.live[f]) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = topology.faces[f][c];
      if (!pinned[v]) {
        if (first[v] == SIZE_MAX) first[v] = 3 * f + c;
        corners.join(3 * f + c, first[v]);
      }
      const std::uint32_t n = live_neighbour(complex, topology, f, c);
      if (n == shell::none) continue;
      for (const std::uint32_t end : {v, topology.faces[f][(c + 1) % 3]}) {
        const std::size_t here = 3 * f + (end == v ? c : (c + 1) % 3);
        for (std::size_t d = 0; d < 3; ++d) {
          if (topology.faces[n][d] == end) corners.join(here, 3 * n + d);
        }
      }
    }
  }
  std::map<std::size_t, int> number;
  complex.phase_vertex.assign(topology.faces.size(), {-1, -1, -1});
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (!complex.live[f]) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [at, added] = number.try_emplace(corners.find(3 * f + c), static_cast<int>(number.size()));
      complex.phase_vertex[f][c] = at->second;
    }
  }
  complex.vertices = number.size();
}

// Collapses each component of live faces, beginning at an edge of one face (one face of a closed component
// remains; ω is closed on it because it is on the others). Returns the order of the faces and the side
// through which each collapses.
struct Collapse {
  std::vector<std::uint32_t> faces;
  std::vector<std::uint32_t> through;  // edges
};

Collapse collapse(const PhaseComplex& complex, const shell::Topology& topology) {
  Collapse result;
  std::vector<bool> seen(complex.live.size(), false);
  const auto grow = [&](std::size_t begin) {
    for (std::size_t i = begin; i < result.faces.size(); ++i) {
      const std::uint32_t f = result.faces[i];
      for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t n = live_neighbour(complex, topology, f, side);
        if (n == shell::none || seen[n]) continue;
        seen[n] = true;
        result.faces.push_back(n);
        result.through.push_back(side_edge(topology, f, side));
      }
    }
  };
  for (std::uint32_t f = 0; f < complex.live.size(); ++f) {
    if (!complex.live[f] || seen[f]) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      if (live_neighbour(complex, topology, f, side) != shell::none) continue;
      seen[f] = true;
      result.faces.push_back(f);
      result.through.push_back(side_edge(topology, f, side));
      grow(result.faces.size() - 1);
      break;
    }
  }
  for (std::uint32_t f = 0; f < complex.live.size(); ++f) {
    if (!complex.live[f] || seen[f]) continue;
    seen[f] = true;
    const std::size_t begin = result.faces.size();
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t n = live_neighbour(complex, topology, f, side);
      if (n == shell::none || seen[n]) continue;
      seen[n] = true;
      result.faces.push_back(n);
      result.through.push_back(side_edge(topology, f, side));
    }
    grow(begin);
  }
  return result;
}

}  // namespace

PhaseComplex::PhaseComplex(const shell::Topology& topology, std::vector<bool> live_faces,
                           const std::vector<bool>& pinned)
    : live(std::move(live_faces)) {
  number_vertices(*this, topology, pinned);
  jumps.resize(topology.faces.size());
  const Collapse order = collapse(*this, topology);
  std::vector<bool> gone(topology.edges.size(), false);
  for (const std::uint32_t edge : order.through) gone[edge] = true;

  // Phase vertices at both ends of every live edge.
  std::vector<std::array<int, 2>> ends(topology.edges.size(), {-1, -1});
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (!live[f]) continue;
    for (std::size_t c = 0; c < 3; ++c)
      ends[side_edge(topology, f, c)] = {phase_vertex[f][c], phase_vertex[f][(c + 1) % 3]};
  }
  Groups forest(vertices);
  std::vector<std::uint32_t> generators;
  for (std::uint32_t e = 0; e < topology.edges.size(); ++e) {
    if (gone[e] || !is_live_edge(*this, topology, e)) continue;
    if (!forest.join(static_cast<std::size_t>(ends[e][0]), static_cast<std::size_t>(ends[e][1])))
      generators.push_back(e);
  }
  periods = generators.size();

  // γ_k spreads from the graph over the faces in reverse: all but one edge of a face are known by then.
  // Sparse: only faces with a non-zero edge are visited.
  std::vector<std::size_t> place(topology.faces.size(), SIZE_MAX);
  for (std::size_t i = 0; i < order.faces.size(); ++i) place[order.faces[i]] = i;
  for (std::uint32_t k = 0; k < generators.size(); ++k) {
    std::map<std::uint32_t, double> value{{generators[k], 1.0}};
    std::map<std::size_t, std::uint32_t, std::greater<>> waiting;  // place → face, the latest first
    const auto wake = [&](std::uint32_t edge) {
      for (const std::uint32_t f : topology.edges[edge].face) {
        if (f != shell::none && place[f] != SIZE_MAX) waiting[place[f]] = f;
      }
    };
    wake(generators[k]);
    while (!waiting.empty()) {
      const auto [at, face] = *waiting.begin();
      waiting.erase(waiting.begin());
      const std::uint32_t through = order.through[at];
      double sum = 0, own = 1;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t e = side_edge(topology, face, c);
        if (e == through)
          own = side_sign(topology, face, c);
        else if (const auto found = value.find(e); found != value.end())
          sum += side_sign(topology, face, c) * found->second;
      }
      if (sum == 0) continue;
      value[through] = -sum / own;
      for (const std::uint32_t f : topology.edges[through].face) {
        const auto other = f;
        if (f != shell::none && other != face && place[other] != SIZE_MAX && place[other] < at)
          waiting[place[other]] = f;
      }
    }
    std::map<std::uint32_t, bool> touched;
    for (const auto& [edge, number] : value) {
      for (const std::uint32_t f : topology.edges[edge].face) {
        if (f != shell::none && live[f]) touched[f] = true;
      }
    }
    for (const auto& [face, yes] : touched) {
      Eigen::Vector3d around = Eigen::Vector3d::Zero();  // along edges 0, 1, 2 of the face
      for (std::size_t c = 0; c < 3; ++c) {
        const auto found = value.find(side_edge(topology, face, c));
        if (found != value.end())
          around[static_cast<Eigen::Index>(c)] = side_sign(topology, face, c) * found->second;
      }
      if (around.isZero()) continue;
      jumps[face].push_back({k, {0, around[0], -around[2]}});
    }
  }
}

Eigen::Vector3d PhaseComplex::corner_phases(std::size_t face, const Eigen::VectorXd& phase,
                                            const Eigen::VectorXd& period) const {
  const auto& at = phase_vertex[face];
  Eigen::Vector3d result(0, phase[at[1]] - phase[at[0]], phase[at[2]] - phase[at[0]]);
  for (const Jump& jump : jumps[face]) result += period[jump.period] * jump.corners;
  return result;
}

}  // namespace plisse::wrinkle
