// Timing on a shared machine. Google Benchmark runs one case to its end before the next, so that a busy
// minute falls on one side of a ratio; here the cases take turns, sample by sample, and ratios are of samples
// that were neighbours in time.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace plisse::bench {

enum class Clock {
  wall,
  cpu
};  // cpu: all threads of this process, the fair one where others compete for the cores

struct Sample {
  double wall_s = 0, cpu_s = 0;  // of one run
  double on(Clock clock) const { return clock == Clock::wall ? wall_s : cpu_s; }
};

struct Case {
  std::string name;
  std::function<void()> run;  // returns when all of its work is done: on a GPU that takes a glFinish
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

// Of the pairs of samples that were taken one after the other.
Distribution ratio(const Samples& numerator, Clock clock, const Samples& denominator,
                   Clock denominator_clock);
inline Distribution ratio(const Samples& numerator, const Samples& denominator, Clock clock) {
  return ratio(numerator, clock, denominator, clock);
}

Sample now();
Sample operator-(const Sample& end, const Sample& begin);

}  // namespace plisse::bench
