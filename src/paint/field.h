// Solved wrinkle fields as wrinkles of the rest pose (docs/passes.md, "Fields"): mapped to the welded
// surface, and converted to the initial state of crush and relax.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/wrinkle_field.h"
#include "mesh/solved_clip.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"

namespace plisse::paint {

// A field on the surface that it was solved on: the passes' rest pose.
struct SurfaceField {
  std::vector<double> amplitude;             // a, metres, one a welded vertex
  std::vector<std::array<double, 3>> phase;  // φ, radians, one a corner of every triangle of the surface
};

// Finds each vertex of the field among the surface's by its position. `to_world` maps the file's space to
// metres and y up. Throws Error(bad_input) naming `file` where a vertex or a triangle has no counterpart: the
// field was solved on another surface than the model's rest pose.
SurfaceField field_on(const Surface& surface, const io::WrinkleField& field, const glm::dmat4& to_world,
                      const std::string& file);

// ∇φ of every vertex, radians per metre, tangent to the rest pose; 0 where the amplitude is. Its mean with
// the neighbour's gradient reproduces the phase difference along each edge, which is the condition of relax.
std::vector<glm::dvec3> phase_gradients(const Surface& surface, const RestFrames& rest,
                                        const SurfaceField& field);

// s = 1 − r with √(1−r²)/r · ease(s) = 2aω/π, at most 1 − r_min: the share of cloth that has to be gathered
// for waves of amplitude a and wavelength 2π/ω. `steepness` = aω.
double gathered_for(double steepness, double dead_zone);

// The field as bias: bias and wavelength such that crush, at rest, gives h = a and κ = ∇φ/2π; direction and
// phase to start from. Vertices without amplitude keep their values.
void field_as_bias(const Surface& surface, const RestFrames& rest, const SurfaceField& field,
                   double dead_zone, VertexWaves& waves);

// The field to be carried unchanged: in each triangle, the phase of every corner with the gradient of its
// vertex. Where a vertex's gradient predicts a neighbour's phase with an error above half a turn, or the mean
// of both with one above a quarter (around a singularity), or where the amplitude is 0, its phase is
// interpolated linearly between the corners instead. Amplitudes are multiplied by `mask`, one a welded
// vertex: the scene's strength, 0 for excluded parts. gradients: of the phases, as phase_gradients gives
// them, where they are known better; empty: those.
std::vector<FieldTriangle> field_directly(const Surface& surface, const RestFrames& rest,
                                          const SurfaceField& field, const std::vector<double>& mask,
                                          std::vector<glm::dvec3> gradients = {});

// The waves of a cloth that was solved for a frame, carried unchanged: one a triangle of the surface, none
// where the cloth is not. mask: one a welded vertex of the surface. gradients: of the cloth's vertices, as
// above.
std::vector<FieldTriangle> field_of_cloth(const Surface& surface, const SolvedClip& clip, std::size_t index,
                                          const std::vector<double>& mask,
                                          const std::vector<glm::dvec3>& gradients = {});

}  // namespace plisse::paint
