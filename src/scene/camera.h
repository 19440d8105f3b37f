// The camera of a scene: the one that it names, or one fitted to the model over the whole clip.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "config/settings.h"
#include "io/model.h"
#include "mesh/model_units.h"
#include "scene/animation.h"

namespace plisse::scene {

// The view of one frame, in model units.
struct Camera {
  glm::dmat4 view_projection{1};
  glm::dvec3 eye{0, 0, 1}, forward{0, 0, -1}, up{0, 1, 0};  // up: of the world
  glm::dvec3 bounds_centre{0};                              // of the whole clip
  double bounds_radius = 1;
  double floor = 0;  // height of the ground along up
};

// Where no camera or only its direction is given: places the camera as near to the model as possible with all
// of `samples` (posed points of the clip, metres, within `bounds`) in the picture. Any other camera is
// returned unchanged.
config::CameraSettings fitted_camera(const config::SceneSettings& settings, const Animation::Bounds& bounds,
                                     const std::vector<glm::dvec3>& samples);

// The camera of a frame. `bounds`: of the whole clip, metres. Throws Error(bad_input) where the settings name
// a camera that the model does not have.
Camera camera_at(const config::SceneSettings& settings, const io::Model& model, const Animation& animation,
                 int frame, const Animation::Bounds& bounds, const ModelUnits& units);

}  // namespace plisse::scene
