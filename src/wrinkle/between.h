// From a field of one frame to those of others: on another frame's faces, between two frames, over from one
// field to an unlike one. Everywhere a vertex with amplitude has one phase, up to whole turns.
#pragma once

#include "wrinkle/problem.h"
#include "wrinkle/upsample.h"

namespace plisse::wrinkle {

// `field` on the problem's live faces: its phases are closed again (least squares, weighted by area and a²)
// with periods rounded, faces without its waves continue their neighbours' ones, or start with their own
// where no neighbour has any. One phase of every patch is free (see `align`). Amplitudes are the field's.
Waves carried(const Problem& problem, const CoarseField& field);

// Amplitudes from which new waves can grow: those of `waves`, or a twentieth of the faces' own ones where
// that is more and `waves` has none at some free vertex. (a = 0 stays so by symmetry, the energy being even
// in it.)
Eigen::VectorXd seeded(const Problem& problem, const Waves& waves);

// a and φ at `share` (0 … 1) of the way between two fields of one topology: amplitudes linear; the difference
// of phase is unwrapped over each patch from its highest vertex, highest first, and added in that share. A
// vertex with amplitude in one field alone takes that field's phase and its neighbours' difference.
CoarseField interpolated(const shell::Topology& topology, const CoarseField& from, const CoarseField& to,
                         double share);

// z = (1 − share) a exp(iφ) of one field + share a exp(iφ) of the other, on faces where both have phases: the
// phases of the field with the larger share, plus the change that the other one causes; never by more than
// half a turn.
CoarseField cross_faded(const std::vector<shell::Face>& faces, const CoarseField& from, const CoarseField& to,
                        double share);

// Adds to the phases of each patch (faces with waves that share sides) of `field` the one number for which it
// is nearest to `reference`, least squares of a exp(iφ) by area; before, changes their sign where the
// gradients are opposite on average.
void align(const shell::Topology& topology, const std::vector<FaceForms>& forms, const CoarseField& reference,
           CoarseField& field);

// Radians: root mean square of the angle between two fields' a exp(iφ), weighted by area and both amplitudes;
// 0 where one of them has no waves.
double phase_step(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                  const CoarseField& before, const CoarseField& now);

// Whether a corner of the face has amplitude.
bool has_waves(const CoarseField& field, const shell::Face& face);

}  // namespace plisse::wrinkle
