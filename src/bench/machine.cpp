#include "bench/machine.h"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include "base/version.h"
#include "bench/commit.h"

namespace plisse::bench {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

std::string today() {
  const std::time_t time = std::time(nullptr);
  std::tm parts{};
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", ::gmtime_r(&time, &parts));
  return text.data();
}

}  // namespace

Machine describe_machine(const gpu::Info& gl) {
  double load = 0;
  ::getloadavg(&load, 1);
  Machine machine = {{"processor", fmt::format("{}, {} threads of hardware", processor(),
                                               std::thread::hardware_concurrency())},
                     {"OpenGL", fmt::format("{}; {}", gl.renderer, gl.version)},
                     {"compiler", "g++ " __VERSION__ ", -O3"},
                     {"date", fmt::format("{}, load average {:.1f} when it began", today(), load)},
                     {"plisse", fmt::format("{}, commit {}", version, commit)}};
  if (!gl.software)
    machine.emplace_back("CPU time",
                         "only the driver's on this GPU: see the wall clock, which the targets are held to");
  return machine;
}

}  // namespace plisse::bench
