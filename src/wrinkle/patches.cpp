#include "wrinkle/patches.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <queue>

namespace plisse::wrinkle {

std::vector<std::vector<std::uint32_t>> patches(const shell::Topology& topology,
                                                const std::vector<bool>& faces) {
  std::vector<std::vector<std::uint32_t>> result;
  std::vector<bool> seen(faces.size(), false);
  for (std::uint32_t first = 0; first < faces.size(); ++first) {
    if (!faces[first] || seen[first]) continue;
    seen[first] = true;
    std::vector<std::uint32_t> patch{first};
    for (std::size_t i = 0; i < patch.size(); ++i) {
      for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t next = across(topology, patch[i], side);
        if (next == shell::none || !faces[next] || seen[next]) continue;
        seen[next] = true;
        patch.push_back(next);
      }
    }
    result.push_back(std::move(patch));
  }
  return result;
}

PatchGraph::PatchGraph(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                       const std::vector<std::uint32_t>& faces) {
  // Edges as they are met: sorting tells those of two faces.
  struct Side {
    std::uint32_t edge;
    double length;
  };
  std::vector<Side> sides;
  for (const std::uint32_t f : faces) {
    const Eigen::Matrix2d& rest = forms[f].rest.edges;
    const std::array<double, 3> length{rest.col(0).norm(), (rest.col(1) - rest.col(0)).norm(),
                                       rest.col(1).norm()};
    for (std::size_t s = 0; s < 3; ++s) sides.push_back({side_edge(topology, f, s), length[s]});
    vertices_.insert(vertices_.end(), topology.faces[f].begin(), topology.faces[f].end());
  }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge < b.edge; });
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  links_.resize(vertices_.size());
  const auto local = [&](std::uint32_t v) {
    return static_cast<std::uint32_t>(std::lower_bound(vertices_.begin(), vertices_.end(), v) -
                                      vertices_.begin());
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& ends = topology.edges[sides[i].edge].vertex;
    if (i > 0 && sides[i].edge == sides[i - 1].edge) {
      edges_.back().rim = false;
      continue;
    }
    const auto number = static_cast<std::uint32_t>(edges_.size());
    edges_.push_back({{local(ends[0]), local(ends[1])}, sides[i].edge, sides[i].length, true});
    links_[edges_.back().vertex[0]].push_back({edges_.back().vertex[1], number});
    links_[edges_.back().vertex[1]].push_back({edges_.back().vertex[0], number});
  }
}

PatchGraph::Walk PatchGraph::from(std::uint32_t vertex, const Eigen::VectorXd& one_form) const {
  Walk walk{std::vector<double>(vertices_.size(), std::numeric_limits<double>::infinity()),
            std::vector<double>(vertices_.size(), 0),
            std::vector<std::uint32_t>(vertices_.size(), shell::none)};
  using Reached = std::pair<double, std::uint32_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  walk.distance[vertex] = 0;
  queue.emplace(0, vertex);
  while (!queue.empty()) {
    const auto [distance, at] = queue.top();
    queue.pop();
    if (distance > walk.distance[at]) continue;
    for (const Link& link : links_[at]) {
      const Edge& edge = edges_[link.edge];
      if (!(distance + edge.length < walk.distance[link.to])) continue;
      const double along = (edge.vertex[0] == at ? 1 : -1) * one_form[edge.edge];
      walk.distance[link.to] = distance + edge.length;
      walk.turns[link.to] = walk.turns[at] + along / (2 * std::numbers::pi);
      walk.via[link.to] = link.edge;
      queue.emplace(walk.distance[link.to], link.to);
    }
  }
  return walk;
}

double PatchGraph::diameter() const {
  double result = 0;
  std::uint32_t from = 0;
  std::uint32_t count = 0;
  for (const Edge& e : edges_) count = std::max(count, e.edge + 1);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  for (int sweep = 0; sweep < 2; ++sweep) {
    const Walk walk = this->from(from, none);
    const auto far = std::max_element(walk.distance.begin(), walk.distance.end());
    result = *far;
    from = static_cast<std::uint32_t>(far - walk.distance.begin());
  }
  return result;
}

}  // namespace plisse::wrinkle
