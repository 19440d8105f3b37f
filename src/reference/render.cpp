// Edge functions in homogeneous coordinates (Olano and Greer 1997, Triangle scan conversion using 2D
// homogeneous coordinates): e = C⁻¹(X, Y, 1) for C's columns (x, y, w) of the corners in clip space. e_j/Σe
// are the barycentric coordinates with perspective, Σe = 1/w, and everything is linear in the pixel, so
// nothing has to be clipped.
#include "reference/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace plisse::reference {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double reach = 0.01;           // pixels
constexpr double depth_rounding = 1e-6;  // of z/w
constexpr double alpha_rounding = 0.02;
constexpr double edge_rounding =
    1e-9;  // pixels: a centre on a shared edge must not fall between two triangles

struct RasterTriangle {
  bool drawn = false;
  Matrix3d edges;          // e_j = row j · (column, row, 1), in pixels from the top left
  Vector3d edge_length;    // |∂e_j/∂pixel|
  Vector3d depth;          // z/w = depth · (column, row, 1)
  double depth_slope = 0;  // |∂(z/w)/∂pixel|
  int left = 0, right = -1, top = 0, bottom = -1;  // pixels that can be near it, inclusive
};

RasterTriangle set_up(const Matrix3d& corners, const Eigen::Matrix4d& view_projection, int width,
                      int height) {
  RasterTriangle raster;
  const Eigen::Matrix<double, 4, 3> clip = view_projection * corners.colwise().homogeneous();
  Matrix3d C;
  C << clip.row(0), clip.row(1), clip.row(3);
  const double scale = C.col(0).norm() * C.col(1).norm() * C.col(2).norm();
  if (!(std::abs(C.determinant()) > 1e-14 * scale)) return raster;  // seen edge on, or of no area

  Matrix3d to_ndc;  // (column, row, 1) → (X, Y, 1) at the pixel's centre
  to_ndc << 2.0 / width, 0, 1.0 / width - 1, 0, -2.0 / height, 1 - 1.0 / height, 0, 0, 1;
  raster.edges = C.inverse() * to_ndc;
  raster.edge_length = raster.edges.leftCols<2>().rowwise().norm();
  raster.depth = (clip.row(2) * raster.edges).transpose();
  raster.depth_slope = raster.depth.head<2>().norm();

  raster.drawn = true;
  raster.left = raster.top = 0;
  raster.right = width - 1;
  raster.bottom = height - 1;
  if (clip.row(3).minCoeff() > 0) {
    const Eigen::RowVector3d x = (clip.row(0).cwiseQuotient(clip.row(3)).array() + 1) * 0.5 * width;
    const Eigen::RowVector3d y = (1 - clip.row(1).cwiseQuotient(clip.row(3)).array()) * 0.5 * height;
    const auto pixel = [](double value, int size) {
      return static_cast<int>(std::floor(std::clamp(value, -2.0, size + 2.0)));
    };
    raster.left = std::max(0, pixel(x.minCoeff(), width) - 1);
    raster.right = std::min(width - 1, pixel(x.maxCoeff(), width) + 1);
    raster.top = std::max(0, pixel(y.minCoeff(), height) - 1);
    raster.bottom = std::min(height - 1, pixel(y.maxCoeff(), height) + 1);
  }
  return raster;
}

// A triangle that covers a pixel's centre, or comes within reach of it.
struct Candidate {
  int column;
  int triangle;
  double depth;
  double distance;  // of the centre from the nearest edge, pixels; negative outside
  bool covers() const { return distance >= -edge_rounding; }
};

void collect(const RasterTriangle& raster, int triangle, int line, std::vector<Candidate>& candidates) {
  for (int column = raster.left; column <= raster.right; ++column) {
    const Vector3d pixel(column, line, 1);
    const Vector3d e = raster.edges * pixel;
    if (!(e.sum() > 0)) continue;  // behind the eye
    const double distance = e.cwiseQuotient(raster.edge_length).minCoeff();
    const double depth = raster.depth.dot(pixel);
    if (!(distance >= -reach) || depth < -1 || depth > 1) continue;
    candidates.push_back({column, triangle, depth, distance});
  }
}

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

