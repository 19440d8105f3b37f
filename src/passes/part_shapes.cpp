#include "passes/part_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace plisse::passes {

PartShapes::PartShapes(const SurfaceBuffers& surface, const std::vector<Range>& parts)
    : corners_of_(surface.triangle_corners.id()) {
  const auto corners = surface.triangle_corners.read<glm::uvec2>();  // render vertex, welded vertex
  std::vector<bool> taken(surface.vertex_count);
  for (const Range& range : parts) {
    Part& part = parts_.emplace_back();
    for (std::size_t i = 3 * std::size_t{range.first_triangle};
         i < 3 * (std::size_t{range.first_triangle} + range.triangle_count); ++i) {
      const std::uint32_t v = corners[i].y;
      part.corners.push_back(v);
      if (!taken[v]) part.vertices.push_back(v);
      taken[v] = true;
    }
    for (const std::uint32_t v : part.vertices) taken[v] = false;
  }
}

bool PartShapes::belongs_to(const SurfaceBuffers& surface) const {
  return corners_of_ == surface.triangle_corners.id();
}

PartShapes::Posed PartShapes::posed(const SurfaceBuffers& surface, const glm::dmat4& view_projection,
                                    int width, int height) const {
  Posed posed;
  posed.shapes_ = this;
  posed.surface_ = &surface;
  posed.view_projection_ = view_projection;
  posed.width_ = width;
  posed.height_ = height;
  posed.positions_ = surface.positions.read<glm::vec4>();
  return posed;
}

gpu::Rectangle PartShapes::Posed::covered(std::size_t part) const {
  constexpr double margin = 2;  // pixels: half a line's width, and single precision on the GPU
  const glm::dvec2 size(width_, height_), edge = 1.0 + 2 * margin / size;
  glm::dvec2 low(INFINITY), high(-INFINITY);
  std::array<bool, 5> all_beyond{true, true, true, true, true};
  bool part_behind = false;
  for (const std::uint32_t v : shapes_->parts_[part].vertices) {
    const glm::dvec4 clip = view_projection_ * glm::dvec4(glm::dvec3(positions_[v]), 1);
    const bool beyond[5] = {clip.x<-edge.x * clip.w, clip.x> edge.x * clip.w,
                            clip.y<-edge.y * clip.w, clip.y> edge.y * clip.w, clip.w < 0};
    for (std::size_t i = 0; i < 5; ++i) all_beyond[i] = all_beyond[i] && beyond[i];
    const glm::dvec2 place = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * size;
    part_behind = part_behind || !(clip.w > 0) || !std::isfinite(place.x + place.y);
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  if (std::ranges::count(all_beyond, true) > 0) return {};
  if (part_behind) return {0, 0, width_, height_};
  const glm::ivec2 first(glm::clamp(glm::floor(low - margin), glm::dvec2(0), size));
  const glm::ivec2 end(glm::clamp(glm::ceil(high + margin), glm::dvec2(0), size));
  return {first.x, first.y, end.x - first.x, end.y - first.y};
}

bool PartShapes::Posed::waves_are_too_fine(std::size_t part) const {
  constexpr double enough = 0.6;  // turns a pixel; from half a turn on a wave has no effect on the normal
  if (waves_.empty()) {
    waves_ = surface_->waves.read<glm::vec4>();
    world_waves_ = surface_->world_waves.read<glm::vec4>();
  }
  const auto row = [&](int i) {
    return glm::dvec3(view_projection_[0][i], view_projection_[1][i], view_projection_[2][i]);
  };
  const glm::dvec2 half = 0.5 * glm::dvec2(width_, height_);
  const glm::dvec3 rx = half.x * row(0), ry = half.y * row(1), rw = row(3);
  const auto& corners = shapes_->parts_[part].corners;
  bool any = false;
  for (std::size_t first = 0; first < corners.size(); first += 3) {
    std::array<glm::dvec3, 3> x;
    double w = INFINITY, steepest = 0;  // |wJ|²
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = glm::dvec3(positions_[corners[first + i]]);
      const glm::dvec4 clip = view_projection_ * glm::dvec4(x[i], 1);
      if (!(clip.w > 0)) return false;
      const glm::dvec2 s = half * glm::dvec2(clip) / clip.w;
      const glm::dvec3 jx = rx - s.x * rw, jy = ry - s.y * rw;
      const double xx = glm::dot(jx, jx), yy = glm::dot(jy, jy), xy = glm::dot(jx, jy);
      steepest = std::max(steepest, 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));
      w = std::min(w, clip.w);
    }
    const glm::dvec3 area = glm::cross(x[1] - x[0], x[2] - x[0]);
    const double square = glm::dot(area, area), pixels = steepest / (w * w);  // |J|² at most
    if (!(square > 0)) continue;                                              // no pixel
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = corners[first + i];
      if (!(waves_[v].z > 0)) continue;
      const glm::dvec3 k(world_waves_[v]);
      const double out = glm::dot(k, area), in_plane = glm::dot(k, k) - out * out / square;
      if (!(in_plane >= enough * enough * pixels)) return false;
      any = true;
    }
  }
  return any;
}

}  // namespace plisse::passes
