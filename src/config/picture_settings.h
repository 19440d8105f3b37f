// What a scene decides about its pictures, each table's settings above the keys that set them: a new key is a
// member here and a row below it. Lengths are metres, angles degrees, colours sRGB in 0…1.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "config/kinds.h"

namespace plisse::config {

struct CameraSettings {
  // An elevation that none can have: 15°, rising to 50° for what lies flat.
  static constexpr double from_the_shape = 90;
  std::string name;                   // a camera of the model by name or index; empty: the one below
  double focal_length = 75;           // millimetres on a 36 mm wide film
  double azimuth = 35;                // degrees round the up axis, 0 looks along −z at the front
  double elevation = from_the_shape;  // degrees above the horizon
  double distance = 0;                // metres; 0: fitted over the whole clip
  double margin = 1.08;               // of the fit
  bool explicit_pose = false;         // eye and target given
  glm::dvec3 eye{0}, target{0};
};

template <typename Row>
void camera_keys(Row& row) {
  using S = CameraSettings;
  row("name", &S::name, name_or_index("the camera below"), "A camera of the model.");
  row("focal_length", &S::focal_length, number({5, 2000}, "mm on film 36 mm wide"), "Focal length.");
  row("azimuth", &S::azimuth, number({-360, 360}, "degrees"),
      "Angle round the up axis; 0 looks along −z at the front.");
  // 89: straight up or down leaves the picture's own up direction undefined.
  row("elevation", &S::elevation,
      number({-89, 89, "15, up to 50 for what lies flat", S::from_the_shape}, "degrees"),
      "Angle above the horizon.");
  row("distance", &S::distance, length({1e-9, 1e9, "fitted over the whole clip"}),
      "Distance from the middle of the clip's bounds.");
  row("margin", &S::margin, number({0.1, 10}), "Factor on the fitted distance.");
  row(
      "eye", optional_point(), "Where the camera stands; goes with 'target'.", {},
      [](S& camera, const std::optional<glm::dvec3>& given) {
        if (given) camera.eye = *given;
      },
      [](const S& camera) { return camera.explicit_pose ? std::optional(camera.eye) : std::nullopt; });
  row(
      "target", optional_point(), "What it looks at; goes with 'eye'.", {},
      [](S& camera, const std::optional<glm::dvec3>& given) {
        if (given) camera.target = *given;
      },
      [](const S& camera) { return camera.explicit_pose ? std::optional(camera.target) : std::nullopt; });
}

// Directions are given relative to the camera (degrees): azimuth to the right of the view, elevation above
// it.
struct LightSettings {
  double key_azimuth = -55, key_elevation = 30, key_intensity = 1.15;
  double fill_azimuth = 50, fill_elevation = 15, fill_ratio = 0.25;  // of the key
  double rim_azimuth = 160, rim_elevation = 35, rim_intensity = 0.5;
  double ambient = 0.28;
  glm::vec3 key_colour{1.0F, 0.95F, 0.88F}, fill_colour{0.85F, 0.92F, 1.0F};
  bool shadows = false;  // the key light's shadow on model and ground
};

template <typename Row>
void light_keys(Row& row) {
  using S = LightSettings;
  row("key_azimuth", &S::key_azimuth, number({-360, 360}, "degrees"),
      "Key light, angle to the right of the view.");
  row("key_elevation", &S::key_elevation, number({-90, 90}, "degrees"),
      "Key light, angle above the view; light along the waves hides them.");
  row("key_intensity", &S::key_intensity, number({0, 100}), "Key light, intensity.");
  row("key_colour", &S::key_colour, colour(), "Key light, colour.");
  row("fill_azimuth", &S::fill_azimuth, number({-360, 360}, "degrees"),
      "Fill light, angle to the right of the view.");
  row("fill_elevation", &S::fill_elevation, number({-90, 90}, "degrees"),
      "Fill light, angle above the view.");
  row("fill_ratio", &S::fill_ratio, number({0, 10}), "Fill light, intensity as a share of the key light's.");
  row("fill_colour", &S::fill_colour, colour(), "Fill light, colour.");
  row("rim_azimuth", &S::rim_azimuth, number({-360, 360}, "degrees"),
      "Rim light, angle to the right of the view.");
  row("rim_elevation", &S::rim_elevation, number({-90, 90}, "degrees"), "Rim light, angle above the view.");
  row("rim_intensity", &S::rim_intensity, number({0, 100}), "Rim light, intensity.");
  row("ambient", &S::ambient, number({0, 10}), "Light from all around.");
  row("shadows", &S::shadows, truth(), "The key light casts shadows on model and ground.");
}

enum class Blend { linear, smooth };  // weights of a triangle's three waves (docs/passes.md)
enum class Gradient { paper, full };  // eq. 8 as printed, or with the gradient of the weights

struct ShadingSettings {
  Blend blend = Blend::smooth;
  Gradient gradient = Gradient::full;
  double roughness = 0.75;
  double sheen = 0.15;
  double cavity = 1.2;  // occlusion in the valleys; 1 is the groove's own, 0 off
  double parallax = 1;  // 0 off
  bool wireframe = false;
  glm::vec3 colour{0.48F, 0.56F, 0.67F};  // sRGB, where a material has neither texture nor colour
};

template <typename Row>
void shading_keys(Row& row) {
  using S = ShadingSettings;
  row("blend", &S::blend, enumeration<Blend>({{"smooth", Blend::smooth}, {"linear", Blend::linear}}),
      "Weights of a triangle's three waves: without creases along edges (smooth), or as in the paper "
      "(linear).");
  row("gradient", &S::gradient, enumeration<Gradient>({{"full", Gradient::full}, {"paper", Gradient::paper}}),
      "Slope of the waves: with the gradient of the weights (full), or eq. 8 as printed (paper).");
  row("roughness", &S::roughness, number({0, 1}), "Width of the highlight.");
  row("sheen", &S::sheen, number({0, 1}), "Fuzz that shows at grazing angles.");
  row("cavity", &S::cavity, number({0, 4}),
      "Darkness of the valleys: 1 is what the groove itself hides of the sky, 0 none.");
  row("parallax", &S::parallax, number({0, 4}),
      "Factor on the shift of the texture over a wave's height; 0 none.");
  row("wireframe", &S::wireframe, truth(), "Draw the triangles' edges.");
  row("colour", &S::colour, colour(), "Colour where a material has neither texture nor colour.");
}

struct OutputSettings {
  std::string path = "frames";  // folder or pattern
  int width = 1280, height = 1024;
  int samples = 4;  // 1 | 4
  bool transparent = false;
  glm::vec3 background{0.79F, 0.77F, 0.74F};  // sRGB; the backdrop's colour
  bool ground = false;                        // a floor that runs into the backdrop, with contact shadow
};

template <typename Row>
void output_keys(Row& row) {
  using S = OutputSettings;
  row("path", &S::path, frame_pattern(),
      "Where the frames go: a folder, or a PNG name with ####, %04d or {frame:04} in it.",
      {"--output", "DIR|PATTERN"});
  row(
      "size", picture_size(), "Width and height.", {"--size", "WxH"},
      [](S& output, const std::pair<int, int>& size) { std::tie(output.width, output.height) = size; },
      [](const S& output) { return std::pair(output.width, output.height); });
  row("samples", &S::samples, one_of({1, 4}), "Samples in a pixel.", {"--samples", "1|4"});
  row(
      "background", background(), "The backdrop.", {"--background", "#rrggbb|transparent"},
      [](S& output, const std::optional<glm::vec3>& given) {
        output.transparent = !given;
        if (given) output.background = *given;
      },
      [](const S& output) { return output.transparent ? std::nullopt : std::optional(output.background); });
  row("ground", &S::ground, truth(), "A floor with a contact shadow that runs into the backdrop.");
}

}  // namespace plisse::config
