// How much the benchmark does of everything, and the subjects at that size.
#pragma once

#include <string>

#include "bench/subject.h"
#include "bench/timing.h"

namespace plisse::benchmark {

using namespace bench;  // the clock and the subjects are those of `plisse bench`

struct Effort : Turns {
  int frames = 0;  // of a clip, for whole frames; 0: all
  int width = 1280, height = 1024;
  std::size_t grid_vertices = 100000;
};

// A scene of assets/ ("shirt") at the effort's picture size.
config::SceneSettings scene_settings(const std::string& name, const Effort& effort);
Subject scene_subject(const std::string& name, const Effort& effort);
inline Subject grid_subject(const Effort& effort) {
  return bench::grid_subject(effort.grid_vertices, effort.width, effort.height);
}

}  // namespace plisse::benchmark
