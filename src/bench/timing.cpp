#include "bench/timing.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"

namespace plisse::bench {

Sample now() {
  return {wall_seconds(), cpu_seconds()};
}

Sample operator-(const Sample& end, const Sample& begin) {
  return {end.wall_s - begin.wall_s, end.cpu_s - begin.cpu_s};
}

Distribution distribution(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double q) {
    const double at = q * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {quantile(0.5), quantile(0.25), quantile(0.75)};
}

std::vector<double> Samples::seconds(Clock clock) const {
  std::vector<double> values;
  for (const Sample& sample : samples_) values.push_back(sample.on(clock));
  return values;
}

std::vector<Samples> take_turns(const std::vector<Case>& cases, const Turns& turns) {
  std::vector<int> repeats;
  for (const Case& item : cases) {
    item.run();
    const Sample begin = now();
    item.run();
    const double once = std::max((now() - begin).wall_s, 1e-7);
    repeats.push_back(std::clamp(static_cast<int>(std::lround(turns.seconds / once)), 1, 10000));
  }
  std::vector<Samples> samples(cases.size());
  for (int i = 0; i < turns.samples; ++i) {
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const Sample begin = now();
      for (int r = 0; r < repeats[c]; ++r) cases[c].run();
      const Sample all = now() - begin;
      samples[c].add({all.wall_s / repeats[c], all.cpu_s / repeats[c]});
    }
  }
  return samples;
}

Distribution ratio(const Samples& numerator, Clock clock, const Samples& denominator,
                   Clock denominator_clock) {
  const auto above = numerator.seconds(clock), below = denominator.seconds(denominator_clock);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(above.size(), below.size()); ++i)
    ratios.push_back(above[i] / below[i]);
  return distribution(ratios);
}

}  // namespace plisse::bench
