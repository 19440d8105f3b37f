// The work done for a frame when a run has a time (--budget) or an error (--max-error) in place of the
// scene's own settings. Such frames depend on the machine, or on the frames before, and contain no hash.
#pragma once

#include <optional>
#include <vector>

#include "config/settings.h"

namespace plisse::pipeline {

struct Effort {
  int rounds = 1;    // of descent
  int interval = 1;  // crush and relax every n-th frame
  int samples = 4;   // a pixel
  bool operator==(const Effort&) const = default;
};

// Reduces the work in the order of its visible effect: first the rounds to one, then crush and relax to every
// second and every fourth frame, last the samples from four to one. Restores it as soon as the time should
// allow it.
class TimeBudget {
 public:
  TimeBudget(const Effort& wanted, double milliseconds);
  const Effort& effort() const { return ladder_[rung_]; }
  // The time of a frame with this effort, from pose to picture in memory.
  void spent(double milliseconds);

 private:
  struct Cost {
    double mean = 0;  // of the last few frames; 0: not tried yet
    double rise = 1;  // time of the next higher effort over this one, when it was left
  };
  double allowed_;
  std::vector<Effort> ladder_;
  std::vector<Cost> cost_;
  std::size_t rung_ = 0;
  bool fell_ = false;  // to this effort, with the last frame
  bool warm_ = false;  // a run's first frame also pays for compiling
};

// The fewest rounds and the longest interval for which another round would change the phases by less than the
// error: the root mean square over set vertices, in radians.
class ErrorBudget {
 public:
  static constexpr int most_rounds = 64, longest_interval = 4;
  ErrorBudget(const Effort& wanted, double radians) : allowed_(radians), effort_(wanted) {}
  const Effort& effort() const { return effort_; }
  // The change of the phases in the last round of a step.
  void moved(double radians);

 private:
  double allowed_;
  Effort effort_;
};

}  // namespace plisse::pipeline
