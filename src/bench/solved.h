// A built-in scene, solved from flat cloth to a wrinkle field, and its waves in a picture.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "bench/suite.h"
#include "cloth/drape.h"
#include "cloth/wrinkle.h"
#include "mesh/measure_waves.h"

namespace plisse::bench {

struct Solved {
  cloth::WrinkleScene base;
  cloth::WrinkleReport field;
  double base_s = 0, field_s = 0;               // wall clock
  std::filesystem::path base_file, field_file;  // under the report's folder

  std::size_t vertices() const { return base.surface.topology.vertex_count; }
};

// About so many vertices (0: the example's own number). Throws Error where the base surface does not
// converge.
Solved solve(const Setup& setup, const std::string& example, int vertices);

// The base surface as a scene of its own at this size; `field`: none, or the file.
config::SceneSettings still_life(const std::filesystem::path& base, const std::filesystem::path& field,
                                 config::FieldUse use, int width, int height);

std::vector<std::uint32_t> corners(const std::vector<shell::Face>& faces);

}  // namespace plisse::bench
