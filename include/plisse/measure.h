// The waves on a mesh: how long, how high, how many, and which way they run.
#pragma once

#include <plisse/mesh.h>

#include <vector>

namespace plisse {

struct Wave {
  double wavelength = 0;  // metres
  double amplitude = 0;   // metres: the height is amplitude · cos over all of the surface
  Vector3 direction{};  // across the crests, unit, its largest component positive; 0 where they run all ways
  int count = 0;        // crests
};

struct WaveSpectrum {
  std::vector<Wave> waves;  // the strongest first; those of a tenth of its amplitude or more
  struct Bin {
    double wavelength = 0;  // metres
    double power = 0;       // metres²: the mean squared height that falls to it
  };
  std::vector<Bin> bins;  // from long to short, evenly in the logarithm
};

// The waves in the height of a mesh over a base surface, positive on the side of the base's normals; or over
// the mesh's own shape made smooth, where waves shorter than a third of its diagonal stay almost whole.
// Wavelengths are good to 1 % where a wave has eight vertices or more and the surface holds six waves or
// more; amplitudes to 5 %. Only positions and triangles are looked at. Throws Error(bad_input).
WaveSpectrum measure(const Mesh& mesh);
WaveSpectrum measure(const Mesh& mesh, const Mesh& base);

}  // namespace plisse
