// Waves on a mesh by its own spectrum: no parametrisation, so sheets, tubes and anything else alike. The
// height f over a base is taken apart by the eigenvalues k² of the base's Laplacian (cotangent weights,
// lumped mass); how much of f lies where comes from the kernel polynomial method (A. Weiße, G. Wellein, A.
// Alvermann, H. Fehske, The Kernel Polynomial Method, Rev. Mod. Phys. 78, 2006), which needs no eigenvectors.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace plisse {

struct HeightField {
  std::vector<glm::dvec3> base;          // one a vertex: the place on the base, metres
  std::vector<double> height;            // f above it, metres
  std::vector<std::uint32_t> triangles;  // three vertices each
  // The part of a wave of wavenumber k that f holds is s k²/(1 + s k²): what was left in the base (metres²;
  // 0: f holds all of it).
  double smoothing = 0;
};

struct MeshWave {
  double wavelength = 0, amplitude = 0;  // metres: f = amplitude · cos over all of the surface
  glm::dvec3 direction{
      0};         // across the crests, unit, its largest component positive; 0 where they run all ways
  int count = 0;  // crests: connected regions above the middle
};

struct MeshSpectrum {
  std::vector<MeshWave> waves;  // the strongest first; those of a tenth of its amplitude or more
  struct Bin {
    double wavelength = 0, power = 0;  // metres, metres²: the mean of f² that falls to it
  };
  std::vector<Bin> bins;  // from long to short, evenly in the logarithm
};

// Good to 1 % of the wavelength where a wave has eight vertices or more and the surface holds at least six
// waves, and to 2 % with four, or along a ribbon narrower than a wave; to 5 % of the amplitude. The hill in
// the spectrum says which part of f is a wave; how long it is, its slopes and heights away from rims. Waves
// closer in k than some 2π over the surface's shorter side, or than a third of k, count as one.
MeshSpectrum measure_waves(const HeightField& field);

// The height of a mesh over itself made smooth: x − (M + sL)⁻¹M x along the normal, s = (diagonal/6π)², so
// that waves shorter than a third of the diagonal stay in f almost whole.
HeightField height_over_own_shape(const std::vector<glm::dvec3>& positions,
                                  const std::vector<std::uint32_t>& triangles);

// The height over the nearest point of another mesh, positive on the side of its normals.
HeightField height_over_base(const std::vector<glm::dvec3>& positions,
                             const std::vector<std::uint32_t>& triangles, const std::vector<glm::dvec3>& base,
                             const std::vector<std::uint32_t>& base_triangles);

}  // namespace plisse
