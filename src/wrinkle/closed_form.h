// The closed one-form nearest to given gradients of the faces.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "wrinkle/problem.h"

namespace plisse::wrinkle {

// Least squares Σ weight |dφ + Σ τ_k γ_k − gradient|² over live faces; one gradient (radians per metre, in
// the face's frame) and one weight ≥ 0 a face. One phase of every patch is undetermined and becomes small.
// `fixed`: the periods, if they are given. The amplitudes of the result are 0.
Waves nearest_closed(const Problem& problem, const std::vector<Eigen::Vector2d>& gradients,
                     const std::vector<double>& weights, const Eigen::VectorXd* fixed = nullptr);

}  // namespace plisse::wrinkle
