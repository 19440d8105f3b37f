// Several panels and the seams between them become one mesh: both sides of a seam are divided alike, so that
// vertex meets vertex, by the side that wants more of them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "sizing/mesh_panel.h"

namespace plisse::sizing {

// A stretch of a panel's outline between two of its points: the shorter way, or the longer one.
struct SeamSide {
  std::size_t panel = 0;
  glm::dvec2 from{0}, to{0};  // panel coordinates, m
  bool long_way = false;
};

// The stretches are sewn from `from` to `from` and from `to` to `to`. Where their lengths differ by more than
// a thousandth the longer is gathered: it is a stitch (D. Zhang et al., SIGGRAPH 2025, 4.2.4).
struct Seam {
  std::string name;
  SeamSide a, b;
};

// Where a panel starts in space: p ↦ rotation · (p, 0) + translation.
struct Placement {
  glm::dmat3 rotation{1};
  glm::dvec3 translation{0};
};

// Degrees round x, then y, then z, round axes that stay where they are.
glm::dmat3 turned_by(const glm::dvec3& degrees);

struct Garment {
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  std::vector<Placement> placements;  // one a panel, or none
};

struct SizedGarment {
  std::vector<Panel>
      made;  // the panels as they were meshed: with the stitches of their seams among the features
  std::vector<std::unique_ptr<SizedPanel>> panels;
  std::vector<std::uint32_t> first;  // by panel: where its vertices begin in `sewn`
  std::vector<std::uint32_t>
      sewn;                  // by vertex of all panels, one panel after the other: its vertex of the garment
  std::size_t vertices = 0;  // of the garment
  std::vector<glm::dvec3>
      positions;  // of those, m: where the panels are placed, the mean where they are sewn
  std::vector<std::vector<std::array<std::uint32_t, 2>>> seam_edges;  // by seam: edges of the garment
  struct Join {
    std::string name;
    double length_a = 0, length_b = 0;  // m
    std::size_t edges = 0;
    double gap = 0;  // m: the widest between the two sides as they are placed
  };
  std::vector<Join> joins;
};

// Throws Error(bad_input), all that is wrong at once: what mesh_panel throws; seams that begin or end off the
// outline, have no length, overlap another, or are sewn to themselves.
SizedGarment mesh_garment(const Garment& garment, const SizingOptions& options);

}  // namespace plisse::sizing
