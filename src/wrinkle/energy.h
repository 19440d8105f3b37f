// The wrinkle energy (27) of one face, in the amplitudes of its corners and its phase gradient, with exact
// derivatives. Z. Chen et al., Fine Wrinkling on Coarsely Meshed Thin Shells, ACM TOG 2021, section 3.5.
//
// Amplitude a is linear over the face, dφ constant, and the integrals of a² and a⁴ are taken exactly
// (docs/wrinkle.md). Not included: W¹_b, the base surface's own bending, which no wrinkle changes.
#pragma once

#include <Eigen/Dense>

#include "shell/material.h"
#include "wrinkle/surface.h"

namespace plisse::wrinkle {

struct Model {
  shell::Material material;
  bool v1 = true;  // without: waves cannot lean with the base surface's curvature (section 3.6)
  bool v2 = true;  // without: purely normal displacement
  // Multiplies W²; 1.44 makes it the one of the authors' program, for comparisons with it.
  double curvature_factor = 1;
  // W¹ as (21) has it also where both principal strains are compressive. Without, strain along the crests
  // counts as 0 there: tension field theory has such cloth slack, and what shortens it along the crests is
  // nothing that these waves could take up but by amplitudes that zigzag from vertex to vertex.
  bool crest_compression = false;
  // Without: ω has to close on wrinkle-free faces as well (section 5.1 and fig. 5 say why it must not).
  bool relaxed_integrability = true;
};

// S of W¹: the strain, but for what the model says of compression along the crests.
Eigen::Matrix2d wrinkled_strain(const FaceForms& forms, const Model& model);

// Local variables: a₀, a₁, a₂ (metres), then dφ's two components (radians per metre, in the face's frame).
using LocalVector = Eigen::Matrix<double, 5, 1>;
using LocalMatrix = Eigen::Matrix<double, 5, 5>;

class FaceEnergy {
 public:
  FaceEnergy(const FaceForms& forms, const Model& model);

  // Joules above what tension field theory leaves of the face's energy (appendix B), which no wrinkle can go
  // below: under tension that is most of it, and differences between fields would drown in its rounding.
  double value(const LocalVector& x) const;
  double gradient(const LocalVector& x, LocalVector& first) const;
  double hessian(const LocalVector& x, LocalVector& first, LocalMatrix& second) const;

  // That remainder, joules; the sum of both is the face's part of (27).
  double relaxed() const { return relaxed_; }

 private:
  struct Terms;
  Terms terms(const LocalVector& x) const;

  Eigen::Matrix<double, 2, 3> gradient_;
  Eigen::Matrix2d stress_;  // ½α tr(S) id + β S: ⟨S, vvᵀ⟩ = vᵀ stress v
  double relaxed_ = 0;
  double scale_ = 0;                                  // area h/4
  double constant_ = 0;                               // ‖S‖² less the relaxed one
  double curvature_ = 0;                              // W²/a²
  double square_ = 0;                                 // α/2 + β: ‖vvᵀ‖² = square |v|⁴
  double aligned_ = 0, crossed_ = 0;                  // of |da|²|dφ|² and (da·dφ)²
  double quartic_a_ = 0, quartic_ = 0, bending_ = 0;  // of |da|⁴, a⁴|dφ|⁴, a²|dφ|⁴
};

}  // namespace plisse::wrinkle
