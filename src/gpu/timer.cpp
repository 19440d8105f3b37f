#include "gpu/timer.h"

#include <epoxy/gl.h>

#include <chrono>
#include <utility>

namespace plisse::gpu {
namespace {
double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}
}  // namespace

StageTimer::~StageTimer() {
  for (const auto& query : queries_) glDeleteQueries(1, &query.second);
}

void StageTimer::begin(const std::string& stage) {
  end();
  current_ = stage;
  if (software_) {
    started_ = now_ms();
  } else {
    unsigned query = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &query);
    glBeginQuery(GL_TIME_ELAPSED, query);
    queries_.emplace_back(stage, query);
  }
}

void StageTimer::end() {
  if (current_.empty()) return;
  if (software_) {
    glFinish();
    milliseconds_[current_] += now_ms() - started_;
  } else {
    glEndQuery(GL_TIME_ELAPSED);
  }
  current_.clear();
}

std::map<std::string, double> StageTimer::collect() {
  end();
  for (const auto& [stage, query] : queries_) {
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    milliseconds_[stage] += static_cast<double>(nanoseconds) * 1e-6;
    glDeleteQueries(1, &query);
  }
  queries_.clear();
  return std::exchange(milliseconds_, {});
}

}  // namespace plisse::gpu
