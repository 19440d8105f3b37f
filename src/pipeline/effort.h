// How much work a frame gets where a run is given a time (--budget) or an error (--max-error) in place of the
// scene's own settings; such frames depend on the machine, or on the frames before, and carry no hash.
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

// Gives up, one after the other, what is seen least: rounds beyond the first, every second and then every
// fourth step of crush and relax, at last three of four samples; and takes it back as soon as it should fit.
class TimeBudget {
 public:
  TimeBudget(const Effort& wanted, double milliseconds);
  const Effort& effort() const { return ladder_[rung_]; }
  // What a frame with this effort took, from pose to picture in memory.
  void spent(double milliseconds);

 private:
  struct Cost {
    double mean = 0;  // of the last few frames; 0: not tried yet
    double rise = 1;  // of the rung above over this one, when it was left
  };
  double allowed_;
  std::vector<Effort> ladder_;
  std::vector<Cost> cost_;
  std::size_t rung_ = 0;
  bool fell_ = false;  // to this rung, with the last frame
  bool warm_ = false;  // a run's first frame also pays for compiling
};

// As many rounds, and as long an interval, as keep what another round would still move the phases by below an
// error: the root mean square over set vertices, in radians.
class ErrorBudget {
 public:
  static constexpr int most_rounds = 64, longest_interval = 4;
  ErrorBudget(const Effort& wanted, double radians) : allowed_(radians), effort_(wanted) {}
  const Effort& effort() const { return effort_; }
  // What the last round of a step moved the phases by.
  void moved(double radians);

 private:
  double allowed_;
  Effort effort_;
};

}  // namespace plisse::pipeline
