// CPU time of the whole process.
#pragma once

#include <ctime>

namespace plisse {

// Seconds that all threads have computed since the process began.
inline double cpu_seconds() {
  std::timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace plisse
