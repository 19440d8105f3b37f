// After J. Loviscach, Wrinkling Coarse Meshes on the GPU (2006), section 7: the vector of a stroke is blended
// with the vectors already there, so that no result is longer than the longest stroke.
#include "paint/canvas.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <string_view>

#include "base/error.h"
#include "config/suggest.h"
#include "paint/touch.h"

namespace plisse::paint {
namespace {

constexpr double longest = 0.99;

void check_names(const Canvas& canvas, const config::PaintStroke& stroke) {
  std::set<std::string> known;
  for (const Part& part : canvas.surface.parts) known.insert({part.mesh, part.material_name});
  known.erase("");
  const std::vector<std::string> names(known.begin(), known.end());
  for (const auto* list : {&stroke.only, &stroke.exclude}) {
    for (const std::string& name : *list) {
      if (!known.count(name)) {
        fail(stroke, fmt::format("'{}' is neither a mesh nor a material of this model{}; there are: {}", name,
                                 config::did_you_mean(name, names), fmt::join(names, ", ")));
      }
    }
  }
}

// p and −p are the same wrinkles: the one on b's side.
glm::dvec3 on_the_side_of(const glm::dvec3& b, const glm::dvec3& p) {
  return glm::dot(b, p) < 0 ? -p : p;
}

// The mean of the neighbours' vectors, rotated into the tangent plane with its length unchanged.
glm::dvec3 mean_around(const Canvas& canvas, const std::vector<glm::dvec3>& bias, std::uint32_t vertex) {
  const auto& rows = canvas.surface.neighbours;
  const std::uint32_t begin = rows.offsets[vertex], end = rows.offsets[vertex + 1];
  if (begin == end) return bias[vertex];
  glm::dvec3 side = bias[vertex], sum(0);
  for (std::uint32_t i = begin; i < end; ++i) {
    if (side == glm::dvec3(0)) side = bias[rows.items[i]];
    sum += on_the_side_of(side, bias[rows.items[i]]);
  }
  sum /= end - begin;
  return glm::length(sum) * tangent_part(canvas, vertex, sum);
}

void apply(const Canvas& canvas, const config::PaintStroke& stroke, const std::vector<Touch>& touches,
           Painting& painting) {
  std::vector<glm::dvec3>& bias = painting.bias;
  std::vector<glm::dvec3> before;  // the vectors before smoothing; only needed for mode `smooth`
  if (stroke.mode == config::PaintStroke::Mode::smooth) before = bias;
  for (const Touch& touch : touches) {
    glm::dvec3& p = bias[touch.vertex];
    switch (stroke.mode) {
      case config::PaintStroke::Mode::paint: {
        const glm::dvec3 aim = stroke.strength * touch.vector;
        p = glm::mix(p, on_the_side_of(p, aim), touch.amount);
        if (touch.amount >= 0.5) {
          painting.gradient[touch.vertex] = touch.gradient;
          painting.phase[touch.vertex] = touch.phase;
        }
        break;
      }
      case config::PaintStroke::Mode::erase:
        p *= 1 - stroke.strength * touch.amount;
        break;
      case config::PaintStroke::Mode::smooth:
        p = glm::mix(p, on_the_side_of(p, mean_around(canvas, before, touch.vertex)),
                     stroke.strength * touch.amount);
        break;
    }
    if (glm::length(p) > longest) p *= longest / glm::length(p);
  }
}

std::vector<std::vector<Touch>> touched_as_its_kind(const Canvas& canvas, const config::PaintStroke& stroke) {
  switch (stroke.kind) {
    case config::PaintStroke::Kind::screen:
      return {touched_on_screen(canvas, stroke)};
    case config::PaintStroke::Kind::surface:
      return {touched_on_surface(canvas, stroke)};
    case config::PaintStroke::Kind::uv:
      return {touched_in_uv(canvas, stroke)};
    case config::PaintStroke::Kind::image:
      return {touched_by_image(canvas, stroke)};
    case config::PaintStroke::Kind::colours:
      return {touched_by_colours(canvas, stroke)};
    case config::PaintStroke::Kind::painted:
      return {touched_by_painted(canvas, stroke)};
    case config::PaintStroke::Kind::field:
      return {touched_by_field(canvas, stroke)};
    case config::PaintStroke::Kind::random:
      return touched_at_random(canvas, stroke);
    case config::PaintStroke::Kind::fill:
      break;
  }
  return {touched_by_fill(canvas, stroke)};
}

// Errors in a file that a stroke names are reported with the stroke's place.
std::vector<std::vector<Touch>> touched(const Canvas& canvas, const config::PaintStroke& stroke) {
  try {
    return touched_as_its_kind(canvas, stroke);
  } catch (const Error& error) {
    if (std::string_view(error.what()).starts_with(stroke.place)) throw;
    fail(stroke, error.what());
  }
}

}  // namespace

bool Painting::has_waves() const {
  return std::ranges::any_of(gradient, [](const glm::dvec3& g) { return g != glm::dvec3(0); });
}

void take_painting(const Painting& painting, VertexWaves& waves) {
  waves.bias = painting.bias;
  if (!painting.has_waves()) return;
  waves.start_direction.assign(painting.bias.size(), glm::dvec3(0));
  waves.start_phase = painting.phase;
  for (std::size_t v = 0; v < painting.bias.size(); ++v) {
    const glm::dvec3 &p = painting.bias[v], &g = painting.gradient[v];
    if (p == glm::dvec3(0) || g == glm::dvec3(0)) continue;
    waves.start_direction[v] = glm::normalize(p);
    waves.wavelength[v] = 2 * std::numbers::pi / ((1 - glm::dot(p, p)) * glm::length(g));
  }
}

Painting paint(const Canvas& canvas, const std::vector<config::PaintStroke>& strokes) {
  Painting painting(canvas.surface.vertex_count());
  for (const config::PaintStroke& stroke : strokes) {
    check_names(canvas, stroke);
    const std::vector<bool> allowed = allowed_vertices(canvas, stroke);
    bool any = false;
    for (std::vector<Touch>& touches : touched(canvas, stroke)) {
      std::erase_if(touches,
                    [&](const Touch& touch) { return !allowed[touch.vertex] || !(touch.amount > 0); });
      any = any || !touches.empty();
      const int rounds = stroke.mode == config::PaintStroke::Mode::smooth ? stroke.rounds : 1;
      for (int i = 0; i < rounds; ++i) apply(canvas, stroke, touches, painting);
    }
    if (!any)
      fail(stroke, "this stroke touches no vertex; it lies off the mesh, or off the parts it is limited to");
  }
  // p and −p are the same wrinkles, but a phase counts in one direction.
  for (std::size_t v = 0; v < painting.bias.size(); ++v)
    painting.bias[v] = on_the_side_of(painting.gradient[v], painting.bias[v]);
  return painting;
}

}  // namespace plisse::paint
