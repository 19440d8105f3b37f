// What a run saved by leaving out what its frames did not need (docs/contract.md, "Only what a scene needs").
#pragma once

#include <map>
#include <string>

#include "pipeline/render.h"

namespace plisse::pipeline {

// Seconds by key of RenderReport::skipped, estimated from `skipped` and the times of the frames: a whole
// stage that was left out counts times what it cost on average where it was not; a part of a picture, what
// pictures without it cost more on average. No entry where there is nothing to compare with, or nothing was
// saved.
std::map<std::string, double> saved_seconds(const RenderReport& report);

}  // namespace plisse::pipeline
