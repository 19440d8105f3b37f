// Files that `plisse drape` solves: our own scenes (config/drape_file.h) and the set-ups of the TFW authors.
#pragma once

#include <filesystem>

#include "cloth/drape_scene.h"

namespace plisse::cloth {

// SCENE.toml or SETUP.json, by its ending. Of the authors' set-ups these keys are read: rest_mesh,
// clamped_DOFs, youngs_modulus, poisson_ratio, thickness (or, of our own, fabric), density, gravity,
// pressure, stretching_type (tensionField or StVK), bending_type, rest_flat, obs_mesh (with collision_eta as
// its gap); their meshes' axes stay. A missing file of clamps, guess or obstacle gives a warning and is left
// out; the start is the rest mesh, since their cur_mesh is the solution. A set-up for wrinkles names a
// base_mesh, which becomes a `solved` start. Throws Error(bad_input).
DrapeScene load_drape(const std::filesystem::path& file);

// Positions for the scene's base vertices from an OBJ. Throws Error(bad_input) where there are more or fewer.
shell::Positions read_start(const std::filesystem::path& file, const DrapeScene& scene);

}  // namespace plisse::cloth
