// What the wrinkles of each welded vertex are like, whatever the pose.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace plisse {

// A solved wrinkle field over one triangle, carried as it is (docs/passes.md, "Fields").
struct FieldTriangle {
  // turns[j][k]: the phase, in turns, that corner j's plane wave has at corner k; a common whole number is
  // left out.
  std::array<std::array<double, 3>, 3> turns{};
  std::array<double, 3> amplitude{};  // metres, of the corners
};

// All of length V, but for what may be empty.
struct VertexWaves {
  std::vector<double> wavelength;  // W, metres of the rest pose, > 0
  std::vector<double> mask;        // 0…1 times the strength; multiplies h
  // D, in wavelengths, a vector of the rest pose: k·D turns are added to the phase when the wave is drawn. A
  // vector, since k's sign is any: turned over, the phase counts the other way, and so must what is added.
  std::vector<glm::dvec3> wander;
  // p of docs/passes.md, "Crush": tangent vectors of the rest pose along which the cloth counts as shortened
  // by |p|² (p and −p mean the same), |p| < 1; empty: none.
  std::vector<glm::dvec3> bias = {};
  // Where waves are there from the beginning, as of solved fields: ±k, unit, tangent to the rest pose and
  // along the bias, 0 for vertices that start without; and their phases, radians, with which they also come
  // back after they were gone. Empty: none.
  std::vector<glm::dvec3> start_direction = {};
  std::vector<double> start_phase = {};
  // Along which a carried field takes up what the animation does, so that crush has no part in it: unit, of
  // the rest pose and tangent to it, 0 elsewhere. Empty: nowhere.
  std::vector<glm::dvec3> carried = {};
  // What the animation does to the cloth has no part in its waves: `bias` is of each pose itself, tangent to
  // it, as W is.
  bool unstrained = false;
  std::vector<FieldTriangle> field = {};  // one a triangle of the surface, or none
};

}  // namespace plisse
