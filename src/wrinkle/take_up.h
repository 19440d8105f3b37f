// What of a base surface's compression the waves of its field take up.
#pragma once

#include "shell/material.h"
#include "wrinkle/surface.h"
#include "wrinkle/upsample.h"

namespace plisse::wrinkle {

struct TakeUp {
  // Twice the Green strain, mean over the rest area: s₀ = −(λ₂ + ν max(λ₁, 0)) where positive, which waves
  // could take up, and −λ₁ where that is positive, which they cannot.
  double compression = 0;
  double untaken = 0;     // the share of it that is left: waves take up ½a²|ω|² in the mean, ≤ s₀
  double wavelength = 0;  // 2π/|ω|, metres: the median by area times a²|ω|²; 0 where there are no waves
  // Radians: between crests and the direction of λ₁, the median by area; 0 where there are no waves. (Folds
  // lie along the tension.)
  double crest_angle = 0;
  double where_compressed = 1;  // the share of ∫ a² that lies where λ₂ < 0; 1 where there are no waves
};
TakeUp take_up(const shell::Topology& topology, const std::vector<FaceForms>& forms,
               const shell::Material& material, const CoarseField& field);

}  // namespace plisse::wrinkle
