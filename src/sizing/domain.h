// A panel prepared for meshing: every line is checked, cut where lines meet, and transformed to working
// coordinates, in which the fabric's own resolution is the same in all directions.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "sizing/panel.h"

namespace plisse::sizing {

struct Domain {
  // A piece of the outline, of a hole or of a feature that meets other pieces only at its ends; closed if it
  // meets none.
  struct Line {
    Polyline shape;  // working coordinates
    bool boundary = false;
    int curve = 0;  // pieces of one curve: outline 0, holes 1 …, then features and the lines beside folds
    std::vector<int> features;  // that run along it, indices into Panel::features
    int fold = -1;              // of a fold's three lines: the feature, and which of them it is
    int fold_side = 0;          // −1, 0, 1
    double seam_size = 0;  // edge length in working coordinates for the other side of its seam; 0: no limit
  };

  glm::dmat2 to_working{1}, to_panel{1};  // linear: p ↦ to_working · p
  glm::dvec2 resolution{0};               // of the fabric alone, (weft, warp), m
  double size = 0;                        // the same in working coordinates: resolution.x
  std::vector<Polyline> boundary;         // outline, then holes; working coordinates, uncut
  std::vector<Line> lines;                // those of the boundary first
  std::size_t boundary_lines = 0;
  glm::dvec2 low{0}, high{0};         // bounds of the outline, working coordinates
  std::vector<std::string> warnings;  // features that were cut at the outline

  bool inside(const glm::dvec2& working) const;
};

// Throws Error(bad_input) with all problems of the panel at once: outlines of no area or that cross
// themselves, holes outside, features of no length or wholly outside.
Domain prepare(const Panel& panel, const SizingOptions& options);

}  // namespace plisse::sizing
