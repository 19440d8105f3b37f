// Connected sets of faces, and the shortest ways through one along its edges.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "wrinkle/surface.h"

namespace plisse::wrinkle {

// Faces that hang together by edges; one flag a face says which count. In the order of their first faces.
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
    bool rim;                             // one face of the patch, not two
  };
  // Shortest ways from one vertex.
  struct Walk {
    std::vector<double> distance;    // metres
    std::vector<double> turns;       // ∫ω/2π along the way
    std::vector<std::uint32_t> via;  // of `edges`, the last one of the way; shell::none at the start
  };

  PatchGraph(const shell::Topology& topology, const std::vector<FaceForms>& forms,
             const std::vector<std::uint32_t>& faces);

  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<std::uint32_t>& vertices() const { return vertices_; }  // of the topology
  // `one_form`: radians, one an edge of the topology.
  Walk from(std::uint32_t vertex, const Eigen::VectorXd& one_form) const;
  // The longest of the shortest ways, as two sweeps find it: exact on trees, hardly short elsewhere. Metres.
  double diameter() const;

 private:
  std::vector<std::uint32_t> vertices_;
  std::vector<Edge> edges_;
  std::vector<std::vector<Link>> links_;
};

}  // namespace plisse::wrinkle
