// Curves of a pattern piece as fine polylines, and plane geometry for them.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plisse::sizing {

struct Polyline {
  std::vector<glm::dvec2> points;
  bool closed = false;  // the last point joins the first, which is not repeated

  std::size_t segment_count() const { return points.empty() ? 0 : points.size() - (closed ? 0 : 1); }
  glm::dvec2 start(std::size_t segment) const { return points[segment]; }
  glm::dvec2 end(std::size_t segment) const { return points[segment + 1 == points.size() ? 0 : segment + 1]; }
  double length() const;
};

// SVG path data (M L H V C S Q T A Z and their relative forms) as polylines, one per subpath; y is not
// changed. Arcs become pieces of 3°, Béziers 48 pieces. Throws Error(bad_input) that names the place in the
// text.
std::vector<Polyline> parse_path(std::string_view text);

// The path of an SVG document with this `id` (the first path if it is empty), with y upward, since y of SVG
// is downward. Transforms and shapes other than paths are ignored. Throws Error(bad_input).
std::vector<Polyline> parse_svg(std::string_view document, std::string_view id);

// A centripetal Catmull–Rom spline through the points (C. Yuksel et al. 2011), 24 pieces between two of them.
Polyline spline_through(const std::vector<glm::dvec2>& points, bool closed);

// Removes points that are equal to the one before.
Polyline without_repeats(Polyline line);

double signed_area(const Polyline& closed);                      // positive counterclockwise
bool contains(const Polyline& closed, const glm::dvec2& point);  // even–odd
double distance_to_segment(const glm::dvec2& point, const glm::dvec2& a, const glm::dvec2& b);
glm::dvec2 nearest_on_segment(const glm::dvec2& point, const glm::dvec2& a, const glm::dvec2& b);

// The crossing or contact of two segments, as shares of each; empty where there is none, or they are
// parallel.
struct Crossing {
  double first = 0, second = 0;
};
std::optional<Crossing> crossing(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                                 const glm::dvec2& d);

// The first place where a closed curve meets itself, if any.
std::optional<glm::dvec2> self_crossing(const Polyline& closed);

}  // namespace plisse::sizing
