// The machine of a measurement, without which a time has no meaning.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/timing.h"
#include "gpu/context.h"

namespace plisse::bench {

// CPU time is the cost of a software renderer, independent of other processes; on a GPU it is only the
// driver's, so the wall clock counts.
inline Clock fair_clock(const gpu::Info& gl) {
  return gl.software ? Clock::cpu : Clock::wall;
}

// Names and values as text: processor, OpenGL, compiler, date with the load average, version and commit.
using Machine = std::vector<std::pair<std::string, std::string>>;
Machine describe_machine(const gpu::Info& gl);

}  // namespace plisse::bench
