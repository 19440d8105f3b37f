// Times the stages of a frame: timer queries on a GPU, a CPU clock round glFinish on a software renderer,
// where timer queries say nothing useful.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace plisse::gpu {

class StageTimer {
 public:
  explicit StageTimer(bool software) : software_(software) {}
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  // Ends the stage before, if any, and begins this one.
  void begin(const std::string& stage);
  void end();
  // Milliseconds by stage since the last call; waits for the GPU.
  std::map<std::string, double> collect();
  const char* kind() const { return software_ ? "cpu" : "gpu"; }

 private:
  bool software_;
  std::string current_;
  double started_ = 0;  // wall_seconds()
  std::map<std::string, double> milliseconds_;
  std::vector<std::pair<std::string, unsigned>> queries_;
};

}  // namespace plisse::gpu
