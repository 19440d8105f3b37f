// The experiments of D. Zhang et al., SIGGRAPH 2025, section 5.2, as scenes of `plisse drape`, and the
// quantities measured on their equilibria. Metres, newtons.
#pragma once

#include <vector>

#include "cloth/drape_scene.h"

namespace plisse::bench {

// A rectangle from (0, 0) in the plane z = 0, meshed by sizing with edges of this length; `lines` at these x
// become edges.
struct EvenMesh {
  shell::Positions points;
  std::vector<shell::Face> faces;
};
EvenMesh even_mesh(double width, double height, double edge, const std::vector<double>& lines = {});
// The same from squares with alternating diagonals.
EvenMesh square_mesh(double width, double height, double edge);

// --- a strip over a table's edge (Fig. 18 a to c)

// B and E are the paper's; it gives no weight, length and width, so these are ours: 150 g/m², 60 mm beyond
// the edge, 25 mm wide (the strip of ASTM D1388). ν = 0, so that it bends as a beam does.
struct Strip {
  double bending = 2e-6, modulus = 1e6, weight = 0.15, length = 0.06, width = 0.025;
};
enum class StripMesh {
  irregular,  // clamped up to the table's edge
  regular,    // rows of squares, clamped up to half an edge before it, as a hinge represents both sides
};
cloth::DrapeScene strip_scene(const Strip& strip, double edge, StripMesh mesh, shell::Bending bending);
// Of the strip's end below the table, m.
double sag_of(const shell::Positions& positions);
// The same of an inextensible beam, by shooting: Bθ'' = −w(L − s) cos θ, θ(0) = 0, θ'(L) = 0.
double sag_of_beam(const Strip& strip);

// --- a sheet that is stretched between clamps (Fig. 16)

// 25 × 10 cm, h .1 mm, ν ½, longer by 12.78 %; E 1 MPa, which has no influence.
cloth::DrapeScene sheet_scene(double edge, bool stvk);
// The number of waves across the middle of the sheet that are higher than a tenth of the highest; and that
// height, m, half of crest to trough.
struct Crossing {
  double waves = 0, amplitude = 0;
};
Crossing waves_across(const cloth::DrapeScene& scene, const shell::Positions& positions);

// --- a curtain gathered to waves along its upper edge (Fig. 17, 18 d)

// One wave wide, between planes of symmetry: cos 2πx/λ where it is held; below, half of a wave twice as long
// also fits. It hangs under its weight.
struct Curtain {
  double wavelength = 0.01;  // of the upper edge, as gathered
  double compression = 0.2;  // δ: the cloth is 1/(1 − δ) wide
  double height = 0.2;
  double bending = 2e-6, modulus = 1e6, weight = 0.15;
};
// `guess`: where the start changes from one wave to the other, m below the edge.
cloth::DrapeScene curtain_scene(const Curtain& curtain, double edge, double guess);
// The depth below the upper edge at which half, and nine tenths, of the cloth's slack are in the long wave;
// m, −1 where there is none.
struct Transition {
  double half = -1, most = -1;
};
Transition transition_of(const Curtain& curtain, const cloth::DrapeScene& scene,
                         const shell::Positions& positions);

}  // namespace plisse::bench
