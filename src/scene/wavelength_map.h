// Wavelengths that vary over the cloth, from a picture or a table (Loviscach 2006, section 9: "one can
// control the wavelength of the wrinkles through another texture").
#pragma once

#include <glm/glm.hpp>

#include "config/settings.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"

namespace plisse::scene {

// Scales the wavelengths, which are `settings.wavelength` except for irregularity, to those of
// settings.wavelength_map: a PLY with x, y, z and wavelength of every vertex of the rest pose, where
// `to_world` maps its space to metres and y up; or a picture in uv, whose brightness times alpha interpolates
// from wavelength_low to wavelength. Vertices without uv keep their wavelength. Throws Error(bad_input) where
// vertices are missing, a wavelength is not above 0, or a picture is given for a model without uv.
void take_wavelengths(const Surface& surface, const config::WrinkleSettings& settings,
                      const glm::dmat4& to_world, VertexWaves& waves);

}  // namespace plisse::scene
