// The errors of one kind over vertices or pixels and over frames.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pipeline/verify.h"

namespace plisse::pipeline {

class Tally {
 public:
  // ok: at least `fraction` of the errors are within the tolerance.
  Tally(double tolerance, std::string unit, double fraction = 1)
      : tolerance_(tolerance), fraction_(fraction), unit_(std::move(unit)) {}

  void add(double error) {
    if (!std::isfinite(error)) error = INFINITY;
    largest_ = std::max(largest_, error);
    squares_ += error * error;
    ++count_;
    within_ += error <= tolerance_ ? 1 : 0;
  }
  std::size_t count() const { return count_; }
  double within() const {
    return count_ > 0 ? static_cast<double>(within_) / static_cast<double>(count_) : 1;
  }
  PassComparison comparison() const {
    PassComparison result;
    result.max_abs = largest_;
    result.rms = count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0;
    result.tolerance = tolerance_;
    result.fraction = fraction_;
    result.within = within();
    result.compared = count_;
    result.ok = result.within >= fraction_;
    result.unit = unit_;
    return result;
  }

 private:
  double tolerance_, fraction_, largest_ = 0, squares_ = 0;
  std::size_t count_ = 0, within_ = 0;
  std::string unit_;
};

}  // namespace plisse::pipeline
