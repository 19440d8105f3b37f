// Timing on a shared machine. Google Benchmark finishes one case before the next, so that a busy minute
// affects only one side of a ratio; here the cases alternate, sample by sample, and ratios are of consecutive
// samples.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace plisse::bench {

enum class Clock {
  wall,
  cpu
};  // cpu: all threads of this process, for use where other processes compete for the cores

struct Sample {
  double wall_s = 0, cpu_s = 0;  // of one run
  double on(Clock clock) const { return clock == Clock::wall ? wall_s : cpu_s; }
};

struct Case {
  std::string name;
  std::function<void()> run;  // returns when all of its work is done: on a GPU this needs a glFinish
};

struct Turns {
  int samples = 15;       // of each case
  double seconds = 0.02;  // a sample repeats its case until it lasts about this long
};

// Median and quartiles.
struct Distribution {
  double median = 0, low = 0, high = 0;
  Distribution scaled(double factor) const { return {median * factor, low * factor, high * factor}; }
};
Distribution distribution(std::vector<double> values);

class Samples {
 public:
  void add(const Sample& sample) { samples_.push_back(sample); }
  std::vector<double> seconds(Clock clock) const;
  Distribution of(Clock clock) const { return distribution(seconds(clock)); }

 private:
  std::vector<Sample> samples_;
};

// Runs every case once unmeasured (drivers compile at the first run), then all of them in turn,
// `turns.samples` times.
std::vector<Samples> take_turns(const std::vector<Case>& cases, const Turns& turns);

// Of the pairs of consecutive samples.
Distribution ratio(const Samples& numerator, Clock clock, const Samples& denominator,
                   Clock denominator_clock);
inline Distribution ratio(const Samples& numerator, const Samples& denominator, Clock clock) {
  return ratio(numerator, clock, denominator, clock);
}

Sample now();
Sample operator-(const Sample& end, const Sample& begin);

}  // namespace plisse::bench
