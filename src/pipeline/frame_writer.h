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
  // As many threads as a GPU needs, four, or as --threads allows. `behind_drawing`: at a lower priority, for
  // where the driver draws on the CPU as well: frames are then encoded while the next one is prepared, which
  // leaves a core idle. Throws std::system_error where not one thread can be started.
  explicit FrameWriter(bool behind_drawing);
  ~FrameWriter() { finish(); }
  // Waits where two jobs a thread wait already: more would only hold memory.
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
