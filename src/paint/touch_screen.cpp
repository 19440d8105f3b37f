// Strokes drawn on a picture of the model, as with the paper's mouse (Loviscach 2006, section 7 and figure
// 14): the direction on the screen is projected into the tangent space of the vertices seen under it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/frames.h"
#include "paint/touch.h"

namespace plisse::paint {
namespace {

constexpr std::uint32_t nothing = 0xffffffffU;

struct Pixel {
  glm::dvec2 at{0};  // pixels, y down
  double depth = 0;  // of the clip space, linear on the screen
  bool in_front = false;
};

Pixel projected(const Screen& screen, const glm::dvec3& x) {
  const glm::dvec4 clip = screen.view_projection * glm::dvec4(x, 1);
  if (!(clip.w > 0)) return {};
  return {{0.5 * screen.width * (1 + clip.x / clip.w), 0.5 * screen.height * (1 - clip.y / clip.w)},
          clip.z / clip.w,
          true};
}

// The triangle that is visible in each pixel.
class TriangleMap {
 public:
  TriangleMap(const Surface& surface, const Screen& screen, const std::vector<Pixel>& pixels)
      : surface_(surface),
        screen_(screen),
        triangle_(static_cast<std::size_t>(screen.width) * static_cast<std::size_t>(screen.height), nothing),
        depth_(triangle_.size(), std::numeric_limits<double>::infinity()) {
    for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) draw(t, pixels);
  }

  std::uint32_t at(const glm::dvec2& p) const {
    const double x = std::floor(p.x), y = std::floor(p.y);
    if (!(x >= 0 && y >= 0 && x < screen_.width && y < screen_.height)) return nothing;
    return triangle_[index(static_cast<int>(x), static_cast<int>(y))];
  }

  // Whether a vertex is visible: its own pixel or one beside it shows a triangle of this vertex, or nothing
  // nearer.
  bool shows(std::uint32_t vertex, const Pixel& pixel) const {
    if (!pixel.in_front) return false;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const std::uint32_t t = at(pixel.at + glm::dvec2(dx, dy));
        if (t != nothing && has(t, vertex)) return true;
      }
    }
    const std::uint32_t t = at(pixel.at);
    return t != nothing &&
           pixel.depth <= depth_[index(static_cast<int>(pixel.at.x), static_cast<int>(pixel.at.y))];
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(screen_.width) +
           static_cast<std::size_t>(x);
  }
  std::uint32_t corner(std::uint32_t t, std::uint32_t c) const {
    return surface_.render_vertices[surface_.triangles[3 * t + c]].welded;
  }
  bool has(std::uint32_t t, std::uint32_t v) const {
    return corner(t, 0) == v || corner(t, 1) == v || corner(t, 2) == v;
  }

  void draw(std::uint32_t t, const std::vector<Pixel>& pixels) {
    const Pixel &a = pixels[corner(t, 0)], &b = pixels[corner(t, 1)], &c = pixels[corner(t, 2)];
    if (!a.in_front || !b.in_front || !c.in_front) return;
    const auto area_of = [](const glm::dvec2& u, const glm::dvec2& v) { return u.x * v.y - u.y * v.x; };
    const double area = area_of(b.at - a.at, c.at - a.at);
    if (area == 0) return;
    const auto range = [](double low, double high, int size) {
      return std::pair(static_cast<int>(std::clamp(std::floor(low), 0.0, static_cast<double>(size))),
                       static_cast<int>(std::clamp(std::ceil(high), 0.0, static_cast<double>(size))));
    };
    const auto [left, right] =
        range(std::min({a.at.x, b.at.x, c.at.x}), std::max({a.at.x, b.at.x, c.at.x}), screen_.width);
    const auto [top, bottom] =
        range(std::min({a.at.y, b.at.y, c.at.y}), std::max({a.at.y, b.at.y, c.at.y}), screen_.height);
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        const glm::dvec2 p(x + 0.5, y + 0.5);
        const double beta = area_of(p - a.at, c.at - a.at) / area,
                     gamma = area_of(b.at - a.at, p - a.at) / area;
        if (beta < 0 || gamma < 0 || beta + gamma > 1) continue;
        const double depth = a.depth + beta * (b.depth - a.depth) + gamma * (c.depth - a.depth);
        if (depth < depth_[index(x, y)]) {
          depth_[index(x, y)] = depth;
          triangle_[index(x, y)] = t;
        }
      }
    }
  }

  const Surface& surface_;
  const Screen& screen_;
  std::vector<std::uint32_t> triangle_;
  std::vector<double> depth_;
};

