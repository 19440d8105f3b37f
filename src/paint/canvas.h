// The surface that strokes are painted on, and their result: one vector per welded vertex, the bias of crush
// (docs/passes.md; Loviscach 2006, section 7).
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "config/paint_settings.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"
#include "paint/field.h"

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
  std::function<Screen(const config::PaintStroke&)> look = {};  // the picture for a stroke of kind screen
  std::function<SurfaceField(const config::PaintStroke&)> field = {};  // what a stroke of kind field has
  double dead_zone = 0.005;  // of crush, which a field's p make up for
};

// What strokes leave, one of each welded vertex.
struct Painting {
  std::vector<glm::dvec3> bias;  // p, tangent to the rest pose, |p| ≤ .99, 0 where nothing was painted
  // Waves of solved fields: ∇φ, radians per metre of the rest pose, on the side of p; 0 for those that the
  // passes find themselves; and φ, radians.
  std::vector<glm::dvec3> gradient;
  std::vector<double> phase;

  explicit Painting(std::size_t vertices = 0)
      : bias(vertices, glm::dvec3(0)), gradient(vertices, glm::dvec3(0)), phase(vertices, 0) {}
  bool has_waves() const;
};

// What crush and relax begin with: bias; where there are solved waves their direction, phase and wavelength,
// W = 2π/((1 − |p|²)|∇φ|), so that at rest they are as long as they were solved (docs/passes.md, "Fields").
void take_painting(const Painting& painting, VertexWaves& waves);

// The painting after all strokes in order. A field's waves stay where later strokes are weaker than one half.
// Throws Error(bad_input) with the stroke's place in the file for a stroke that misses the surface, names an
// unknown mesh or material, needs uv where there is none, or whose file does not fit.
Painting paint(const Canvas& canvas, const std::vector<config::PaintStroke>& strokes);

}  // namespace plisse::paint
