// Wavelengths that vary over the cloth, from a picture or a table (Loviscach 2006, section 9: "one can
// control the wavelength of the wrinkles through another texture").
#pragma once

#include <glm/glm.hpp>

#include "config/settings.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"

namespace plisse::scene {

// Scales the wavelengths, which are `settings.wavelength` but for irregularity, to what
// settings.wavelength_map says: a PLY with x, y, z and wavelength of every vertex of the rest pose, whose
// space `to_world` takes to metres and y up; or a picture in uv, whose brightness times alpha leads from
// wavelength_low to wavelength. Vertices without uv keep theirs. Throws Error(bad_input) where vertices are
// missing, a wavelength is not above 0, or a picture finds no uv.
void take_wavelengths(const Surface& surface, const config::WrinkleSettings& settings,
                      const glm::dmat4& to_world, VertexWaves& waves);

}  // namespace plisse::scene
