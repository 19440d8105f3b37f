// A pattern piece: its outline, its fabric, and the techniques along its lines. Plain data, metres, panel
// coordinates.
#pragma once

#include <string>
#include <vector>

#include "sizing/fabric.h"
#include "sizing/polyline.h"
#include "sizing/rules.h"

namespace plisse::sizing {

// Section numbers: D. Zhang et al., SIGGRAPH 2025.
struct Feature {
  enum class Rule {
    shirring,   // 4.2.2: E_sh, ρ, n along a line
    fold,       // 4.2.3: an angle
    stitch,     // 4.2.4: sewn to a line of another length; only the longer line is refined
    cell,       // 4.2.5: the closed seam of a down-filled cell, with its pressure
    collision,  // 4.2.6: a region with a compression ratio
  };
  std::string name;
  Rule rule = Rule::shirring;
  Polyline line;             // cell, collision: closed
  double added_modulus = 0;  // E_sh, N/m²
  double ratio = 1;          // ρ
  double exponent = 1;       // n
  double angle = 0;          // Δθ, degrees
  double other_length = 0;   // of the line it is stitched to, m
  TransitionCause cause;     // tension, pressure, prefactor; compression follows from ρ
};

const char* name_of(Feature::Rule rule);

struct Panel {
  std::string name = "panel";
  Fabric fabric;
  double grain = 90;  // degrees from x to the warp
  Polyline outline;   // closed
  std::vector<Polyline> holes;
  std::vector<Feature> features;
  std::vector<glm::dvec2> marks;  // points within a tenth of r of the outline that become vertices
};

struct SizingOptions {
  ResolutionLaw law = resolution_law();
  double floor = 1e-3;  // m: the smallest resolution of any rule
  Transition::Form form = Transition::Form::unit_free;
  FoldRule fold_rule = FoldRule::complement;
  double fold_offset = 0.5e-3;  // m: the two lines beside a fold; 0: none
  double gradation = 0.35;  // largest growth of the size per length; steeper transitions are limited to it
  std::uint32_t seed = 1;
};

}  // namespace plisse::sizing
