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
  bool v1 = true;  // without: no tangential displacement due to the base surface's curvature (section 3.6)
  bool v2 = true;  // without: purely normal displacement
  // Multiplies W²; 1.44 gives that of the authors' program, for comparisons.
  double curvature_factor = 1;
  // Uses W¹ of (21) also where both principal strains are compressive. Without, the strain along the crests
  // counts as 0 there: such cloth is slack in tension field theory, and these waves could take up compression
  // along their crests only by amplitudes that alternate from vertex to vertex.
  bool crest_compression = false;
  // Without: ω must be closed on wrinkle-free faces as well (section 5.1 and fig. 5 show why it should not
  // be).
  bool relaxed_integrability = true;
};

// S of W¹: the strain, except for compression along the crests (Model::crest_compression).
Eigen::Matrix2d wrinkled_strain(const FaceForms& forms, const Model& model);

// Local variables: a₀, a₁, a₂ (metres), then dφ's two components (radians per metre, in the face's frame).
using LocalVector = Eigen::Matrix<double, 5, 1>;
using LocalMatrix = Eigen::Matrix<double, 5, 5>;

class FaceEnergy {
 public:
  FaceEnergy(const FaceForms& forms, const Model& model);

  // Joules above the face's relaxed energy of tension field theory (appendix B), the lower bound for any
  // wrinkles. Under tension the relaxed energy is most of the total, and its rounding would hide differences
  // between fields.
  double value(const LocalVector& x) const;
  double gradient(const LocalVector& x, LocalVector& first) const;
  double hessian(const LocalVector& x, LocalVector& first, LocalMatrix& second) const;

  // The sum of its summands' absolute values, J: what rounding is relative to.
  double magnitude(const LocalVector& x) const;

  // M, positive semidefinite, J by the same units as the Hessian: |dφ|²(mean of δa² + |dδa|²/|dφ|²) +
  // (mean of a²)|δdφ|², times the stress of the compression that waves take up or ought to. What makes the
  // Hessian indefinite is at most of this size, and where waves change by a part t of themselves it is t²
  // times the energy that they take up.
  void metric(const LocalVector& x, LocalMatrix& metric) const;

  // What M multiplies δa² with in the mean, J/m²: its stress times |dφ|². a² t² times it is about the energy
  // taken up, where waves change by a part t of themselves, in height, or in phase by t radians.
  double taken_up(const LocalVector& x) const;

  // The relaxed energy, joules; the sum of both is the face's part of (27).
  double relaxed() const { return relaxed_; }

 private:
  struct Terms;
  Terms terms(const LocalVector& x) const;
  double metric_weight(const LocalVector& x, double second_mean) const;

  Eigen::Matrix<double, 2, 3> gradient_;
  Eigen::Matrix2d stress_;  // ½α tr(S) id + β S: ⟨S, vvᵀ⟩ = vᵀ stress v
  double relaxed_ = 0;
  double scale_ = 0;                                  // area h/4
  double constant_ = 0;                               // ‖S‖² less the relaxed one
  double curvature_ = 0;                              // W²/a²
  double compression_ = 0;                            // s₀, where positive
  double square_ = 0;                                 // α/2 + β: ‖vvᵀ‖² = square |v|⁴
  double aligned_ = 0, crossed_ = 0;                  // of |da|²|dφ|² and (da·dφ)²
  double quartic_a_ = 0, quartic_ = 0, bending_ = 0;  // of |da|⁴, a⁴|dφ|⁴, a²|dφ|⁴
};

}  // namespace plisse::wrinkle