// Maps a direction of the posed tangent plane to the rest pose by M⁻¹, M the regression over the neighbours.
glm::dvec3 at_rest(const Canvas& canvas, const Screen& screen, std::uint32_t v, const glm::dvec3& direction) {
  const Surface& surface = canvas.surface;
  const glm::dvec3 n = area_normal(surface, screen.positions, v, canvas.rest.normal[v]);
  const glm::dvec3 t =
      tangent_along(screen.positions[canvas.rest.tangent_neighbour[v]] - screen.positions[v], n);
  const glm::dvec3 b = glm::cross(n, t);
  glm::dmat2 s(0), m(0);
  for (std::uint32_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i) {
    const glm::dvec3 e = screen.positions[surface.neighbours.items[i]] - screen.positions[v];
    s += glm::outerProduct(canvas.rest.edge[i], canvas.rest.edge[i]);
    m += glm::outerProduct(glm::dvec2(glm::dot(t, e), glm::dot(b, e)), canvas.rest.edge[i]);
  }
  const glm::dmat2 regularised(1e-6 * (s[0][0] + s[1][1]));
  m = (m + regularised) * glm::inverse(s + regularised);
  glm::dvec2 q(glm::dot(t, direction), glm::dot(b, direction));
  if (std::abs(glm::determinant(m)) > 1e-6) q = glm::inverse(m) * q;
  const glm::dvec3 rest_t = canvas.rest.tangent[v], rest_b = glm::cross(canvas.rest.normal[v], rest_t);
  return glm::length(q) > 0 ? glm::normalize(q.x * rest_t + q.y * rest_b) : glm::dvec3(0);
}

}  // namespace

std::vector<Touch> touched_on_screen(const Canvas& canvas, const config::PaintStroke& stroke) {
  const Surface& surface = canvas.surface;
  const Screen screen = canvas.look(stroke);
  std::vector<Pixel> pixels;
  for (const glm::dvec3& x : screen.positions) pixels.push_back(projected(screen, x));
  const TriangleMap map(surface, screen, pixels);

  const auto flat = [](const glm::dvec2& p) { return glm::dvec3(p, 0); };
  const auto world = [&](const glm::dvec2& right_down) {
    // The first two rows of a symmetric projection are the camera's own right and up, scaled.
    const glm::dmat4 rows = glm::transpose(screen.view_projection);
    return glm::normalize(glm::dvec3(rows[0])) * right_down.x -
           glm::normalize(glm::dvec3(rows[1])) * right_down.y;
  };
  std::vector<Touch> touches;
  const auto touch = [&](std::uint32_t v, double amount, const OnLine& place) {
    const config::PaintDirection& direction = stroke.direction;
    glm::dvec3 wanted(0);
    const double angle = glm::radians(direction.degrees);
    switch (direction.kind) {
      case config::PaintDirection::Kind::across:
        wanted = world({-place.tangent.y, place.tangent.x});
        break;
      case config::PaintDirection::Kind::angle:
        wanted = world({std::cos(angle), -std::sin(angle)});
        break;
      case config::PaintDirection::Kind::vector:
        break;
      default:
        wanted = world({place.tangent.x, place.tangent.y});
    }
    const glm::dvec3 vector = direction.kind == config::PaintDirection::Kind::vector
                                  ? tangent_part(canvas, v, direction.vector)
                                  : at_rest(canvas, screen, v, wanted);
    if (stroke.mode == config::PaintStroke::Mode::paint && vector == glm::dvec3(0)) return;
    touches.push_back({v, amount, vector});
  };

  bool hit = false;
  std::vector<std::uint32_t> under;  // the vertices nearest to the line, if none is within the radius
  for (std::size_t i = 0; i < stroke.points.size(); ++i) {
    const glm::dvec2 from(stroke.points[i]), to(stroke.points[std::min(i + 1, stroke.points.size() - 1)]);
    const int steps = std::max(1, static_cast<int>(std::min(glm::distance(from, to), 1e5)));
    for (int s = 0; s < steps; ++s) {
      const glm::dvec2 p = glm::mix(from, to, static_cast<double>(s) / steps);
      const std::uint32_t t = map.at(p);
      if (t == nothing) continue;
      hit = true;
      std::uint32_t best = nothing;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t v = surface.render_vertices[surface.triangles[3 * t + c]].welded;
        if (best == nothing || glm::distance(pixels[v].at, p) < glm::distance(pixels[best].at, p)) best = v;
      }
      if (under.empty() || under.back() != best) under.push_back(best);
    }
  }
  if (!hit) {
    fail(stroke, fmt::format("the line misses the mesh in the picture of {}x{} pixels of frame {}",
                             screen.width, screen.height, stroke.frame));
  }
  for (std::uint32_t v = 0; v < surface.vertex_count(); ++v) {
    const OnLine place = nearest_on_line(stroke.points, flat(pixels[v].at));
    const double amount = falloff(stroke.falloff, place.distance / stroke.radius);
    if (amount > 0 && map.shows(v, pixels[v])) touch(v, amount, place);
  }
  if (touches.empty()) {
    std::sort(under.begin(), under.end());
    under.erase(std::unique(under.begin(), under.end()), under.end());
    for (const std::uint32_t v : under) touch(v, 1, nearest_on_line(stroke.points, flat(pixels[v].at)));
  }
  return touches;
}

}  // namespace plisse::paint
