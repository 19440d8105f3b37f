// The surface that strokes are painted on, and their result: one vector per welded vertex, the bias of crush
// (docs/passes.md; Loviscach 2006, section 7).
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "config/paint_settings.h"
#include "mesh/surface.h"

namespace plisse::paint {

// A picture of one moment, for strokes that are drawn on it. Positions are of the welded vertices, in the
// unit of view_projection's input, whichever that is.
struct Screen {
  glm::dmat4 view_projection{1};
  int width = 1, height = 1;
  std::vector<glm::dvec3> positions;
};

struct Canvas {
  const Surface& surface;
  const RestFrames& rest;
  std::function<Screen(const config::PaintStroke&)> look;  // the picture for a stroke of kind screen
};

// p of every welded vertex after all strokes in order, tangent to the rest pose, 0 where nothing was painted,
// |p| ≤ .99. Throws Error(bad_input) with the stroke's place in the file for a stroke that misses the
// surface, names an unknown mesh or material, needs uv where there is none, or whose file does not fit.
std::vector<glm::dvec3> paint(const Canvas& canvas, const std::vector<config::PaintStroke>& strokes);

}  // namespace plisse::paint
