// The cost of base surfaces: an example at several sizes, from its start to full load in one step.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cloth/drape_scene.h"

namespace plisse::bench {

struct DrapeCost {
  std::size_t vertices = 0;
  int iterations = 0;
  bool converged = false;
  double energy = 0;  // J
  // CPU seconds of all cores together, and wall clock. The shares are of wall clock.
  double cpu_s = 0, wall_s = 0;
  double analysis_s = 0, assembly_s = 0, factor_s = 0, line_search_s = 0;
  std::size_t factor_nonzeros = 0;
};

// One size after the other; `made` makes the scene with about this many vertices, `done` is called after
// each. An interrupt ends it after the current size. Throws Error.
std::vector<DrapeCost> drape_costs(const std::function<cloth::DrapeScene(int vertices)>& made,
                                   const std::vector<int>& sizes,
                                   const std::function<void(const DrapeCost&)>& done = {});

// Time over vertices, in total and by stage, both axes logarithmic.
void plot_costs(const std::filesystem::path& file, const std::string& name,
                const std::vector<DrapeCost>& costs);

}  // namespace plisse::bench
