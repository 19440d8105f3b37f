// The cost of wrinkle fields: an example's base surface at several sizes, each solved.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cloth/wrinkle.h"

namespace plisse::bench {

struct WrinkleCost {
  std::size_t vertices = 0;
  int iterations = 0;  // of the solve with real periods
  bool converged = false;
  double waves = 0, max_amplitude = 0;  // metres
  double energy = 0;                    // J, with whole periods
  // Wall-clock seconds: the solver, phases and their whole periods, all of it (with curvature, without
  // draping and files); CPU seconds of all cores for all of it. Each the median of three runs.
  double solve_s = 0, phase_s = 0, wall_s = 0, cpu_s = 0;
};

// One after the other: `base` makes the surface of about so many vertices (not timed), the rest of the
// request counts for all; `done` hears of each. A surface that does not converge is listed as not converged,
// with no times. An interrupt leaves out the size at hand and all after it. Throws Error.
std::vector<WrinkleCost> wrinkle_costs(cloth::WrinkleRequest request,
                                       const std::function<cloth::WrinkleScene(int vertices)>& base,
                                       const std::vector<int>& sizes,
                                       const std::function<void(const WrinkleCost&)>& done = {});

// Time over vertices, in total and by stage, both axes logarithmic.
void plot_costs(const std::filesystem::path& file, const std::string& name,
                const std::vector<WrinkleCost>& costs);

}  // namespace plisse::bench
