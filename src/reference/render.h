// Reference of the render pass (Loviscach 2006, section 6; docs/passes.md, "Render"): a rasteriser in double
// precision that visits pixels at their centres. waves.h has the height field, shading.h the scene and the
// shading of a pixel.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "reference/shading.h"

namespace plisse::reference {

// Rows from the top of the picture downward. Entries are row·width + column.
struct Picture {
  int width = 0, height = 0;
  std::vector<Eigen::Vector3d> colour;   // linear, times alpha; 0 where the surface is not visible
  std::vector<double> alpha;             // the share of the backdrop that the surface hides, 0…1
  std::vector<int> triangle;             // the foremost triangle drawn, −1 none (coverage)
  std::vector<double> depth;             // its z/w, −1…1; 2 none
  std::vector<std::uint8_t> silhouette;  // 1: a correct rasteriser may show something else here (below)
};

// Renders at pixel centres (column + ½, row + ½) with a depth test, no clipping needed in front of the eye.
//
// A pixel is `silhouette` where a correct rasteriser may show something else, because vertices are rounded to
// 1/256 of a pixel and depths are rounded. With reach = 0.01 pixel and a triangle "near" where the centre is
// within reach of it:
//  1. a pixel of the 4-neighbourhood differs in coverage; or
//  2. it is not covered, yet a triangle is near; or
//  3. a near triangle other than the visible one is in front of it, or behind by less than 1e-6 + what both
//  depths
//     change within reach, unless the two share an edge and depth agrees to that tolerance (a surface going
//     on); or
//  4. the centre is within reach of an edge of the visible triangle, beyond which the surface does not go on
//  in such a
//     neighbour; or
//  5. its alpha is within 0.02 of the cut (cut pixels and those that stay); or
//  6. the centre is within reach of an edge of a blended triangle beyond which no other blended one goes on,
//  or the depths of a blended triangle and the visible opaque one agree to that tolerance.
Picture render(const Scene& scene, int width, int height);

}  // namespace plisse::reference
