// Waves on a mesh from its own spectrum. No parametrisation is needed, so it works for sheets, tubes and any
// other surface. The height f over a base is decomposed by the eigenvalues k² of the base's Laplacian
// (cotangent weights, lumped mass); the power of f over k is computed by the kernel polynomial method (A.
// Weiße, G. Wellein, A. Alvermann, H. Fehske, The Kernel Polynomial Method, Rev. Mod. Phys. 78, 2006), which
// needs no eigenvectors.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace plisse {

struct HeightField {
  std::vector<glm::dvec3> base;          // one a vertex: the place on the base, metres
  std::vector<double> height;            // f above it, metres
  std::vector<std::uint32_t> triangles;  // three vertices each
  // f contains the part s k²/(1 + s k²) of a wave of wavenumber k; the rest is in the base (metres²; 0: f
  // contains all of it).
  double smoothing = 0;
};

struct MeshWave {
  double wavelength = 0, amplitude = 0;  // metres: f = amplitude · cos over all of the surface
  glm::dvec3 direction{
      0};  // across the crests, unit, its largest component positive; 0 where they have no common direction
  int count = 0;  // crests: connected regions above the middle
};

struct MeshSpectrum {
  std::vector<MeshWave> waves;  // the strongest first; those of a tenth of its amplitude or more
  struct Bin {
    double wavelength = 0, power = 0;  // metres, metres²: its share of the mean of f²
  };
  std::vector<Bin> bins;  // from long to short, evenly in the logarithm
};

// Good to 1 % of the wavelength where a wave has eight vertices or more and the surface holds at least six
// waves, and to 2 % with four, or along a ribbon narrower than a wave; to 5 % of the amplitude. A peak of the
// spectrum selects the part of f that is a wave; its length follows from slopes and heights away from the
// boundary. Waves whose k differ by less than about 2π over the surface's shorter side, or by less than a
// third of k, count as one.
MeshSpectrum measure_waves(const HeightField& field);

// The height of a mesh over itself made smooth: x − (M + sL)⁻¹M x along the normal, s = (diagonal/6π)², so
// that f contains almost all of the waves that are shorter than a third of the diagonal.
HeightField height_over_own_shape(const std::vector<glm::dvec3>& positions,
                                  const std::vector<std::uint32_t>& triangles);

// The height over the nearest point of another mesh, positive on the side of its normals.
HeightField height_over_base(const std::vector<glm::dvec3>& positions,
                             const std::vector<std::uint32_t>& triangles, const std::vector<glm::dvec3>& base,
                             const std::vector<std::uint32_t>& base_triangles);

}  // namespace plisse
