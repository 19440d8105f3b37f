// All second derivatives of what is given at a shell's vertices, as sums over them: with the Laplacian alone
// a free end could be curved one way as much as the other at no cost, and tubes would flare.
//
// O. Stein, E. Grinspun, M. Wardetzky and A. Jacobson, Natural Boundary Conditions for Smoothing in Geometry
// Processing, ACM TOG 37 (2018).
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "shell/rest_shape.h"

namespace plisse::shell {

// −∫ ∇φ ⊗ ∇u over the ring of a vertex, φ its hat function: its cell's area times the Hessian of u. Three
// rows: uu, vv and √2 uv, so that the sum of their squares is area² |∇²u|²; each over the vertices of the
// ring.
struct HessianRows {
  std::uint32_t vertex;
  std::array<std::vector<std::pair<std::uint32_t, double>>, 3> integral;
};

// Of the inner vertices. Rings are laid flat, their angles scaled to a whole turn; on flat rest shapes linear
// functions have none.
std::vector<HessianRows> hessian_rows(const Topology& topology, const std::vector<RestFace>& rest);

}  // namespace plisse::shell
