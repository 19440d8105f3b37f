// A surface whose sheets of cloth are drawn as smooth as `plisse wrinkle --mesh` writes them: their triangles
// are subdivided to Loop's limit surface, and amplitude and phase of a solved field with them, so that
// neither slopes nor waves jump at the edges of the mesh. Everything else stays as it is.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/corner_field.h"
#include "mesh/loop.h"
#include "mesh/solved_clip.h"
#include "mesh/surface.h"

namespace plisse {

class SmoothSurface {
 public:
  // `sheets`: which triangles, as a cloth with vertices of its own; its frames have no part in it. Corners of
  // their outline that turn by more than 60 degrees at rest stay sharp; vertices that other triangles share
  // stay where they are, and edges that they share straight, so that there are no gaps. Every edge is halved
  // `levels` times, 1 … 4. Throws Error(bad_input) where an edge has more than two faces of the sheets, or
  // faces cannot be turned to one side.
  SmoothSurface(const Surface& coarse, const SolvedClip& sheets, int levels);

  // The welded vertices of the coarse surface, then those on edges and in triangles. It has no bones and no
  // morph targets: poses are given as places.
  const Surface& surface() const { return fine_; }

  // `coarse`: of the coarse welded vertices; `base`: of the sheets' own ones, if they are not the same.
  std::vector<glm::dvec3> places(const std::vector<glm::dvec3>& coarse,
                                 const std::vector<glm::dvec3>& base = {}) const;

  // The fine sheets with one frame, the field that is given on the coarse ones; and ∇φ of their vertices,
  // radians per metre, tangent to the limit surface, 0 where there are no waves.
  struct Refined {
    SolvedClip clip;
    std::vector<glm::dvec3> gradient;
  };
  Refined refined(const SolvedClip::Frame& frame) const;

  // Values of welded vertices on the fine surface, linear within each triangle.
  template <typename Value>
  std::vector<Value> spread(const std::vector<Value>& coarse) const {
    std::vector<Value> result = coarse;
    for (const auto& [vertex, weight] : from_) {
      Value sum = coarse[vertex[0]] * weight[0];
      for (std::size_t k = 1; k < 3; ++k) sum += coarse[vertex[k]] * weight[k];
      result.push_back(sum);
    }
    return result;
  }

 private:
  struct From {
    std::array<std::uint32_t, 3> vertex{};
    std::array<double, 3> weight{};
  };
  class Builder;
  std::vector<glm::dvec3> limit_of(const std::vector<glm::dvec3>& base) const;

  Surface fine_;
  std::vector<From> from_;  // of welded vertices that the coarse surface lacks
  LoopSubdivision loop_;
  std::vector<std::uint32_t> welded_;                     // of the sheets' own coarse vertices
  std::vector<bool> turned_;                              // coarse faces that were turned over for Loop
  std::vector<std::uint32_t> fine_welded_;                // of the sheets' fine vertices
  std::vector<std::array<std::uint32_t, 3>> fine_faces_;  // of those, corners as the surface has them
  std::vector<std::uint32_t> fine_triangle_, root_;       // of each: the fine surface's; the coarse face
};

}  // namespace plisse
