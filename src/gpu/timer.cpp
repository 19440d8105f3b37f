#include "gpu/timer.h"

#include <epoxy/gl.h>

#include <utility>

#include "base/clock.h"

namespace plisse::gpu {

StageTimer::~StageTimer() {
  for (const auto& query : queries_) glDeleteQueries(1, &query.second);
}

void StageTimer::begin(const std::string& stage) {
  end();
  current_ = stage;
  if (software_) {
    started_ = wall_seconds();
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
    milliseconds_[current_] += 1e3 * (wall_seconds() - started_);
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
