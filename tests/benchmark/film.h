// A clip frame after frame: as the program renders it, and without files.
#pragma once

#include <string>

#include "benchmark/effort.h"
#include "config/settings.h"

namespace plisse::benchmark {

// A scene of assets/ at the effort's picture size.
config::SceneSettings film_settings(const std::string& scene, const Effort& effort, int samples_a_pixel);

// Each renders the clip (or the effort's first frames of it) and returns the time of a frame, the first one
// left out: it pays for loading, compiling and the period that a looped clip replays. The one needs a current
// context, the other makes its own.
Sample film_without_files(const config::SceneSettings& settings, const Effort& effort, bool read_back,
                          bool software);
struct FilmWithFiles {
  Sample frame;
  double whole_run_fps = 0;  // the first frame and loading included
  int frames = 0;
};
FilmWithFiles film_with_files(config::SceneSettings settings, const Effort& effort);

// Pixels that the surface covers now.
std::size_t covered_pixels(passes::RenderPass& pass, const passes::SurfaceBuffers& surface,
                           const passes::View& view, const gpu::Target& float_target);

// Pixels that the surface covers, averaged over the clip. Needs a current context.
double average_covered_pixels(const config::SceneSettings& settings, const Effort& effort);

}  // namespace plisse::benchmark
