// All settings of a scene, checked and with defaults. Made from a scene file and the command
// line by config/scene_file.h; used by the pipeline. Lengths are metres, angles degrees, colours sRGB in 0…1.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "base/limits.h"

namespace plisse::config {

enum class RelaxMode { descent, smooth };  // state over time, rule 3
enum class Blend { linear, smooth };       // weights of a triangle's three waves (docs/passes.md)
enum class Gradient { paper, full };       // eq. 8 as printed, or with the gradient of the weights

struct ModelSettings {
  std::filesystem::path path;       // resolved against the scene file's folder; empty: `garment`
  std::filesystem::path garment;    // a panel file or GarmentCode pattern, which is meshed here
  std::vector<std::string> pieces;  // panels of it, by name; none: all
  std::string fabric;               // in place of the panels' own, as parse_fabric takes it; empty: theirs
  std::string clip;                 // name or index; empty: first
  double frames_per_second = 0;     // 0: 24, a sequence's own
  std::string frames;               // selection "1-48x2,60"; empty: all
  bool loop = false;                // replays one period first
  double metres_per_unit = 0;       // 0: the file's own
  std::string up;                   // x | y | z; empty: the file's own
  std::string rest = "auto";        // auto | bind | frame:N | FILE
  std::filesystem::path cache;      // an MDD or PC2 file over the model's mesh; empty: none
};

struct WrinkleSettings {
  double wavelength = 0;                   // metres of the rest pose; 0: from the mesh
  std::filesystem::path wavelength_map;    // a picture in uv, or a PLY with a wavelength a vertex; or none
  double wavelength_low = 0;               // metres: where the picture is black; 0: half the wavelength
  double strength = 1;                     // multiplies h
  std::string profile = "sinusoid";        // of mesh/wave_profiles.h, or FILE
  std::vector<std::string> only, exclude;  // names of meshes or materials
  double dead_zone = 0.005;                // of 1 − r, ≥ 1e-4
  double irregularity = 0;                 // 0…1: seeded noise, ±25 % of wavelength, phase and height at 1
  std::uint32_t seed = 1;
  int fine = 0;             // finer waves along each of these; 0: none
  double fine_share = 0.5;  // their steepness over that of the coarse ones
};

enum class FieldUse { bias, direct };  // docs/passes.md, "Fields"

// Wrinkles of the rest pose; at most one of the paths is given.
struct BiasSettings {
  std::filesystem::path paint;  // a paint file, whose strokes are painted when the scene is loaded
  std::filesystem::path file;   // what `plisse paint` wrote: PLY or uv texture
  // A solved wrinkle field: PLY, or the amplitudes of a set of text files; or a pattern for one a frame.
  std::filesystem::path field;
  FieldUse use = FieldUse::bias;
};

struct RelaxSettings {
  RelaxMode mode = RelaxMode::smooth;
  int rounds = 1;              // descent rounds per stepped frame
  double epsilon = 13.2;       // ε of eq. 6; stable below 19.7 on any mesh
  int interval = 1;            // crush and relax every n-th frame
  int onset_rounds = 8;        // P of rule 3
  int smoothing_rounds = 300;  // S of rule 3
};

struct CameraSettings {
  // An impossible elevation, which means: 15°, up to 50° for flat models.
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

struct OutputSettings {
  std::string path = "frames";  // folder or pattern
  int width = 1280, height = 1024;
  int samples = 4;  // 1 | 4
  bool transparent = false;
  glm::vec3 background{0.79F, 0.77F, 0.74F};  // sRGB; the backdrop's colour
  bool ground = false;                        // a floor that runs into the backdrop, with contact shadow
};

struct SceneSettings {
  std::filesystem::path file;                 // the scene file, empty for a bare model
  std::map<std::string, std::string> places;  // "bias.field" → "scene.toml:6:1", of the keys that stand in it
  ModelSettings model;
  WrinkleSettings wrinkles;
  BiasSettings bias;
  RelaxSettings relax;
  CameraSettings camera;
  LightSettings light;
  ShadingSettings shading;
  OutputSettings output;
  Limits limits;
};

}  // namespace plisse::config
