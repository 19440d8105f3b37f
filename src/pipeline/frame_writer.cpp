#include "pipeline/frame_writer.h"

#include <tbb/global_control.h>

#ifdef __linux__
#include <sys/resource.h>
#endif

#include <algorithm>
#include <system_error>
#include <utility>

namespace plisse::pipeline {

FrameWriter::FrameWriter(bool behind_drawing) : behind_drawing_(behind_drawing) {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  try {
    for (std::size_t i = 0; i < std::min<std::size_t>(allowed, 4); ++i)
      threads_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {  // one thread is enough, but slower
    if (threads_.empty()) throw;
  }
}

void FrameWriter::submit(Job job) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return jobs_.size() < 2 * threads_.size(); });
  jobs_.push_back(std::move(job));
  work_.notify_one();
}

void FrameWriter::finish() {
  {
    std::lock_guard lock(mutex_);
    done_ = true;
  }
  work_.notify_all();
  for (auto& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

void FrameWriter::work() {
#ifdef __linux__
  // On Linux this call sets the priority of this thread only. The niceness is added to that of the program.
  if (behind_drawing_) setpriority(PRIO_PROCESS, 0, std::min(19, getpriority(PRIO_PROCESS, 0) + 7));
#endif
  while (true) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      work_.wait(lock, [this] { return done_ || !jobs_.empty(); });
      if (jobs_.empty()) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    room_.notify_one();
    job();
  }
}

}  // namespace plisse::pipeline
