// Scene files of `plisse drape`: material, boundary conditions and loads of cloth (docs/drape.md).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "shell/loads.h"
#include "sizing/fabric.h"

namespace plisse::config {

// Metres, newtons, pascals; degrees.
struct DrapeSettings {
  struct Motion {  // at full load: turned about `axis` through `point`, then moved
    glm::dvec3 move{0};
    double turn = 0;  // degrees
    glm::dvec3 axis{0, 1, 0}, point{0};
  };
  struct Hold {
    std::optional<std::array<glm::dvec3, 2>> box;  // of the start; none: `vertices`
    std::vector<std::uint32_t> vertices;           // of the base, from 0
    std::array<bool, 3> axes{true, true, true};
    bool mirror = false;  // the plane across the one axis that is held is a mirror
    Motion motion;
    std::string place;  // "file:line:column", for messages
  };
  struct Force {
    std::optional<std::array<glm::dvec3, 2>> box;
    std::vector<std::uint32_t> vertices;
    std::optional<glm::dvec3> total, per_length;  // N on all of them; N/m on the edges between them
    bool grows = false;                           // from nothing to this at full load
    std::string place;
  };
  struct Obstacle {
    const shell::ObstacleKind* kind = nullptr;  // of obstacle_kinds()
    shell::SolidShape shape;                    // at load 0
    std::filesystem::path file;                 // of a mesh: a model, animated or not
    std::string clip;                           // of an animated one; empty: the first
    Motion motion;
    std::string place;
  };
  static shell::Loads usual_loads() {
    shell::Loads loads;
    loads.gravity << 0, -9.81, 0;
    loads.gap = 2e-3;
    return loads;
  }
  std::filesystem::path file;
  std::filesystem::path mesh;  // OBJ: the rest shape, cut apart by its texture coordinates' own vertices; or
  std::filesystem::path garment;  // panels and their seams (config/panel_file.h); or
  double wrap = 0;                // m: the radius that its panels are bent to before they are placed; 0: flat
  std::vector<std::string> pieces;  // of the garment, by name; none: all
  std::array<double, 2> panel{};    // width and height of a rectangle that is meshed here
  int vertices = 0;  // of the panel or garment; 0: as its fabric asks for, of a panel without one 1000
  std::optional<std::uint32_t> seed;     // none: the garment's file's own, of a panel 1
  bool upright = true;                   // the panel stands in the plane z = 0; else it lies in y = 0
  std::filesystem::path start;           // OBJ of the base's positions; empty: the rest shape
  std::optional<sizing::Fabric> fabric;  // in place of `young` and `thickness`
  double young = 1e6, poisson = 0.3, thickness = 1e-3;
  std::optional<double> density, weight;  // kg/m³; kg/m²; at most one of them
  std::set<std::string> material;         // the keys of [material] that the file has
  bool stvk = false;
  double residual = 0;
  shell::Loads loads = usual_loads();  // forces and obstacles stand below
  double tolerance = 1e-8;
  int iterations = 1000;
  int frames = 1;
  std::vector<Hold> holds;
  std::vector<Force> forces;
  std::vector<Obstacle> obstacles;
};

// Throws Error(bad_input), all that is wrong at once, each with file:line:column and what is allowed.
DrapeSettings parse_drape(std::string_view text, const std::filesystem::path& file);
DrapeSettings load_drape_settings(const std::filesystem::path& file);

// The table of keys in docs/drape.md.
std::string drape_reference_markdown();

// Whether a .toml is a drape scene and not one of a picture: it has a table [drape]. What cannot be read
// counts as one, for its reader to say why.
bool is_drape_file(const std::filesystem::path& file);

}  // namespace plisse::config
