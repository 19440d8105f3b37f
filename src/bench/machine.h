// What a measurement was taken on: without it a time says nothing.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/timing.h"
#include "gpu/context.h"

namespace plisse::bench {

// CPU time says what a software renderer costs, whoever else is at work; on a GPU it is only the driver's,
// and the wall clock counts.
inline Clock fair_clock(const gpu::Info& gl) {
  return gl.software ? Clock::cpu : Clock::wall;
}

// Names and values, for people: processor, OpenGL, compiler, date with the load average, version and commit.
using Machine = std::vector<std::pair<std::string, std::string>>;
Machine describe_machine(const gpu::Info& gl);

}  // namespace plisse::bench
