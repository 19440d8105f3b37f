#include "reference/ground.h"

#include <algorithm>
#include <cmath>

#include "reference/depth.h"

namespace plisse::reference {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr int map_size = 256;
constexpr double half_side = 3.2;       // of the map, in radii
constexpr double sphere_margin = 1.02;  // of the depth maps
constexpr double contact = 0.05;        // radii: the sky's shadow falls by e with each such height

// Bilinear at `place` in 0…1, from size × size texels; border texels are repeated outside.
template <typename Texel>
auto bilinear(int size, const Vector2d& place, Texel&& texel) {
  const Vector2d at = (place * size).array() - 0.5;
  const double left = std::floor(at.x()), low = std::floor(at.y());
  const double s = at.x() - left, t = at.y() - low;
  const auto value = [&](double column, double row) {
    return texel(static_cast<int>(std::clamp(column, 0.0, size - 1.0)),
                 static_cast<int>(std::clamp(row, 0.0, size - 1.0)));
  };
  using Value = decltype(texel(0, 0));
  return Value((1 - t) * ((1 - s) * value(left, low) + s * value(left + 1, low)) +
               t * ((1 - s) * value(left, low + 1) + s * value(left + 1, low + 1)));
}

// A point in a depth map: its place and depth, all 0…1.
Vector3d in_map(const ShadowMap& map, const Vector3d& x) {
  return (map.matrix * x.homogeneous()).eval().hnormalized().array() * 0.5 + 0.5;
}

double depth_at(const ShadowMap& map, int column, int row) {
  return static_cast<double>(map.depth[static_cast<std::size_t>(row) * map.size + column]);
}

// The share of the key light that is blocked at a point of the floor.
double shade_of(const ShadowMap& key, const Vector3d& x) {
  const Vector3d p = in_map(key, x);
  if (p.head<2>().minCoeff() < 0 || p.head<2>().maxCoeff() > 1) return 0;
  const double depth = std::min(p.z(), 1.0) - 1e-3;
  return bilinear(key.size, p.head<2>(),
                  [&](int column, int row) { return depth > depth_at(key, column, row) ? 1.0 : 0.0; });
}

// The share of the sky that is blocked by the surface above a point of the floor.
double contact_of(const ShadowMap& below, const Vector3d& x) {
  const Vector2d place = in_map(below, x).head<2>();
  if (place.minCoeff() <= 0 || place.maxCoeff() >= 1) return 0;
  const double height =
      bilinear(below.size, place, [&](int column, int row) { return depth_at(below, column, row); });
  return height < 1 ? std::exp(-height * 2 * sphere_margin / contact) : 0;
}

// The Gaussian, cut off and normalised to the sum 1; the width is in texels.
std::vector<double> kernel(double width, int cut_off) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = -cut_off; i <= cut_off; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (width * width)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

GroundMap softened(const GroundMap& map, const Vector2d& widths, bool across) {
  const int cut_off = static_cast<int>(std::ceil(2.5 * widths.maxCoeff()));
  const std::vector<double> light = kernel(widths.x(), cut_off), sky = kernel(widths.y(), cut_off);
  GroundMap result{map.size, {}};
  result.taken.reserve(map.taken.size());
  for (int row = 0; row < map.size; ++row)
    for (int column = 0; column < map.size; ++column) {
      Vector2d sum = Vector2d::Zero();
      for (int i = -cut_off; i <= cut_off; ++i) {
        const int c = std::clamp(column + (across ? i : 0), 0, map.size - 1);
        const int r = std::clamp(row + (across ? 0 : i), 0, map.size - 1);
        const Vector2d& taken = map.taken[static_cast<std::size_t>(r) * map.size + c];
        const auto k = static_cast<std::size_t>(i + cut_off);
        sum += Vector2d(light[k] * taken.x(), sky[k] * taken.y());
      }
      result.taken.push_back(sum);
    }
  return result;
}

}  // namespace

Ground ground_under(const Vector3d& centre, double radius, const Vector3d& up, double floor) {
  Ground ground;
  ground.up = up;
  ground.across = (std::abs(up.y()) < 0.9 ? Vector3d::UnitY() : Vector3d::UnitZ()).cross(up).normalized();
  ground.along = up.cross(ground.across);
  ground.floor = floor;
  ground.side = 2 * half_side * radius;
  ground.radius = radius;
  const Vector3d foot = centre + (floor - centre.dot(up)) * up;
  ground.origin = foot - half_side * radius * (ground.across + ground.along);
  return ground;
}

Eigen::Matrix4d view_from_below(const Ground& ground, const Vector3d& centre) {
  const double radius = sphere_margin * ground.radius;
  return parallel_view(centre + (ground.floor + radius - centre.dot(ground.up)) * ground.up, radius,
                       ground.up);
}

GroundMap ground_map(const Ground& ground, const ShadowMap& key, const ShadowMap& below) {
  GroundMap map{map_size, {}};
  map.taken.reserve(static_cast<std::size_t>(map_size) * map_size);
  for (int row = 0; row < map_size; ++row)
    for (int column = 0; column < map_size; ++column) {
      const Vector2d place = Vector2d(column + 0.5, row + 0.5) * ground.side / map_size;
      const Vector3d x = ground.origin + place.x() * ground.across + place.y() * ground.along;
      map.taken.emplace_back(shade_of(key, x), contact_of(below, x));
    }
  const double texels = map_size / (2 * half_side);  // a radius
  const Vector2d widths(std::max(0.7, 0.035 * texels), std::max(0.7, 0.06 * texels));
  return softened(softened(map, widths, true), widths, false);
}

Vector2d sample(const GroundMap& map, const Vector2d& place) {
  return bilinear(map.size, place, [&](int column, int row) -> Vector2d {
    return map.taken[static_cast<std::size_t>(row) * map.size + column];
  });
}

}  // namespace plisse::reference
