// Strokes on the rest surface: lines by points or vertices, the whole surface, and folds at random places.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <unordered_set>

#include "paint/touch.h"

namespace plisse::paint {
namespace {

constexpr int most_random_folds = 100'000;

std::uint32_t nearest_vertex(const Surface& surface, const glm::dvec3& x) {
  std::uint32_t best = 0;
  for (std::uint32_t v = 1; v < surface.vertex_count(); ++v) {
    if (glm::distance(surface.rest[v], x) < glm::distance(surface.rest[best], x)) best = v;
  }
  return best;
}

// Walks along edges to ever nearer vertices: finds the nearest vertex if the start was near, and never
// crosses a gap.
std::uint32_t descend_to(const Surface& surface, std::uint32_t start, const glm::dvec3& x) {
  for (std::uint32_t at = start;;) {
    std::uint32_t best = at;
    for (std::uint32_t i = surface.neighbours.offsets[at]; i < surface.neighbours.offsets[at + 1]; ++i) {
      const std::uint32_t n = surface.neighbours.items[i];
      if (glm::distance(surface.rest[n], x) < glm::distance(surface.rest[best], x)) best = n;
    }
    if (best == at) return at;
    at = best;
  }
}

double longest_edge(const Surface& surface, std::uint32_t v) {
  double longest = 0;
  for (std::uint32_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i)
    longest = std::max(longest, glm::distance(surface.rest[v], surface.rest[surface.neighbours.items[i]]));
  return longest;
}

// The vertices within the radius of a line that can be reached from the seeds along edges within that radius,
// so that the other side of a sleeve is not included. If no seed is within the radius, the seeds themselves.
std::vector<Touch> near_line(const Canvas& canvas, const config::PaintStroke& stroke,
                             const std::vector<glm::dvec3>& line, const std::vector<std::uint32_t>& seeds,
                             const std::vector<glm::dvec3>& fixed) {
  const Surface& surface = canvas.surface;
  std::vector<Touch> touches;
  const auto touch = [&](std::uint32_t v, double amount, const OnLine& place) {
    glm::dvec3 vector(0);
    if (!fixed.empty()) {
      vector = fixed[v];
    } else if (place.tangent != glm::dvec3(0)) {
      const glm::dvec3 along = tangent_part(canvas, v, place.tangent);
      vector = stroke.direction.kind == config::PaintDirection::Kind::along
                   ? along
                   : glm::cross(canvas.rest.normal[v], along);
    }
    if (stroke.mode == config::PaintStroke::Mode::paint && vector == glm::dvec3(0))
      return;  // no direction here
    touches.push_back({v, amount, vector});
  };
  std::unordered_set<std::uint32_t> seen(seeds.begin(), seeds.end());
  std::vector<std::uint32_t> open(seen.begin(), seen.end());
  std::sort(open.begin(), open.end());
  for (std::size_t i = 0; i < open.size(); ++i) {
    const std::uint32_t v = open[i];
    const OnLine place = nearest_on_line(line, surface.rest[v]);
    const double amount = falloff(stroke.falloff, place.distance / stroke.radius);
    if (!(amount > 0)) continue;
    touch(v, amount, place);
    for (std::uint32_t k = surface.neighbours.offsets[v]; k < surface.neighbours.offsets[v + 1]; ++k) {
      if (seen.insert(surface.neighbours.items[k]).second) open.push_back(surface.neighbours.items[k]);
    }
  }
  if (touches.empty()) {
    for (std::size_t i = 0; i < open.size(); ++i)
      touch(open[i], 1, nearest_on_line(line, surface.rest[open[i]]));
  }
  return touches;
}

// Points of the line at most half a radius apart.
std::vector<glm::dvec3> sampled(const std::vector<glm::dvec3>& line, double radius) {
  std::vector<glm::dvec3> samples{line.front()};
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = glm::distance(line[i], line[i + 1]);
    const int steps = static_cast<int>(std::clamp(std::ceil(2 * length / radius), 1.0, 1000.0));
    for (int s = 1; s <= steps; ++s)
      samples.push_back(glm::mix(line[i], line[i + 1], static_cast<double>(s) / steps));
  }
  return samples;
}

// Uniform numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double below(double limit) { return limit * (static_cast<double>(engine_()) / 4294967296.0); }

 private:
  std::mt19937 engine_;
};

}  // namespace

