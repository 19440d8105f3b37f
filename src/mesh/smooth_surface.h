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

// Of each face of the sheets: whether its shell is, in any frame, more than moved, turned and scaled as a
// whole. Others have no waves, and are hard things as often as cloth. rest: of the surface's welded vertices.
std::vector<bool> deforming(const SolvedClip& sheets, const std::vector<glm::dvec3>& rest);

// Of each face: whether the model is smooth there at rest, so that a smooth surface is no other shape: at
// none of its vertices do faces of the sheets meet, or the model's normals part, at more than 30 degrees
// (tubes have at least twelve edges).
std::vector<bool> smooth_at_rest(const SolvedClip& sheets, const Surface& surface);

class SmoothSurface {
 public:
  // `sheets`: which triangles, as a cloth with vertices of its own; its frames have no part in it. `chosen`:
  // which of its faces; the others stay flat triangles, on which fields are linear; empty: all. Corners of
  // their outline that turn by more than 60 degrees at rest stay sharp; vertices that other triangles share
  // stay where they are, and edges that they share straight, so that there are no gaps. Every edge is halved
  // `levels` times, 1 … 4. Throws Error(bad_input) where an edge has more than two faces of the sheets, or
  // faces cannot be turned to one side.
  SmoothSurface(const Surface& coarse, const SolvedClip& sheets, int levels,
                const std::vector<bool>& chosen = {});

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
  // A triangle of the fine surface on a face of the sheets that is not smooth.
  struct Flat {
    std::uint32_t triangle = 0, face = 0;
    std::array<std::array<double, 3>, 3> weights{};  // of its corners: those of the face's
  };
  class Builder;
  void add_flat(const SolvedClip::Frame& frame, Refined& result) const;
  std::vector<glm::dvec3> limit_of(const std::vector<glm::dvec3>& base) const;

  Surface fine_;
  std::vector<From> from_;  // of welded vertices that the coarse surface lacks
  LoopSubdivision loop_;
  // Of Loop's coarse vertices: the sheets' own one, which has several where faces hang together only at it;
  // the surface's.
  std::vector<std::uint32_t> own_, welded_;
  std::vector<std::uint32_t> chosen_;                     // faces of the sheets: Loop's coarse faces
  std::vector<bool> turned_;                              // of those: they were turned over for Loop
  std::vector<std::uint32_t> fine_welded_;                // of the sheets' fine vertices
  std::vector<std::array<std::uint32_t, 3>> fine_faces_;  // of those, corners as the surface has them
  std::vector<Flat> flat_;
  std::vector<std::array<std::uint32_t, 3>> sheet_faces_;  // all of the coarse ones
  std::vector<std::uint32_t> fine_triangle_, root_;        // of each: the fine surface's; the coarse face
};

}  // namespace plisse
