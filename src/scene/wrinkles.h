// The wave parameters of a surface: selection of parts, wavelength, the fade toward stiff parts,
// irregularity.
#pragma once

#include "config/settings.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"

namespace plisse::scene {

// Switches off the parts that --only and --exclude leave out, and those that are bodies by their mesh's or
// material's name. Throws Error(bad_input) for a name of the settings that is neither a mesh nor a material,
// listing those there are.
void select_parts(Surface& surface, const config::WrinkleSettings& settings,
                  const std::vector<std::string>& bodies = {});

// The default W: the mean edge length of the wrinkling parts, limited to 1/80 … 1/12 of the rest diagonal.
double default_wavelength(const Surface& surface);

// The wrinkles of every vertex: the mask grows from 0 on excluded parts to the strength over one wavelength
// along the edges, so that no wave continues into a cuff or a seam; irregularity varies wavelength and height
// by up to a quarter and place by up to a quarter of a wavelength, smoothly over about three wavelengths.
// Needs surface.neighbours.
VertexWaves vertex_waves(const Surface& surface, const config::WrinkleSettings& settings, double wavelength);

}  // namespace plisse::scene
