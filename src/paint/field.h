// Solved wrinkle fields as wrinkles of the rest pose (docs/passes.md, "Fields"): laid onto the welded
// surface, and from there into what crush and relax start with.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/wrinkle_field.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"

namespace plisse::paint {

// A field on the surface that it was solved on: the passes' rest pose.
struct SurfaceField {
  std::vector<double> amplitude;             // a, metres, one a welded vertex
  std::vector<std::array<double, 3>> phase;  // φ, radians, one a corner of every triangle of the surface
};

// Finds each of the field's vertices among the surface's by its place. `to_world` takes the file's space to
// metres and y up. Throws Error(bad_input) naming `file` where a vertex or a triangle has no counterpart: the
// field was solved on another surface than the model's rest pose.
SurfaceField field_on(const Surface& surface, const io::WrinkleField& field, const glm::dmat4& to_world,
                      const std::string& file);

// ∇φ of every vertex, radians per metre, tangent to the rest pose; 0 where the amplitude is. It is the one
// whose mean with the neighbours' reproduces the differences of phase along the edges, as relax will ask for.
std::vector<glm::dvec3> phase_gradients(const Surface& surface, const RestFrames& rest,
                                        const SurfaceField& field);

// s = 1 − r with √(1−r²)/r · ease(s) = 2aω/π, at most 1 − r_min: how much cloth has to be gathered for waves
// of amplitude a and wavelength 2π/ω. `steepness` = aω.
double gathered_for(double steepness, double dead_zone);

// The field as bias: bias and wavelength such that crush, at rest, gives h = a and κ = ∇φ/2π; direction and
// phase to start from. Vertices of no amplitude keep what they have.
void field_as_bias(const Surface& surface, const RestFrames& rest, const SurfaceField& field,
                   double dead_zone, VertexWaves& waves);

// The field to be carried as it is: every corner's phase with its vertex's gradient, in the triangle. Where a
// vertex's gradient does not bring it to its neighbours' phases within a quarter of a turn (round a
// singularity, or where the amplitude is 0) its planes are linear between the corners instead. Amplitudes are
// multiplied by `mask`, one a welded vertex: the scene's strength, 0 where a part is selected out.
std::vector<FieldTriangle> field_directly(const Surface& surface, const RestFrames& rest,
                                          const SurfaceField& field, const std::vector<double>& mask);

}  // namespace plisse::paint
