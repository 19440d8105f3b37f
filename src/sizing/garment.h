// Several panels and their seams become one mesh: both sides of a seam have the same division, so that each
// vertex has a partner; the side that needs more vertices decides.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "sizing/mesh_panel.h"

namespace plisse::sizing {

// A part of a panel's outline between two of its points: the shorter one, or the longer one.
struct SeamSide {
  std::size_t panel = 0;
  glm::dvec2 from{0}, to{0};  // panel coordinates, m
  bool long_way = false;
};

// The two sides are sewn with `from` at `from` and `to` at `to`. Where their lengths differ by more than a
// thousandth, the longer one is gathered: it is a stitch (D. Zhang et al., SIGGRAPH 2025, 4.2.4).
struct Seam {
  std::string name;
  SeamSide a, b;
};

// The initial placement of a panel in space: p ↦ rotation · (p, 0) + translation.
struct Placement {
  glm::dmat3 rotation{1};
  glm::dvec3 translation{0};
};

// Rotation in degrees about x, then y, then z, with fixed axes.
glm::dmat3 turned_by(const glm::dvec3& degrees);

struct Garment {
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  std::vector<Placement> placements;  // one a panel, or none
};

struct SizedGarment {
  std::vector<Panel> made;  // the panels with the stitches of their seams as additional features
  std::vector<std::unique_ptr<SizedPanel>> panels;
  std::vector<std::uint32_t> first;  // by panel: where its vertices begin in `sewn`
  std::vector<std::uint32_t>
      sewn;                  // by vertex of all panels, one panel after the other: its vertex of the garment
  std::size_t vertices = 0;  // of the garment
  std::vector<glm::dvec3> positions;  // of those, m: in the placed panels; sewn vertices have the mean
  std::vector<std::vector<std::array<std::uint32_t, 2>>> seam_edges;  // by seam: edges of the garment
  struct Join {
    std::string name;
    double length_a = 0, length_b = 0;  // m
    std::size_t edges = 0;
    double gap = 0;  // m: the largest distance between the two placed sides
  };
  std::vector<Join> joins;
};

// Throws Error(bad_input) with all problems at once: those of mesh_panel; seams that begin or end off the
// outline, have no length, overlap another one, or are sewn to themselves.
SizedGarment mesh_garment(const Garment& garment, const SizingOptions& options);

}  // namespace plisse::sizing
