#include "paint/touch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "paint/uv_frames.h"

namespace plisse::paint {

void fail(const config::PaintStroke& stroke, const std::string& what) {
  throw Error(ExitCode::bad_input, fmt::format("{}: {}", stroke.place, what));
}

double falloff(config::PaintStroke::Falloff kind, double part) {
  if (part > 1) return 0;
  if (kind == config::PaintStroke::Falloff::flat) return 1;
  const double s = 1 - part;
  return kind == config::PaintStroke::Falloff::linear ? s : s * s * (3 - 2 * s);
}

OnLine nearest_on_line(const std::vector<glm::dvec3>& points, const glm::dvec3& x) {
  OnLine best{std::numeric_limits<double>::infinity(), {}};
  if (points.size() == 1) return {glm::distance(points[0], x), glm::dvec3(0)};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const glm::dvec3 edge = points[i + 1] - points[i];
    const double square = glm::dot(edge, edge);
    const double s = square > 0 ? std::clamp(glm::dot(x - points[i], edge) / square, 0.0, 1.0) : 0;
    const double distance = glm::distance(points[i] + s * edge, x);
    if (distance < best.distance) best = {distance, square > 0 ? edge / std::sqrt(square) : glm::dvec3(0)};
  }
  return best;
}

glm::dvec3 tangent_part(const Canvas& canvas, std::uint32_t vertex, const glm::dvec3& vector) {
  const glm::dvec3 n = canvas.rest.normal[vertex];
  const glm::dvec3 tangent = vector - glm::dot(vector, n) * n;
  return glm::length(tangent) > 1e-6 * glm::length(vector) ? glm::normalize(tangent) : glm::dvec3(0);
}

std::vector<glm::dvec3> fixed_directions(const Canvas& canvas, const config::PaintStroke& stroke) {
  const std::size_t count = canvas.surface.vertex_count();
  const config::PaintDirection& direction = stroke.direction;
  std::vector<glm::dvec3> directions;
  if (direction.kind == config::PaintDirection::Kind::vector) {
    for (std::uint32_t v = 0; v < count; ++v) directions.push_back(tangent_part(canvas, v, direction.vector));
  } else if (direction.kind == config::PaintDirection::Kind::angle) {
    directions.assign(count, glm::dvec3(0));
    const double angle = glm::radians(direction.degrees);
    const auto frames = uv_frames(canvas.surface, canvas.rest);
    bool any = false;
    for (std::size_t i = frames.size(); i-- > 0;) {  // the first render vertex of a welded one is used
      if (!frames[i].valid()) continue;
      any = true;
      directions[canvas.surface.render_vertices[i].welded] =
          std::cos(angle) * frames[i].along_u + std::sin(angle) * frames[i].along_v;
    }
    if (!any)
      fail(stroke, "an angle is counted from growing u, but the model has no uv; give a vector [x, y, z]");
  }
  return directions;
}

bool allows(const config::PaintStroke& stroke, const Part& part) {
  const auto named = [&](const std::vector<std::string>& names) {
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return name == part.mesh || name == part.material_name;
    });
  };
  return (stroke.only.empty() || named(stroke.only)) && !named(stroke.exclude);
}

std::vector<bool> allowed_vertices(const Canvas& canvas, const config::PaintStroke& stroke) {
  const Surface& surface = canvas.surface;
  std::vector<bool> allowed(surface.vertex_count(), false);
  for (const Part& part : surface.parts) {
    if (!allows(stroke, part)) continue;
    for (std::size_t i = 3 * std::size_t{part.first_triangle};
         i < 3 * std::size_t{part.first_triangle + part.triangle_count}; ++i) {
      allowed[surface.render_vertices[surface.triangles[i]].welded] = true;
    }
  }
  return allowed;
}

}  // namespace plisse::paint
