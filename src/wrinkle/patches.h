// Connected sets of faces, and shortest paths along their edges.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "wrinkle/surface.h"

namespace plisse::wrinkle {

// Sets of faces that are connected by edges; one flag per face says which faces are used. In the order of
// their first faces.
std::vector<std::vector<std::uint32_t>> patches(const shell::Topology& topology,
                                                const std::vector<bool>& faces);

// A patch's vertices and edges, numbered anew.
class PatchGraph {
 public:
  struct Link {
    std::uint32_t to;    // a vertex of the patch
    std::uint32_t edge;  // of `edges`
  };
  struct Edge {
    std::array<std::uint32_t, 2> vertex;  // of the patch, in the topology's order
    std::uint32_t edge;                   // of the topology
    double length;                        // metres at rest
    bool rim;                             // a boundary edge of the patch
  };
  // Shortest paths from one vertex.
  struct Walk {
    std::vector<double> distance;    // metres
    std::vector<double> turns;       // ∫ω/2π along the path
    std::vector<std::uint32_t> via;  // of `edges`, the last one of the path; shell::none at the start
  };

  PatchGraph(const shell::Topology& topology, const std::vector<FaceForms>& forms,
             const std::vector<std::uint32_t>& faces);

  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<std::uint32_t>& vertices() const { return vertices_; }  // of the topology
  // `one_form`: radians, one an edge of the topology.
  Walk from(std::uint32_t vertex, const Eigen::VectorXd& one_form) const;
  // The longest of the shortest paths, by two sweeps: exact on trees, slightly too short elsewhere. Metres.
  double diameter() const;

 private:
  std::vector<std::uint32_t> vertices_;
  std::vector<Edge> edges_;
  std::vector<std::vector<Link>> links_;
};

}  // namespace plisse::wrinkle
