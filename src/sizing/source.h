// Sources: lines where a panel's mesh must be finer than its fabric needs, with their transitions.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "sizing/panel.h"

namespace plisse::sizing {

// Lines (or points: lines of one point) with one resolution and one transition in each direction of the
// fabric.
struct Source {
  int feature = 0;  // index into Panel::features
  Transition weft, warp;
  std::vector<Polyline> lines;  // panel coordinates, m
  bool filled = false;          // closed lines: their interior is at distance 0 as well
  std::optional<glm::dvec2>
      forward;  // a unit vector: only points on this side of the (one) point are affected
};

// r of the fabric alone, (weft, warp), m.
glm::dvec2 fabric_resolution(const Panel& panel, const SizingOptions& options);

// Features that need no finer mesh (a stitch on the shorter side, a flat fold) have none. Throws
// Error(bad_input) naming feature and value.
std::vector<Source> sources_of(const Panel& panel, const SizingOptions& options);

}  // namespace plisse::sizing
