// Solved wrinkles of a moving model in memory: a cloth that follows its selected parts, and its waves, frame
// by frame.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace plisse {

struct SolvedClip {
  std::vector<std::uint32_t> welded;  // of each vertex of the cloth: the surface's
  std::vector<std::array<std::uint32_t, 3>>
      faces;                            // of its vertices, corners as the surface's triangle has them
  std::vector<std::uint32_t> triangle;  // of each face: the surface's triangle
  struct Frame {
    std::vector<glm::dvec3> base;              // a vertex, metres; empty: the frame was not solved
    std::vector<double> amplitude;             // a vertex, metres; empty: without waves
    std::vector<std::array<double, 3>> phase;  // a corner of each face, radians
  };
  std::vector<Frame> frames;  // frame n at n − 1
};

}  // namespace plisse
