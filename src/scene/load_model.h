// A scene's model: the file it names, or the panels it names in place of a mesh (docs/sizing.md), meshed as
// fine as their fabrics ask for.
#pragma once

#include "config/settings.h"
#include "io/import.h"
#include "io/model.h"

namespace plisse::scene {

// One mesh a panel, uv its panel coordinates in metres, vertices where the panels are placed: panels of a
// file that places none stand in a row. What seams join is one vertex, halfway between the panels; its number
// is the one that `plisse drape` gives it, so that a cache of a drape goes over it. Throws Error(bad_input).
io::Model load_model(const config::SceneSettings& scene);

// How a scene wants its model read.
io::ImportOptions import_options(const config::SceneSettings& scene);

}  // namespace plisse::scene
