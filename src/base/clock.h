// The two clocks: wall clock and CPU time of the whole process.
#pragma once

#include <chrono>
#include <ctime>

namespace plisse {

// Seconds on a clock that never goes back; only differences mean something.
inline double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Seconds that all threads have computed since the process began.
inline double cpu_seconds() {
  std::timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace plisse
