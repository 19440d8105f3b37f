#include "scene/camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "base/error.h"
#include "config/suggest.h"

namespace plisse::scene {
namespace {

// Half the picture's width and height at distance 1. The film is 36 mm along the longer side of the picture.
glm::dvec2 half_film(const config::SceneSettings& settings) {
  const double aspect = static_cast<double>(settings.output.width) / settings.output.height;
  const double half_long = 18.0 / settings.camera.focal_length;
  return aspect >= 1 ? glm::dvec2(half_long, half_long / aspect) : glm::dvec2(half_long * aspect, half_long);
}

// A flat model is viewed from higher up, since it would be a line otherwise: if its height is below 0.3 of
// the narrower side.
double elevation_for(const glm::dvec3& size) {
  const double flat = 1 - std::min(size.y / std::max(0.3 * std::min(size.x, size.z), 1e-12), 1.0);
  return 15 + 35 * flat;
}

// By name, or else by index. Throws Error(bad_input) with the list of cameras.
const io::Camera& model_camera(const io::Model& model, const std::string& choice) {
  std::vector<std::string> names;
  for (const io::Camera& camera : model.cameras) names.push_back(camera.name);
  const auto named = std::find(names.begin(), names.end(), choice);
  if (named != names.end()) return model.cameras[static_cast<std::size_t>(named - names.begin())];
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::to_string(i) == choice) return model.cameras[i];
  throw Error(
      ExitCode::bad_input,
      fmt::format(
          "{}: no camera '{}'{}; it has {}; or give azimuth,elevation[,focal] or eye=x,y,z;target=x,y,z",
          model.path.string(), choice, config::did_you_mean(choice, names),
          names.empty() ? std::string("none") : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

// In the camera's own axes a point (x, y) at depth z is seen where |x −
// s| ≤ (z + d) tan, so each side of the picture is a plane, and each point gives a lower bound for its
// offset.
config::CameraSettings fitted_camera(const config::SceneSettings& settings, const Animation::Bounds& bounds,
                                     const std::vector<glm::dvec3>& samples) {
  config::CameraSettings camera = settings.camera;
  if (!camera.name.empty() || camera.explicit_pose) return camera;
  if (camera.elevation == config::CameraSettings::from_the_shape)
    camera.elevation = elevation_for(bounds.high - bounds.low);
  const double a = glm::radians(camera.azimuth), e = glm::radians(camera.elevation);
  const glm::dvec3 toward(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
  glm::dvec3 right = glm::cross(glm::dvec3(0, 1, 0), toward);
  right = glm::length(right) > 1e-6 ? glm::normalize(right) : glm::dvec3(1, 0, 0);
  const glm::dvec3 high = glm::cross(toward, right), centre = 0.5 * (bounds.low + bounds.high);
  const glm::dvec2 tangent = half_film(settings) / camera.margin;
  glm::dvec4 push(-INFINITY);  // right, left, up, down
  double nearest = -INFINITY;
  for (const glm::dvec3& point : samples) {
    const glm::dvec3 d = point - centre;
    const double x = glm::dot(d, right), y = glm::dot(d, high), z = glm::dot(d, toward);
    push = glm::max(push,
                    glm::dvec4(x + z * tangent.x, -x + z * tangent.x, y + z * tangent.y, -y + z * tangent.y));
    nearest = std::max(nearest, z);
  }
  const double radius = std::max(0.5 * glm::distance(bounds.low, bounds.high), 1e-9);
  double distance = camera.distance;
  if (distance <= 0) {
    distance = std::max({0.5 * (push[0] + push[1]) / tangent.x, 0.5 * (push[2] + push[3]) / tangent.y,
                         nearest + 0.01 * radius});
  }
  camera.target = centre + 0.5 * (push[0] - push[1]) * right + 0.5 * (push[2] - push[3]) * high;
  camera.eye = camera.target + distance * toward;
  camera.explicit_pose = true;
  return camera;
}

Camera camera_at(const config::SceneSettings& settings, const io::Model& model, const Animation& animation,
                 int frame, const Animation::Bounds& bounds, const ModelUnits& units) {
  const config::CameraSettings& camera = settings.camera;
  const glm::dvec3 up(0, 1, 0), centre = 0.5 * (bounds.low + bounds.high);
  const double radius = std::max(0.5 * glm::distance(bounds.low, bounds.high), 1e-9);
  double half_height = 0;  // of a parallel projection
  double tan_x = half_film(settings).x, tan_y = half_film(settings).y;
  glm::dvec3 eye = camera.eye, forward = glm::normalize(camera.target - camera.eye), camera_up = up;
  if (!camera.name.empty()) {
    const io::Camera& chosen = model_camera(model, camera.name);
    const glm::dmat4 place = animation.node_matrix(chosen.node, frame);
    eye = glm::dvec3(place[3]);
    forward = glm::normalize(-glm::dvec3(place[2]));
    camera_up = glm::normalize(glm::dvec3(place[1]));
    tan_y = std::tan(chosen.vertical_field_of_view / 2);
    tan_x = tan_y * settings.output.width / settings.output.height;
    if (chosen.half_height > 0) {
      half_height = chosen.half_height * glm::length(glm::dvec3(place[1])) / units.metres;
      // Parallel rays have no origin, but shading needs the eye as a point: it is put so far away that
      // directions are right to a thousandth.
      eye -= 1000 * radius * forward;
    }
  }
  if (std::abs(glm::dot(forward, camera_up)) > 0.9999)
    camera_up = std::abs(forward.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);

  Camera view;
  view.eye = units.world(eye);
  view.forward = forward;
  view.up = up;
  view.bounds_centre = units.world(centre);
  view.bounds_radius = radius / units.metres;
  view.floor = units.world(bounds.low).y;
  const double distance = glm::distance(view.eye, view.bounds_centre);
  const double far = distance + (settings.output.ground ? 12 : 1.5) * view.bounds_radius;
  const double near = std::max(distance - 1.5 * view.bounds_radius, 1e-3 * (distance + view.bounds_radius));
  const double half_width = half_height * settings.output.width / settings.output.height;
  const glm::dmat4 projection =
      half_height > 0 ? glm::ortho(-half_width, half_width, -half_height, half_height, near, far)
                      : glm::frustum(-tan_x * near, tan_x * near, -tan_y * near, tan_y * near, near, far);
  view.view_projection = projection * glm::lookAt(view.eye, view.eye + forward, camera_up);

  return view;
}

}  // namespace plisse::scene
