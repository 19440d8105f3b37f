// The parts of the benchmark, a table or two each. Each makes its own OpenGL context: frames are rendered by
// the program's own `render`, which makes one too, and a process holds one at a time.
#pragma once

#include <string>

#include "bench/machine.h"
#include "benchmark/effort.h"
#include "benchmark/report.h"

namespace plisse::benchmark {

void measure_passes(Report& report, const Effort& effort);  // skin, crush, relax, render
void measure_shading(Report& report,
                     const Effort& effort);                    // the wave shader against plain textured Phong
void measure_plain_cpp(Report& report, const Effort& effort);  // crush and relax against plain C++
void measure_png(Report& report, const Effort& effort);        // PNG against stb's own
void measure_frames(Report& report, const Effort& effort);     // whole frames
void measure_device(Report& report,
                    const Effort& effort);                  // every pass against memory and launches
void measure_sizing(Report& report, const Effort& effort);  // plisse size, 1k to 1M vertices
void measure_import(Report& report, const Effort& effort);  // model files, 62k to 1M triangles
void measure_paper(Report& report, const Effort& effort);   // Tables 1 and 2 of Loviscach 2006

// For those who tune a shader: every pass with the shaders of a folder against the built-in ones.
void compare_shaders(Report& report, const Effort& effort, const std::string& folder);

}  // namespace plisse::benchmark
