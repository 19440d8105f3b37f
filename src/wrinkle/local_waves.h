// The waves of a face from its own strain and curvature: the start of the search (Chen et al. 2021, section
// E.2, with a length scale from the scene), and the scale of its unknowns.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "wrinkle/energy.h"

namespace plisse::wrinkle {

struct LocalWaves {
  double compression = 0;  // s₀ = −(λ₂ + ν max(λ₁, 0)), taken up by waves where positive
  double stiffness = 0;    // K = κ² + ½λ₁ rate², 1/m²: the stiffness that makes waves short
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  // dφ, radians per metre; of either sign

  // s_crit = 2(1 − ν²) K/|ω|² + h²|ω|²/6: waves of this frequency (radians per metre) exist only above this
  // compression.
  double critical(const Model& model, double frequency) const;
};

// The optimal waves if the face's strain and curvature were constant everywhere and the amplitude were
// sin(rate x) along the crest: |ω|⁴ = 12(1 − ν²)/h² K, where κ = ŵ⊥ᵀII_b ŵ⊥. (With λ₁ = 0 these are the waves
// of a cylinder, with κ = 0 those of Cerda and Mahadevan 2003.) rate, least: radians per metre; |ω| is not
// below `least`.
LocalWaves local_waves(const FaceForms& forms, const Model& model, double rate, double least);

// For every live face; default values elsewhere. Lengths from the scene: rate = π/L where the crest through
// the face ends at vertices without amplitude at a distance L (half of that if one end is free, 0 if both
// are), least = one wave over the root of its patch's area.
std::vector<LocalWaves> local_waves(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                                    const std::vector<bool>& live, const std::vector<bool>& pinned,
                                    const Model& model);

// The amplitude (metres) for waves of this dφ on the face: ½a²|ω|² = s₀ − s_crit, s₀ the
// compression along them, 0 where that is not positive.
double best_amplitude(const FaceForms& forms, const Model& model, const LocalWaves& local,
                      const Eigen::Vector2d& gradient);

}  // namespace plisse::wrinkle
