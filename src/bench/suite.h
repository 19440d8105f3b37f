// The suites of `plisse bench`, a file each. Each makes its own OpenGL context: `render` makes one too, and a
// process can have only one at a time.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.h"
#include "config/settings.h"
#include "io/model.h"

namespace plisse::bench {

struct Setup {
  Effort effort = Effort::full;
  std::filesystem::path folder, assets;
  int device = -1;

  template <typename Value>
  Value pick(Value smoke, Value quick, Value full) const {
    return effort == Effort::smoke ? smoke : effort == Effort::quick ? quick : full;
  }
  Turns turns() const { return pick<Turns>({1, 0}, {3, 0.005}, {9, 0.02}); }
  // A scene of the project's own ("sleeve") at this size, as a clip that does not loop.
  config::SceneSettings scene(const std::string& name, int width, int height) const;
  // Writes pictures/NAME.png and adds it.
  void save(SuiteReport& report, const std::string& name, const io::Image& image,
            const std::string& caption) const;
};

SuiteReport measure_relaxation(const Setup& setup);  // mode, rounds, ε, interval
SuiteReport measure_precision(const Setup& setup);   // shader float, plain C++ float, reference double
SuiteReport measure_shading(const Setup& setup);     // shading against displaced geometry
SuiteReport measure_output(const Setup& setup);      // samples, PNG level, threads that encode
SuiteReport measure_mesh(const Setup& setup);        // vertices for base surface and field
SuiteReport measure_sizing(const Setup& setup);      // the resolution paper's experiments
SuiteReport measure_method(const Setup& setup);      // passes, fields, geometry, a buckling shell

// Marks the rows for which no other row of the same scene and kind of error is better in both.
void mark_fronts(std::vector<Row>& rows);

}  // namespace plisse::bench