class Rasteriser {
 public:
  Rasteriser(const Scene& scene, Picture& picture) : scene_(scene), picture_(picture) {
    lines_.resize(static_cast<std::size_t>(picture.height));
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      const Matrix3d& corners = scene.triangles[i].waves.corners;
      triangles_.push_back(set_up(corners, scene.camera.view_projection, picture.width, picture.height));
      if (!triangles_.back().drawn) continue;
      for (int line = triangles_.back().top; line <= triangles_.back().bottom; ++line)
        lines_[static_cast<std::size_t>(line)].push_back(static_cast<int>(i));
    }
  }

  void draw_line(int line) const {
    std::vector<Candidate> candidates;
    for (const int triangle : lines_[static_cast<std::size_t>(line)])
      collect(triangles_[static_cast<std::size_t>(triangle)], triangle, line, candidates);
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      if (a.column != b.column) return a.column < b.column;
      return a.depth != b.depth ? a.depth < b.depth : a.triangle < b.triangle;
    });
    for (auto first = candidates.begin(); first != candidates.end();) {
      const int column = first->column;
      const auto last =
          std::find_if(first, candidates.end(), [column](const Candidate& c) { return c.column != column; });
      draw_pixel(line, {first, last});
      first = last;
    }
  }

 private:
  // `near` runs from front to back.
  void draw_pixel(int line, const std::vector<Candidate>& near) const {
    const int column = near.front().column;
    const std::size_t pixel = static_cast<std::size_t>(line) * picture_.width + column;
    bool ambiguous = false;
    std::vector<Candidate> remaining;  // those that alpha and back faces leave
    const Candidate* visible = nullptr;
    Vector3d colour = Vector3d::Zero();
    remaining.reserve(near.size());
    for (const Candidate& candidate : near) {
      const Triangle& triangle = scene_.triangles[static_cast<std::size_t>(candidate.triangle)];
      const Material& material = scene_.materials[static_cast<std::size_t>(triangle.material)];
      const bool may_vanish = material.alpha_cutoff >= 0 || !material.two_sided;
      if (may_vanish || (!visible && candidate.covers())) {
        const Shaded shaded =
            shade(scene_, triangle,
                  fragment_of(triangles_[static_cast<std::size_t>(candidate.triangle)], column, line));
        const bool in_front = !visible || candidate.depth < visible->depth + depth_rounding;
        if (material.alpha_cutoff >= 0 && std::abs(shaded.alpha - material.alpha_cutoff) < alpha_rounding &&
            in_front)
          ambiguous = true;
        if (!shaded.visible) continue;
        if (!visible && candidate.covers()) colour = shaded.colour;
      }
      remaining.push_back(candidate);
      if (!visible && candidate.covers()) visible = &remaining.back();
    }
    if (visible) {
      picture_.colour[pixel] = colour;
      picture_.triangle[pixel] = visible->triangle;
      picture_.depth[pixel] = visible->depth;
    }
    picture_.silhouette[pixel] = ambiguous || is_silhouette(visible, remaining);
  }

  // Rules 2 to 4 of render.h.
  bool is_silhouette(const Candidate* visible, const std::vector<Candidate>& near) const {
    if (!visible) return !near.empty();
    const RasterTriangle& own = triangles_[static_cast<std::size_t>(visible->triangle)];
    bool goes_on = false;
    for (const Candidate& other : near) {
      if (other.triangle == visible->triangle) continue;
      const double tolerance =
          depth_rounding +
          reach * (own.depth_slope + triangles_[static_cast<std::size_t>(other.triangle)].depth_slope);
      const double behind = other.depth - visible->depth;
      const bool joined = share_an_edge(scene_.triangles[static_cast<std::size_t>(visible->triangle)],
                                        scene_.triangles[static_cast<std::size_t>(other.triangle)]) &&
                          std::abs(behind) <= tolerance;
      if (joined)
        goes_on = true;
      else if (behind < tolerance)
        return true;
    }
    return visible->distance < reach && !goes_on;
  }

  const Scene& scene_;
  Picture& picture_;
  std::vector<RasterTriangle> triangles_;
  std::vector<std::vector<int>> lines_;  // per line of the picture, the triangles that can be near it
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
  picture.triangle.assign(pixels, -1);
  picture.depth.assign(pixels, 2);
  picture.silhouette.assign(pixels, 0);

  const Rasteriser rasteriser(scene, picture);
  tbb::parallel_for(0, height, [&](int line) { rasteriser.draw_line(line); });
  mark_outline(picture);
  return picture;
}

}  // namespace plisse::reference
