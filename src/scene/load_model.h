// A scene's model: the file that it names, or panels in place of a mesh (docs/sizing.md), meshed as finely as
// their fabrics need.
#pragma once

#include "config/settings.h"
#include "io/import.h"
#include "io/model.h"

namespace plisse::scene {

// One mesh for each panel, with panel coordinates in metres as uv and vertices in the placed panels; if the
// file places none, the panels are put in a row. Vertices joined by a seam are one vertex, halfway between
// the panels. Vertex numbers are those of `plisse drape`, so that the cache of a drape fits. Throws
// Error(bad_input).
io::Model load_model(const config::SceneSettings& scene);

// The scene's options for reading its model.
io::ImportOptions import_options(const config::SceneSettings& scene);

}  // namespace plisse::scene
