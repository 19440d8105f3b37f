// Strokes in uv or from files: lines, pictures, vertex colours, and earlier results of painting.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/colour.h"
#include "base/error.h"
#include "io/import_place.h"
#include "io/picture/image.h"
#include "io/ply.h"
#include "mesh/place_index.h"
#include "mesh/weld.h"
#include "paint/bias_file.h"
#include "paint/touch.h"
#include "paint/uv_frames.h"

namespace plisse::paint {
namespace {

std::vector<UvFrame> needed_uv_frames(const Canvas& canvas, const config::PaintStroke& stroke) {
  auto frames = uv_frames(canvas.surface, canvas.rest);
  if (std::none_of(frames.begin(), frames.end(), [](const UvFrame& f) { return f.valid(); }))
    fail(stroke, "the stroke is given in uv, but the model has none; use one of kind surface or screen");
  return frames;
}

// The strongest touch of each welded vertex, from those of its render vertices.
std::vector<Touch> strongest(const std::map<std::uint32_t, Touch>& found) {
  std::vector<Touch> touches;
  for (const auto& [vertex, touch] : found) touches.push_back(touch);
  return touches;
}

}  // namespace

std::vector<Touch> touched_in_uv(const Canvas& canvas, const config::PaintStroke& stroke) {
  const auto frames = needed_uv_frames(canvas, stroke);
  const auto fixed = fixed_directions(canvas, stroke);
  std::map<std::uint32_t, Touch> found;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].valid()) continue;
    const RenderVertex& vertex = canvas.surface.render_vertices[i];
    const OnLine place = nearest_on_line(stroke.points, glm::dvec3(glm::dvec2(vertex.uv), 0));
    const double amount = falloff(stroke.falloff, place.distance / stroke.radius);
    if (!(amount > 0)) continue;
    glm::dvec3 vector(0);
    if (!fixed.empty()) {
      vector = fixed[vertex.welded];
    } else {
      const glm::dvec3 along = tangent_part(
          canvas, vertex.welded, place.tangent.x * frames[i].per_u + place.tangent.y * frames[i].per_v);
      vector = stroke.direction.kind == config::PaintDirection::Kind::along
                   ? along
                   : glm::cross(canvas.rest.normal[vertex.welded], along);
    }
    if (stroke.mode == config::PaintStroke::Mode::paint && vector == glm::dvec3(0)) continue;
    Touch& touch = found.try_emplace(vertex.welded, Touch{vertex.welded, 0, {}}).first->second;
    if (amount > touch.amount) touch = {vertex.welded, amount, vector};
  }
  return strongest(found);
}

std::vector<Touch> touched_by_image(const Canvas& canvas, const config::PaintStroke& stroke) {
  const auto frames = needed_uv_frames(canvas, stroke);
  const auto fixed = fixed_directions(canvas, stroke);
  const io::Image image = io::load_image(stroke.file);
  std::map<std::uint32_t, Touch> found;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].valid()) continue;
    const RenderVertex& vertex = canvas.surface.render_vertices[i];
    const double amount = io::amount_at(image, glm::dvec2(vertex.uv));
    if (!(amount > 0)) continue;
    Touch& touch = found.try_emplace(vertex.welded, Touch{vertex.welded, 0, {}}).first->second;
    if (amount > touch.amount)
      touch = {vertex.welded, amount, fixed.empty() ? glm::dvec3(0) : fixed[vertex.welded]};
  }
  return strongest(found);
}

std::vector<Touch> touched_by_colours(const Canvas& canvas, const config::PaintStroke& stroke) {
  const io::Ply ply = io::read_ply(stroke.file, {"x", "y", "z", "red", "r", "diffuse_red", "green", "g",
                                                 "diffuse_green", "blue", "b", "diffuse_blue"});
  std::vector<glm::dvec3> places = ply.vectors("vertex");
  const auto& red = ply.numbers("vertex", {"red", "r", "diffuse_red"});
  const auto& green = ply.numbers("vertex", {"green", "g", "diffuse_green"});
  const auto& blue = ply.numbers("vertex", {"blue", "b", "diffuse_blue"});
  using Type = io::PlyProperty::Type;
  const auto* channel = ply.element("vertex").find({"red", "r"});
  const double full = channel && channel->type == Type::uint16                                        ? 65535
                      : channel && (channel->type == Type::float32 || channel->type == Type::float64) ? 1
                                                                                                      : 255;
  const glm::dmat4 upright = io::upright(stroke.up);
  for (glm::dvec3& place : places) place = glm::dvec3(upright * glm::dvec4(place, 1));
  const PlaceIndex theirs(places);
  const double tolerance = 100 * weld_tolerance(canvas.surface.rest);
  const auto fixed = fixed_directions(canvas, stroke);
  std::vector<Touch> touches;
  std::size_t missing = 0;
  for (std::uint32_t v = 0; v < canvas.surface.vertex_count(); ++v) {
    const auto i = theirs.nearest(canvas.surface.rest[v], tolerance);
    if (!i) {
      ++missing;
      continue;
    }
    const double amount = (0.2126 * red[*i] + 0.7152 * green[*i] + 0.0722 * blue[*i]) / full;
    if (amount > 0) touches.push_back({v, std::min(amount, 1.0), fixed.empty() ? glm::dvec3(0) : fixed[v]});
  }
  if (missing > 0) {
    fail(stroke,
         fmt::format(
             "{} of the model's {} welded vertices are not among the {} of {}; export the same rest pose, "
             "and say 'up' where its up axis is not y",
             missing, canvas.surface.vertex_count(), places.size(), stroke.file.string()));
  }
  return touches;
}

std::vector<Touch> touched_by_painted(const Canvas& canvas, const config::PaintStroke& stroke) {
  const Painting found = read_bias(stroke.file, canvas.surface, canvas.rest);
  std::vector<Touch> touches;
  for (std::uint32_t v = 0; v < found.bias.size(); ++v)
    touches.push_back({v, 1, found.bias[v], found.gradient[v], found.phase[v]});
  return touches;
}

std::vector<Touch> touched_by_field(const Canvas& canvas, const config::PaintStroke& stroke) {
  VertexWaves waves;
  waves.wavelength.assign(canvas.surface.vertex_count(), 1);
  field_as_bias(canvas.surface, canvas.rest, canvas.field(stroke), canvas.dead_zone, waves);
  std::vector<Touch> touches;
  for (std::uint32_t v = 0; v < waves.bias.size(); ++v) {
    const glm::dvec3& p = waves.bias[v];
    const double r = 1 - glm::dot(p, p);
    if (p != glm::dvec3(0))
      touches.push_back({v, 1, p, 2 * std::numbers::pi / (r * waves.wavelength[v]) * waves.start_direction[v],
                         waves.start_phase[v]});
  }
  return touches;
}

}  // namespace plisse::paint
