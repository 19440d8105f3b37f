// A solved field under an animation: its waves keep their number and their place on the cloth, and take up
// what the animation leaves of the cloth's length across their crests (docs/passes.md, "Fields").
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface.h"
#include "mesh/vertex_waves.h"

namespace plisse::paint {

// Length of a cosine over the length of its axis: `slope` = aω ≥ 0, the steepest. And the slope of a cosine
// of this length, 0 below 1; within 1e-5 of the slope.
double arc_length(double slope);
double slope_of_length(double length);

class CarriedField {
 public:
  // `at_rest`: as solved, over surface.rest. `mask`: of each welded vertex, multiplies the amplitude after
  // all.
  CarriedField(const Surface& surface, std::vector<FieldTriangle> at_rest, std::vector<double> mask);

  // Of each welded vertex: the unit direction of the rest pose in which its phase grows; 0 without waves.
  const std::vector<glm::dvec3>& along() const { return along_; }

  // The field with the welded vertices at `posed`, metres: where the cloth along a wave is λ times as long as
  // at rest, its slope goes from s to the one with arc_length(s)/λ, and its amplitude to λ/ω times that; 0
  // where the cloth is pulled flat.
  std::vector<FieldTriangle> in(const std::vector<glm::dvec3>& posed) const;

 private:
  const Surface& surface_;
  std::vector<FieldTriangle> at_rest_;
  std::vector<double> mask_;
  std::vector<glm::dvec3> along_;
  std::vector<double> omega_;  // radians per metre, of each welded vertex; 0 without waves
};

}  // namespace plisse::paint
