// The vertices that a stroke touches, for all kinds of strokes.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "paint/canvas.h"

namespace plisse::paint {

// One vertex that a stroke touches.
struct Touch {
  std::uint32_t vertex = 0;
  double amount = 1;     // how far p moves toward the stroke's own vector, 0…1
  glm::dvec3 vector{0};  // that vector divided by the strength: in the rest pose, tangent, length 0…1; p and
                         // −p are the same
  // Of a solved field's wave: ∇φ, on the side of `vector`, and φ (Painting); else 0.
  glm::dvec3 gradient{0};
  double phase = 0;
};

// One function for each kind; `only` and `exclude` are not yet applied.
std::vector<Touch> touched_on_screen(const Canvas& canvas, const config::PaintStroke& stroke);
std::vector<Touch> touched_on_surface(const Canvas& canvas, const config::PaintStroke& stroke);
std::vector<Touch> touched_in_uv(const Canvas& canvas, const config::PaintStroke& stroke);
std::vector<Touch> touched_by_image(const Canvas& canvas, const config::PaintStroke& stroke);
std::vector<Touch> touched_by_colours(const Canvas& canvas, const config::PaintStroke& stroke);
std::vector<Touch> touched_by_painted(const Canvas& canvas, const config::PaintStroke& stroke);
std::vector<Touch> touched_by_field(const Canvas& canvas, const config::PaintStroke& stroke);
std::vector<Touch> touched_by_fill(const Canvas& canvas, const config::PaintStroke& stroke);
// Random folds, one list each: they are blended one after the other.
std::vector<std::vector<Touch>> touched_at_random(const Canvas& canvas, const config::PaintStroke& stroke);

// Error(bad_input) with the stroke's place in the file.
[[noreturn]] void fail(const config::PaintStroke& stroke, const std::string& what);

// 1 on the line to 0 at the radius; part = distance/radius.
double falloff(config::PaintStroke::Falloff kind, double part);

// The nearest point of a polyline (or a single point).
struct OnLine {
  double distance = 0;
  glm::dvec3 tangent{0};  // unit, 0 for a single point
};
OnLine nearest_on_line(const std::vector<glm::dvec3>& points, const glm::dvec3& x);

// The tangential part of a vector at a vertex of the rest pose, normalised; 0 where this part is very small.
glm::dvec3 tangent_part(const Canvas& canvas, std::uint32_t vertex, const glm::dvec3& vector);

// The direction of a stroke with an angle or a vector at every welded vertex; empty for the other directions.
// An angle needs uv: vertices without uv get 0, and if none has uv the stroke is an error.
std::vector<glm::dvec3> fixed_directions(const Canvas& canvas, const config::PaintStroke& stroke);

// Whether the stroke may touch each welded vertex, by its `only` and `exclude`.
std::vector<bool> allowed_vertices(const Canvas& canvas, const config::PaintStroke& stroke);
bool allows(const config::PaintStroke& stroke, const Part& part);

}  // namespace plisse::paint
