// The appearance of a scene's surface: shading settings, the material of each part, and the textures.
#pragma once

#include <vector>

#include "passes/render.h"
#include "passes/texture.h"
#include "pipeline/loaded_scene.h"

namespace plisse::pipeline {

passes::Look look_of(const LoadedScene& scene);
std::vector<passes::DrawPart> draw_parts(const LoadedScene& scene);
std::vector<std::vector<passes::TextureLevel>> texture_levels(const LoadedScene& scene);

}  // namespace plisse::pipeline
