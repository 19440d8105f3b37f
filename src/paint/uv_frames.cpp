#include "paint/uv_frames.h"

#include <cmath>

namespace plisse::paint {

std::vector<UvFrame> uv_frames(const Surface& surface, const RestFrames& rest) {
  std::vector<UvFrame> frames(surface.render_vertices.size());
  for (const Part& part : surface.parts) {
    if (!part.has_uv) continue;
    for (std::size_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      const std::uint32_t* ids = &surface.triangles[3 * t];
      const auto vertex = [&](int c) -> const RenderVertex& { return surface.render_vertices[ids[c]]; };
      const auto x = [&](int c) { return surface.rest[vertex(c).welded]; };
      const glm::dvec3 e1 = x(1) - x(0), e2 = x(2) - x(0);
      const glm::dvec2 d1(vertex(1).uv - vertex(0).uv), d2(vertex(2).uv - vertex(0).uv);
      const double determinant = d1.x * d2.y - d2.x * d1.y;
      if (std::abs(determinant) < 1e-20) continue;
      const double area = glm::length(glm::cross(e1, e2));
      const glm::dvec3 per_u = (d2.y * e1 - d1.y * e2) / determinant,
                       per_v = (d1.x * e2 - d2.x * e1) / determinant;
      for (int c = 0; c < 3; ++c) {
        frames[ids[c]].per_u += area * per_u;
        frames[ids[c]].per_v += area * per_v;
        frames[ids[c]].along_u.x += area;  // the sum of the areas, until below
      }
    }
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    UvFrame& frame = frames[i];
    const double area = frame.along_u.x;
    frame.along_u = glm::dvec3(0);
    if (!(area > 0)) continue;
    frame.per_u /= area;
    frame.per_v /= area;
    const glm::dvec3 n = rest.normal[surface.render_vertices[i].welded];
    const glm::dvec3 u = frame.per_u - glm::dot(frame.per_u, n) * n;
    if (!(glm::length(u) > 1e-9 * glm::length(frame.per_u))) continue;
    frame.along_u = glm::normalize(u);
    frame.along_v = glm::cross(n, frame.along_u);
    if (glm::dot(frame.along_v, frame.per_v) < 0) frame.along_v = -frame.along_v;
  }
  return frames;
}

}  // namespace plisse::paint
