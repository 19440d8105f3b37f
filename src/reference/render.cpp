#include "reference/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "reference/raster.h"

namespace plisse::reference {

using Eigen::Vector3d;

namespace {

constexpr double alpha_rounding = 0.02;

Fragment fragment_of(const RasterTriangle& raster, int column, int line) {
  const Vector3d e = raster.edges * Vector3d(column, line, 1);
  const double sum = e.sum();
  Fragment fragment;
  fragment.barycentric = e / sum;
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3d change = raster.edges.col(axis);
    fragment.per_pixel.col(axis) = (change - fragment.barycentric * change.sum()) / sum;
  }
  return fragment;
}

bool share_an_edge(const Triangle& a, const Triangle& b) {
  int shared = 0;
  for (const std::uint32_t id : a.welded) shared += std::count(b.welded.begin(), b.welded.end(), id) > 0;
  return shared >= 2;
}

class Painter {
 public:
  Painter(const Scene& scene, Picture& picture)
      : scene_(scene),
        picture_(picture),
        raster_(scene.triangles, scene.camera.view_projection, picture.width, picture.height) {}

  void draw_line(int line) const {
    for_each_pixel(raster_.candidates(line), [&](auto first, auto last) { draw_pixel(line, {first, last}); });
  }

 private:
  const Triangle& triangle(const Candidate& candidate) const {
    return scene_.triangles[static_cast<std::size_t>(candidate.triangle)];
  }
  const Material& material(const Candidate& candidate) const {
    return scene_.materials[static_cast<std::size_t>(triangle(candidate).material)];
  }
  const RasterTriangle& raster(const Candidate& candidate) const {
    return raster_.triangles[static_cast<std::size_t>(candidate.triangle)];
  }
  Shaded shaded(const Candidate& candidate, int line) const {
    return shade(scene_, triangle(candidate), fragment_of(raster(candidate), candidate.column, line));
  }

  // `near` runs from front to back.
  void draw_pixel(int line, const std::vector<Candidate>& near) const {
    const std::size_t pixel = static_cast<std::size_t>(line) * picture_.width + near.front().column;
    bool ambiguous = false;
    std::vector<Candidate> remaining;  // those that are not removed by alpha or back-face culling
    std::vector<Candidate> veils;      // blended over the others
    const Candidate* visible = nullptr;
    Vector3d colour = Vector3d::Zero();
    remaining.reserve(near.size());
    for (const Candidate& candidate : near) {
      const Material& its = material(candidate);
      if (its.blended) {
        veils.push_back(candidate);
        continue;
      }
      const bool may_vanish = its.alpha_cutoff >= 0 || !its.two_sided;
      if (may_vanish || (!visible && candidate.covers())) {
        const Shaded result = shaded(candidate, line);
        const bool in_front = !visible || candidate.depth < visible->depth + depth_rounding;
        if (its.alpha_cutoff >= 0 && std::abs(result.alpha - its.alpha_cutoff) < alpha_rounding && in_front)
          ambiguous = true;
        if (!result.visible) continue;
        if (!visible && candidate.covers()) colour = result.colour;
      }
      remaining.push_back(candidate);
      if (!visible && candidate.covers()) visible = &remaining.back();
    }
    ambiguous = is_silhouette(visible, remaining) || ambiguous;

    double alpha = visible ? 1 : 0;
    const Candidate* front = visible;
    std::sort(veils.begin(), veils.end(),
              [&](const Candidate& a, const Candidate& b) { return drawing_place(a) < drawing_place(b); });
    for (const Candidate& veil : veils) {
      const double behind = visible ? veil.depth - visible->depth : -1;
      const double tolerance = visible ? depth_tolerance(veil, *visible) : 0;
      if (behind > tolerance) continue;
      const Shaded result = shaded(veil, line);
      if (!result.visible) continue;
      if (std::abs(behind) <= tolerance || ends_here(veil, veils)) ambiguous = true;
      if (behind >= 0 || !veil.covers()) continue;
      colour = result.alpha * result.colour + (1 - result.alpha) * colour;
      alpha = result.alpha + (1 - result.alpha) * alpha;
      if (!front || veil.depth < front->depth) front = &veil;
    }

    if (front) {
      picture_.colour[pixel] = colour;
      picture_.alpha[pixel] = alpha;
      picture_.triangle[pixel] = front->triangle;
      picture_.depth[pixel] = front->depth;
    }
    picture_.silhouette[pixel] = ambiguous;
  }

  // The order of blended triangles: one part after the other; of two-sided parts first those seen from
  // behind; otherwise as they are listed.
  std::tuple<int, bool, int> drawing_place(const Candidate& veil) const {
    const Triangle& its = triangle(veil);
    const Vector3d to_eye = scene_.camera.eye - its.waves.corners.col(0);
    return {its.material, material(veil).two_sided && front_of(its).dot(to_eye) >= 0, veil.triangle};
  }

  double depth_tolerance(const Candidate& a, const Candidate& b) const {
    return depth_rounding + reach * (raster(a).depth_slope + raster(b).depth_slope);
  }
  // Whether `b` continues the surface of `a` across an edge.
  bool joined(const Candidate& a, const Candidate& b) const {
    return share_an_edge(triangle(a), triangle(b)) && std::abs(a.depth - b.depth) <= depth_tolerance(a, b);
  }

  // Rules 2 to 4 of render.h.
  bool is_silhouette(const Candidate* visible, const std::vector<Candidate>& near) const {
    if (!visible) return !near.empty();
    bool goes_on = false;
    for (const Candidate& other : near) {
      if (other.triangle == visible->triangle) continue;
      if (joined(*visible, other))
        goes_on = true;
      else if (other.depth - visible->depth < depth_tolerance(*visible, other))
        return true;
    }
    return visible->distance < reach && !goes_on;
  }
  // Rule 6: the centre is within reach of an edge of a blended triangle that no other one continues.
  bool ends_here(const Candidate& veil, const std::vector<Candidate>& veils) const {
    return std::abs(veil.distance) < reach &&
           std::none_of(veils.begin(), veils.end(), [&](const Candidate& other) {
             return other.triangle != veil.triangle && joined(veil, other);
           });
  }

  const Scene& scene_;
  Picture& picture_;
  Raster raster_;
};

// Rule 1 of render.h.
void mark_outline(Picture& picture) {
  const auto covered = [&](int column, int line) {
    return picture.triangle[static_cast<std::size_t>(line) * picture.width + column] >= 0;
  };
  const auto mark = [&](int column, int line) {
    picture.silhouette[static_cast<std::size_t>(line) * picture.width + column] = 1;
  };
  for (int line = 0; line < picture.height; ++line)
    for (int column = 0; column < picture.width; ++column) {
      if (column + 1 < picture.width && covered(column, line) != covered(column + 1, line)) {
        mark(column, line);
        mark(column + 1, line);
      }
      if (line + 1 < picture.height && covered(column, line) != covered(column, line + 1)) {
        mark(column, line);
        mark(column, line + 1);
      }
    }
}

}  // namespace

Picture render(const Scene& scene, int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture.colour.assign(pixels, Vector3d::Zero());
  picture.alpha.assign(pixels, 0);
  picture.triangle.assign(pixels, -1);
  picture.depth.assign(pixels, 2);
  picture.silhouette.assign(pixels, 0);

  const Painter painter(scene, picture);
  tbb::parallel_for(0, height, [&](int line) { painter.draw_line(line); });
  mark_outline(picture);
  return picture;
}

}  // namespace plisse::reference
