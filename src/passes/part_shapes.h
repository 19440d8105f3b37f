// The position of a surface's parts in the picture and the length of their waves there. On a software
// renderer these decide which parts need to be drawn, and how.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/target.h"
#include "passes/surface_buffers.h"

namespace plisse::passes {

class PartShapes {
 public:
  struct Range {
    std::uint32_t first_triangle = 0, triangle_count = 0;
  };
  PartShapes(const SurfaceBuffers& surface, const std::vector<Range>& parts);
  bool belongs_to(const SurfaceBuffers& surface) const;

  // One frame of it; reads buffers back.
  class Posed {
   public:
    // A rectangle around everything that the part draws, lines on its edges included. Empty where the part is
    // completely outside one of the four planes through the eye, or behind the eye; the whole picture where
    // some of it is behind the eye.
    gpu::Rectangle covered(std::size_t part) const;

    // Whether all waves of all its triangles are shorter than two pixels everywhere, with a margin, as
    // shaders use differences over whole pixels. With X → s the map from space to pixels, J = ds/dX, and g
    // the gradient of a wave's turns in the plane of its triangle, a step along g changes s by |J g| ≤ |J||g|
    // and the turns by |g|², so that turns grow by at least |g|/|J| a pixel. Of J at s and w, with rows r of
    // the projection, |r_x − s_x r_w|/w: the largest over a triangle is at its corners.
    bool waves_are_too_fine(std::size_t part) const;

   private:
    friend class PartShapes;
    const PartShapes* shapes_ = nullptr;
    const SurfaceBuffers* surface_ = nullptr;
    glm::dmat4 view_projection_{1};
    int width_ = 0, height_ = 0;
    std::vector<glm::vec4> positions_;
    mutable std::vector<glm::vec4> waves_, world_waves_;  // read back at their first use
  };
  Posed posed(const SurfaceBuffers& surface, const glm::dmat4& view_projection, int width, int height) const;

 private:
  struct Part {
    std::vector<std::uint32_t> vertices;  // welded ones, each once
    std::vector<std::uint32_t> corners;   // welded ones, three a triangle
  };
  unsigned corners_of_ = 0;  // the buffer's name
  std::vector<Part> parts_;
};

}  // namespace plisse::passes
