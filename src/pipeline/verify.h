// plisse verify: every pass against its reference in double precision.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/render.h"

namespace plisse::pipeline {

struct PassComparison {
  double max_abs = 0, rms = 0, tolerance = 0;
  double fraction = 1, within = 1;  // share of values that must be, and that are, within the tolerance
  std::size_t compared = 0;         // values
  bool ok = true;                   // of a pass: of all its parts as well
  std::string unit;                 // of max_abs: "of the bounding box", "of W", "rad", "of 255"
};

struct VerifyReport {
  bool ok = true;            // false where interrupted: values that were not compared have no result
  bool interrupted = false;  // by a signal
  GlInfo gl;
  std::vector<int> frames;                       // those compared
  std::map<std::string, PassComparison> passes;  // skin, crush, relax, render, and parts such as crush.r
  double fraction_within_4 = 1, mean_flip = 0, silhouette_fraction = 0;
  double chain_phase_rms = 0, chain_image_flip = 0;  // of the worst frame
  double chain_phase_tolerance = 0, chain_flip_tolerance = 0;
  bool chain_ok = true;
  std::vector<std::string> failures;  // one sentence each
};

// Compares shader and reference; the reference of each pass has the GPU's inputs (docs/contract.md, "State
// over time", rule 6). Without a frame selection at most eight frames, evenly over the clip.
VerifyReport verify(const RenderRequest& request, const FrameCallback& on_frame);

}  // namespace plisse::pipeline
