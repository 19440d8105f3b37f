// What of a base surface's strain is none: a rig's stretch is more than cloth's, a curved surface's facets
// are chords of it, shorter than the cloth that they stand for, and below some strain there is nothing but
// rounding.
#pragma once

#include <vector>

#include "shell/material.h"
#include "wrinkle/surface.h"

namespace plisse::wrinkle {

// Takes the tension beyond a limit out of each face's strain (shell::elastic_strain): a rig stretches what
// cloth would not. limit: of λ₁, twice the Green strain; 0: none.
void limit_tension(std::vector<FaceForms>& forms, const shell::Material& material, double limit);

// Takes the facets' part out of each face's compression λ₂. An edge of rest length l with normal curvature κ
// is a chord, chord² = l²(1 − (κl)²/12), so that the strain lacks C with eᵀCe = (eᵀII_b e)²/12 on all three
// edges e: ŵᵀCŵ is added along ŵ, up to no compression at all. For solved surfaces with a flat or smooth
// rest shape only: a simulation's facets have their full length, and what it compresses them by is meant.
void correct_chords(std::vector<FaceForms>& forms);

// Sets FaceForms::noise: what rounding of the positions makes (of doubles, or of single precision where all
// of them are such numbers), what the base surface's own solver leaves, where `chords` what curvature that is
// fitted leaves of the facets' part, and in a patch of faces that are compressed by more than that the
// compression below which not even one wave over the whole patch could stand, h²ω²/6.
void find_noise(std::vector<FaceForms>& forms, const BaseSurface& surface, const shell::Material& material,
                bool chords);

}  // namespace plisse::wrinkle
