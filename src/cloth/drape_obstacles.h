// The obstacles of a drape scene over time: solids that rotate and move, and animated models.
#pragma once

#include <Eigen/Geometry>

#include "cloth/drape_scene.h"
#include "config/drape_file.h"

namespace plisse::cloth {

// The result of a motion at load t.
Eigen::Isometry3d motion_at(const config::DrapeSettings::Motion& motion, double t);

// Puts a scene file's obstacles into the scene, whose frames are known. A model is posed by its clip at 24
// frames a second, frame n of the scene by frame n of the clip (after its end by the last one), with linear
// interpolation in between. Throws Error(bad_input): a model that cannot be read, has no such clip or is not
// closed.
void place_obstacles(const config::DrapeSettings& settings, DrapeScene& scene);

}  // namespace plisse::cloth
