#include "pipeline/saved.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace plisse::pipeline {
namespace {

// The stages' mean times over frames that did, or did not, leave something out; nothing where there is no
// such frame.
std::optional<double> mean_ms(const RenderReport& report, const std::vector<const char*>& stages,
                              const std::string& what, bool left_out) {
  double sum = 0;
  int frames = 0;
  for (const FrameReport& frame : report.frames) {
    if ((std::ranges::count(frame.left_out, what) > 0) != left_out) continue;
    bool any = false;
    for (const char* stage : stages) {
      if (const auto found = frame.ms.find(stage); found != frame.ms.end()) {
        sum += found->second;
        any = true;
      }
    }
    frames += any ? 1 : 0;
  }
  if (frames == 0) return std::nullopt;
  return sum / frames;
}

}  // namespace

std::map<std::string, double> saved_seconds(const RenderReport& report) {
  const std::map<std::string, std::vector<const char*>> whole = {
      {"unchanged poses", {"skin", "crush", "relax"}},
      {"idle relaxations", {"relax"}},
      {"masked surfaces", {"crush", "relax"}},
      {"copied pictures", {"render", "readback", "encode"}},
  };
  std::map<std::string, double> saved;
  for (const auto& [what, count] : report.skipped) {
    if (const auto stages = whole.find(what); stages != whole.end()) {
      if (const auto cost = mean_ms(report, stages->second, what, false)) saved[what] = 1e-3 * count * *cost;
    } else if (what != "existing frames") {
      const auto with = mean_ms(report, {"render"}, what, true),
                 without = mean_ms(report, {"render"}, what, false);
      const auto frames = std::ranges::count_if(report.frames, [&](const FrameReport& frame) {
        return std::ranges::count(frame.left_out, what) > 0;
      });
      if (with && without && *without > *with)
        saved[what] = 1e-3 * static_cast<double>(frames) * (*without - *with);
    }
  }
  return saved;
}

}  // namespace plisse::pipeline