std::vector<Touch> touched_on_surface(const Canvas& canvas, const config::PaintStroke& stroke) {
  const Surface& surface = canvas.surface;
  std::vector<glm::dvec3> line = stroke.points;
  std::vector<std::uint32_t> seeds;
  for (const std::uint32_t v : stroke.vertices) {
    if (v >= surface.vertex_count()) {
      fail(stroke, fmt::format("there is no vertex {}; the model has {} welded vertices, counted from 0", v,
                               surface.vertex_count()));
    }
    line.push_back(surface.rest[v]);
  }
  for (const glm::dvec3& x : stroke.points) {
    const std::uint32_t v = nearest_vertex(surface, x);
    const double distance = glm::distance(surface.rest[v], x);
    if (distance > std::max(stroke.radius, longest_edge(surface, v))) {
      fail(stroke,
           fmt::format("the point [{:g}, {:g}, {:g}] is off the mesh: the nearest vertex is {:.3g} m away",
                       x.x, x.y, x.z, distance));
    }
  }
  for (const glm::dvec3& x : sampled(line, stroke.radius)) seeds.push_back(nearest_vertex(surface, x));
  return near_line(canvas, stroke, line, seeds, fixed_directions(canvas, stroke));
}

std::vector<Touch> touched_by_fill(const Canvas& canvas, const config::PaintStroke& stroke) {
  const auto directions = fixed_directions(canvas, stroke);
  std::vector<Touch> touches;
  for (std::uint32_t v = 0; v < canvas.surface.vertex_count(); ++v) {
    const glm::dvec3 vector = directions.empty() ? glm::dvec3(0) : directions[v];
    if (stroke.mode == config::PaintStroke::Mode::paint && vector == glm::dvec3(0)) continue;
    touches.push_back({v, 1, vector});
  }
  return touches;
}

std::vector<std::vector<Touch>> touched_at_random(const Canvas& canvas, const config::PaintStroke& stroke) {
  const Surface& surface = canvas.surface;
  std::vector<std::size_t> triangles;
  std::vector<double> areas{0};  // summed
  for (const Part& part : surface.parts) {
    if (!allows(stroke, part)) continue;
    for (std::size_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      const auto x = [&](std::size_t c) {
        return surface.rest[surface.render_vertices[surface.triangles[3 * t + c]].welded];
      };
      triangles.push_back(t);
      areas.push_back(areas.back() + 0.5 * glm::length(glm::cross(x(1) - x(0), x(2) - x(0))));
    }
  }
  const double wanted = std::round(stroke.density * areas.back());
  if (wanted < 1)
    fail(stroke,
         fmt::format("density {:g} on {:.3g} m² is less than one wrinkle", stroke.density, areas.back()));
  if (wanted > most_random_folds)
    fail(stroke, fmt::format("density {:g} on {:.3g} m² is {:.0f} wrinkles; {} are allowed", stroke.density,
                             areas.back(), wanted, most_random_folds));

  const std::vector<glm::dvec3> fixed = fixed_directions(canvas, stroke);
  Random random(stroke.seed);
  std::vector<std::vector<Touch>> folds;
  config::PaintStroke fold = stroke;
  fold.direction.kind = config::PaintDirection::Kind::across;
  while (folds.size() < static_cast<std::size_t>(wanted)) {
    const double at = random.below(areas.back());
    const auto found = std::upper_bound(areas.begin() + 1, areas.end() - 1, at) - areas.begin() - 1;
    const std::size_t t = triangles[static_cast<std::size_t>(found)];
    double b = random.below(1), c = random.below(1);
    if (b + c > 1) b = 1 - b, c = 1 - c;
    const double angle = random.below(std::numbers::pi);
    std::uint32_t ids[3];
    for (std::size_t i = 0; i < 3; ++i) ids[i] = surface.render_vertices[surface.triangles[3 * t + i]].welded;
    const glm::dvec3 start =
        (1 - b - c) * surface.rest[ids[0]] + b * surface.rest[ids[1]] + c * surface.rest[ids[2]];
    const std::uint32_t first = descend_to(surface, ids[0], start);
    // The fold is perpendicular to the direction in which the cloth is gathered.
    const glm::dvec3 n = canvas.rest.normal[first], t0 = canvas.rest.tangent[first];
    glm::dvec3 heading = std::cos(angle) * t0 + std::sin(angle) * glm::cross(n, t0);
    if (!fixed.empty()) heading = glm::cross(n, fixed[first]);
    if (!(glm::length(heading) > 0)) heading = t0;

    // Straight in both directions, step by step, projected into the tangent plane of the nearest vertex.
    std::vector<glm::dvec3> line{start};
    std::vector<std::uint32_t> seeds{first};
    constexpr int steps = 8;
    for (const double way : {1.0, -1.0}) {
      glm::dvec3 x = start, e = way * heading;
      std::uint32_t v = first;
      for (int i = 0; i < steps; ++i) {
        e = tangent_part(canvas, v, e);
        x += 0.5 * stroke.length / steps * e;
        v = descend_to(surface, v, x);
        x -= glm::dot(x - surface.rest[v], canvas.rest.normal[v]) * canvas.rest.normal[v];
        line.push_back(x);
        seeds.push_back(v);
      }
      std::reverse(line.begin(), line.end());
    }
    folds.push_back(near_line(canvas, fold, line, seeds, {}));
  }
  return folds;
}

}  // namespace plisse::paint
