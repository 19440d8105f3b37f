// Where the solve starts (Chen et al. 2021, section E.2, with a length scale of the scene's own).
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "wrinkle/problem.h"

namespace plisse::wrinkle {

// What is known of a face's waves from its own strain and curvature.
struct LocalWaves {
  double compression = 0;  // s₀ = −(λ₂ + ν max(λ₁, 0)), taken up by waves where positive
  double amplitude = 0;    // a, metres
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  // dφ, radians per metre; of either sign
};

// The waves that would be best were the face's strain and curvature everywhere and amplitudes sin(rate x)
// along the crest: |ω|⁴ = 12(1 − ν²)/h² (κ² + ½λ₁ rate²), where κ is ŵ⊥ᵀII_b ŵ⊥, and ½a²|ω|² = s₀ − s_crit
// where that is positive, s_crit = 2(1 − ν²)(κ² + ½λ₁ rate²)/|ω|² + h²|ω|²/6. (With one of κ, λ₁ zero these
// are the cylinder's waves and those of Cerda and Mahadevan 2003.) rate, least: radians per metre; |ω| is
// not below `least`. `frequency` multiplies |ω|.
LocalWaves local_waves(const FaceForms& forms, const Model& model, double rate, double least,
                       double frequency = 1);

// Of every live face; nothing elsewhere. The scene's own lengths: rate = π/L where the crest through the face
// ends at vertices without amplitude L apart (half of that where one of its ends is free, 0 where both are),
// least = one wave over the root of its patch's area.
std::vector<LocalWaves> local_waves(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                                    const std::vector<bool>& live, const std::vector<bool>& pinned,
                                    const Model& model, double frequency = 1);

// Signs of the faces' gradients agree along a maximum spanning tree; the one-form is the nearest closed one
// (least squares, weighted by area and compression), the amplitudes are means over the faces round a vertex.
Waves initial_waves(const Problem& problem, double frequency = 1);

}  // namespace plisse::wrinkle
