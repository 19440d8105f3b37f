#include "reference/depth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "reference/raster.h"

namespace plisse::reference {

using Eigen::Vector3d;

Eigen::Matrix4d parallel_view(const Vector3d& centre, double radius, const Vector3d& direction) {
  const Vector3d helper = std::abs(direction.y()) < 0.9 ? Vector3d::UnitY() : Vector3d::UnitX();
  const Vector3d right = direction.cross(helper).normalized();
  Eigen::Matrix3d axes;
  axes << right, right.cross(direction), direction;
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = axes.transpose() / radius;
  view.topRightCorner<3, 1>() = -axes.transpose() * centre / radius;
  return view;
}

DepthMap depth_map(const std::vector<Triangle>& triangles, const Eigen::Matrix4d& view, int size) {
  const auto texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  DepthMap map{size, std::vector<double>(texels, 1), std::vector<double>(texels, 1),
               std::vector<double>(texels, 1)};
  const Raster raster(triangles, view, size, size);
  const auto unit = [](double ndc) { return std::clamp(0.5 * ndc + 0.5, 0.0, 1.0); };
  tbb::parallel_for(0, size, [&](int line) {
    for (const Candidate& near : raster.candidates(line, reach)) {
      const auto texel =
          static_cast<std::size_t>(size - 1 - line) * static_cast<std::size_t>(size) + near.column;
      const RasterTriangle& its = raster.triangles[static_cast<std::size_t>(near.triangle)];
      const double change = reach * its.depth_slope + depth_rounding;
      const double low = std::max(near.depth - change, its.nearest - depth_rounding);
      const double high = std::min(near.depth + change, its.farthest + depth_rounding);
      if (low > 1 || high < -1) continue;
      map.nearest[texel] = std::min(map.nearest[texel], unit(low));
      // A surface on the near plane may be clipped.
      if (near.distance >= reach && low > -1 && high < 1)
        map.farthest[texel] = std::min(map.farthest[texel], unit(high));
      if (near.covers() && std::abs(near.depth) <= 1)
        map.depth[texel] = std::min(map.depth[texel], unit(near.depth));
    }
  });
  return map;
}

}  // namespace plisse::reference
