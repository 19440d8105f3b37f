// What the wrinkles of each welded vertex are like, whatever the pose.
#pragma once

#include <vector>

namespace plisse {

// All of length V.
struct VertexWaves {
  std::vector<double> wavelength;   // W, metres of the rest pose, > 0
  std::vector<double> mask;         // 0…1 times the strength; multiplies h
  std::vector<double> phase_noise;  // radians, added when the wave is drawn
};

}  // namespace plisse
