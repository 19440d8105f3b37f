#include "pipeline/effort.h"

#include <algorithm>
#include <utility>

namespace plisse::pipeline {

TimeBudget::TimeBudget(const Effort& wanted, double milliseconds) : allowed_(milliseconds), ladder_{wanted} {
  const auto cheaper = [this](auto change) {
    Effort next = ladder_.back();
    change(next);
    if (next != ladder_.back()) ladder_.push_back(next);
  };
  cheaper([](Effort& e) { e.rounds = 1; });
  cheaper([](Effort& e) { e.interval = std::max(e.interval, 2); });
  cheaper([](Effort& e) { e.interval = std::max(e.interval, 4); });
  cheaper([](Effort& e) { e.samples = 1; });
  cost_.resize(ladder_.size());
}

void TimeBudget::spent(double milliseconds) {
  if (!std::exchange(warm_, true)) return;
  Cost& here = cost_[rung_];
  const bool first = here.mean <= 0;
  // Times of one effort vary (with an interval, only some frames are crushed), so a single frame has little
  // weight.
  here.mean = first ? milliseconds : 0.75 * here.mean + 0.25 * milliseconds;
  // Only when the effort was reduced are the two times from consecutive frames.
  if (first && fell_) here.rise = cost_[rung_ - 1].mean / here.mean;
  fell_ = false;
  if (here.mean > allowed_) {
    if (rung_ + 1 < ladder_.size()) {
      cost_[++rung_].mean = 0;
      fell_ = true;
    }
  } else if (rung_ > 0 && here.mean * std::max(here.rise, 1.0) < 0.9 * allowed_) {
    cost_[--rung_].mean = 0;
  }
}

void ErrorBudget::moved(double radians) {
  if (radians > allowed_) {
    if (effort_.interval > 1)
      effort_.interval = 1;
    else
      effort_.rounds = std::min(2 * effort_.rounds, most_rounds);
  } else if (radians < 0.25 * allowed_) {  // half as many rounds leave about twice the error
    if (effort_.rounds > 1)
      effort_.rounds = effort_.rounds / 2;
    else
      effort_.interval = std::min(2 * effort_.interval, longest_interval);
  }
}

}  // namespace plisse::pipeline
