// <plisse/measure.h>: the waves on meshes in memory.
#include "plisse/measure.h"

#include "api/convert.h"
#include "mesh/measure_waves.h"

namespace plisse {
namespace {

WaveSpectrum spectrum_of(const HeightField& heights) {
  const MeshSpectrum found = measure_waves(heights);
  WaveSpectrum result;
  for (const MeshWave& wave : found.waves)
    result.waves.push_back({wave.wavelength, wave.amplitude, api::from_glm(wave.direction), wave.count});
  for (const MeshSpectrum::Bin& bin : found.bins) result.bins.push_back({bin.wavelength, bin.power});
  return result;
}

}  // namespace

WaveSpectrum measure(const Mesh& mesh) {
  api::check_surface("mesh", mesh.positions, mesh.triangles);
  return spectrum_of(height_over_own_shape(api::points_to_glm(mesh.positions), api::flat(mesh.triangles)));
}

WaveSpectrum measure(const Mesh& mesh, const Mesh& base) {
  api::check_surface("mesh", mesh.positions, mesh.triangles);
  api::check_surface("base", base.positions, base.triangles);
  return spectrum_of(height_over_base(api::points_to_glm(mesh.positions), api::flat(mesh.triangles),
                                      api::points_to_glm(base.positions), api::flat(base.triangles)));
}

}  // namespace plisse
