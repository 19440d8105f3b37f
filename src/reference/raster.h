// The pixels that a triangle covers or comes near, for the reference's pictures and depth maps.
//
// Edge functions in homogeneous coordinates (Olano and Greer 1997, Triangle scan conversion using 2D
// homogeneous coordinates): e = C⁻¹(X, Y, 1) for C's columns (x, y, w) of the corners in clip space. e_j/Σe
// are the barycentric coordinates with perspective, Σe = 1/w, and everything is linear in the pixel
// coordinates, so no clipping is needed.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "reference/shading.h"

namespace plisse::reference {

// Correct rasterisers round vertices to 1/256 of a pixel, and round depths.
inline constexpr double reach = 0.01;           // pixels
inline constexpr double depth_rounding = 1e-6;  // of z/w
// Pixels: a centre on a shared edge must not fall between two triangles.
inline constexpr double edge_rounding = 1e-9;

struct RasterTriangle {
  bool drawn = false;
  Eigen::Matrix3d edges;              // e_j = row j · (column, line, 1), in pixels from the top left
  Eigen::Vector3d edge_length;        // |∂e_j/∂pixel|
  Eigen::Vector3d depth;              // z/w = depth · (column, line, 1)
  double depth_slope = 0;             // |∂(z/w)/∂pixel|
  double nearest = -1, farthest = 1;  // z/w of its corners, where all are in front of the eye
  int left = 0, right = -1, top = 0, bottom = -1;  // pixels that may be near it, inclusive
};

// Columns of `corners` are world points.
RasterTriangle set_up(const Eigen::Matrix3d& corners, const Eigen::Matrix4d& view_projection, int width,
                      int height);

// A triangle that covers a pixel's centre, or comes within reach of it.
struct Candidate {
  int column;
  int triangle;
  double depth;     // z/w
  double distance;  // of the centre from the nearest edge, pixels; negative outside
  bool covers() const { return distance >= -edge_rounding; }
};

// Adds the candidates of one line of the picture, with z/w at most `beyond` outside −1…1.
void collect(const RasterTriangle& raster, int triangle, int line, double beyond,
             std::vector<Candidate>& candidates);

// The triangles of a picture, sorted by the lines they may be near.
struct Raster {
  Raster(const std::vector<Triangle>& triangles, const Eigen::Matrix4d& view_projection, int width,
         int height);
  // Of one line, by column and then from front to back.
  std::vector<Candidate> candidates(int line, double beyond = 0) const;

  std::vector<RasterTriangle> triangles;
  std::vector<std::vector<int>> lines;
};

// Calls `pixel(first, last)` for the candidates of each pixel that has any.
template <typename Pixel>
void for_each_pixel(const std::vector<Candidate>& candidates, Pixel&& pixel) {
  for (auto first = candidates.begin(); first != candidates.end();) {
    auto last = first;
    while (last != candidates.end() && last->column == first->column) ++last;
    pixel(first, last);
    first = last;
  }
}

}  // namespace plisse::reference
