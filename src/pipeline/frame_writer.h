// Encodes and writes frames on threads of its own while the next one is drawn.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace plisse::pipeline {

class FrameWriter {
 public:
  // Must not throw.
  using Job = std::function<void()>;
  // Starts four threads, enough for a GPU, or as many as --threads allows. `behind_drawing`: with a lower
  // priority, for drivers that draw on the CPU as well: frames are then encoded mainly while the next one is
  // prepared, when a core is idle. Throws std::system_error where no thread can be started.
  explicit FrameWriter(bool behind_drawing);
  ~FrameWriter() { finish(); }
  // Waits while there are two waiting jobs per thread: more would only use memory.
  void submit(Job job);
  void finish();

 private:
  void work();
  std::mutex mutex_;
  std::condition_variable work_, room_;
  std::deque<Job> jobs_;
  std::vector<std::thread> threads_;
  bool done_ = false;
  bool behind_drawing_;
};

}  // namespace plisse::pipeline
