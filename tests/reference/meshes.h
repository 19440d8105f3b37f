// Small meshes for the tests of the reference: flat grids, jittered or not, with rows built here and not by
// mesh/.
#pragma once

#include <Eigen/Dense>
#include <random>
#include <set>
#include <vector>

#include "reference/topology.h"

namespace plisse::reference::test {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

inline Topology topology_of(const Eigen::Matrix3Xd& rest, const Triangles& triangles) {
  std::vector<std::set<std::uint32_t>> neighbours(static_cast<std::size_t>(rest.cols()));
  std::vector<std::vector<Corner>> corners(neighbours.size());
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      neighbours[t[i]].insert({t[(i + 1) % 3], t[(i + 2) % 3]});
      corners[t[i]].push_back({t[(i + 1) % 3], t[(i + 2) % 3]});
    }
  Topology topology;
  topology.rest = rest;
  for (std::size_t v = 0; v < neighbours.size(); ++v) {
    topology.neighbours.items.insert(topology.neighbours.items.end(), neighbours[v].begin(),
                                     neighbours[v].end());
    topology.neighbours.offsets.push_back(static_cast<std::uint32_t>(topology.neighbours.items.size()));
    topology.corners.items.insert(topology.corners.items.end(), corners[v].begin(), corners[v].end());
    topology.corners.offsets.push_back(static_cast<std::uint32_t>(topology.corners.items.size()));
  }
  return topology;
}

// A grid of side × side vertices in the plane z = 0, one unit apart, each moved by up to `jitter` units.
struct Grid {
  Eigen::Matrix3Xd points;
  Triangles triangles;
  Topology topology;
};

inline Grid grid(int side, double jitter, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-jitter, jitter);
  Grid result;
  result.points.resize(3, side * side);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double dx = move(random), dy = move(random);
      result.points.col(j * side + i) = Eigen::Vector3d(i + dx, j + dy, 0);
    }
  for (int j = 0; j + 1 < side; ++j)
    for (int i = 0; i + 1 < side; ++i) {
      const auto a = static_cast<std::uint32_t>(j * side + i), b = a + 1;
      const auto c = a + static_cast<std::uint32_t>(side), d = c + 1;
      result.triangles.push_back({a, b, d});
      result.triangles.push_back({a, d, c});
    }
  result.topology = topology_of(result.points, result.triangles);
  return result;
}

}  // namespace plisse::reference::test
