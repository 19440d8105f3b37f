// The displacement pass against the reference, point by point.
#pragma once

#include <map>
#include <string>

#include "passes/displacement.h"
#include "pipeline/displace.h"
#include "pipeline/tally.h"

namespace plisse::pipeline {

class DisplacementComparison {
 public:
  // The scene outlives this. Needs a current context.
  DisplacementComparison(const LoadedScene& scene, const std::string& shader_folder);

  // Displaces a finer surface by the waves in the buffers, on the GPU and in the reference.
  void compare(const passes::SurfaceBuffers& surface, const WaveSnapshot& gpu);
  void report(std::map<std::string, PassComparison>& passes) const;

 private:
  const LoadedScene& scene_;
  Displacement displacement_;
  passes::SurfaceBuffers buffers_;
  passes::DisplacementPass pass_;
  Tally place_, relief_, normal_;
};

}  // namespace plisse::pipeline
