// Closed one-forms on the live faces by construction: vertex phases and one period a loop, so that the
// solver needs no curl constraints (section 5.2's (38) holds identically).
//
// ω = dφ + Σ τ_k γ_k: φ is one number a phase vertex, γ_k integer one-forms that are closed on the live
// faces, one for every generator of their first homology, and τ_k the period round it (radians). They are
// found by collapsing the live faces, each through one of its edges, onto a graph. The loops of the graph are
// the generators, and γ_k is the one-form with 1 on the k-th edge that is not in a spanning forest of the
// graph.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "wrinkle/surface.h"

namespace plisse::wrinkle {

struct PhaseComplex {
  struct Jump {
    std::uint32_t period;     // k
    Eigen::Vector3d corners;  // factors of τ_k in the phases of the face's corners; 0 at corner 0
  };
  // One per vertex of the base surface; but a vertex whose amplitude is pinned to 0 has a separate phase for
  // every fan of live faces around it, as wrinkles on different sides of it need not agree.
  std::size_t vertices = 0;
  std::size_t periods = 0;
  std::vector<bool> live;                        // one a face
  std::vector<std::array<int, 3>> phase_vertex;  // of every corner; −1 on faces that are not live
  std::vector<std::vector<Jump>> jumps;          // of every face; mostly none

  // `live_faces`: one flag a face; `pinned`: one a base vertex.
  PhaseComplex(const shell::Topology& topology, std::vector<bool> live_faces,
               const std::vector<bool>& pinned);

  // Differences of phase to corner 0, of the corners of a live face.
  Eigen::Vector3d corner_phases(std::size_t face, const Eigen::VectorXd& phase,
                                const Eigen::VectorXd& period) const;
};

}  // namespace plisse::wrinkle
