#include "reference/backdrop.h"

#include <cmath>

#include "reference/functions.h"

namespace plisse::reference {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

double fraction(double x) {
  return x - std::floor(x);
}

// Jimenez 2014, Next Generation Post Processing in Call of Duty: Advanced Warfare: interleaved gradient
// noise, −½…½; `place` in pixels from the lower left corner.
double noise(const Vector2d& place) {
  return fraction(52.9829189 * fraction(place.dot(Vector2d(0.06711056, 0.00583715)))) - 0.5;
}

// The fade at the map's border: 0 on it and outside, 1 from .15 inward.
double inside(const Vector2d& place) {
  double product = 1;
  for (const double x : {place.x(), place.y(), 1 - place.x(), 1 - place.y()})
    product *= smoothstep(0, 0.15, x);
  return product;
}

// The share of the light that remains on the floor, where the line from `near` through `far` meets it from
// above; 1 elsewhere.
double floor_light(const Ground& ground, const GroundMap& map, const Vector3d& near, const Vector3d& far) {
  const Vector3d ray = far - near;
  const double above = near.dot(ground.up) - ground.floor, sinks = -ray.dot(ground.up);
  if (!(above > 0 && sinks > 0)) return 1;
  const Vector3d from_origin = near + above / sinks * ray - ground.origin;
  const Vector2d place(from_origin.dot(ground.across) / ground.side,
                       from_origin.dot(ground.along) / ground.side);
  const double share = inside(place);
  if (share == 0) return 1;
  const Vector2d taken = share * sample(map, place);
  return (1 - 0.5 * taken.x()) * (1 - 0.55 * taken.y());
}

}  // namespace

std::vector<Vector3d> backdrop(const Vector3d& background, const Eigen::Matrix4d& view_projection,
                               const Ground& ground, const GroundMap& map, int width, int height) {
  const Eigen::Matrix4d from_clip = view_projection.inverse();
  std::vector<Vector3d> colours;
  colours.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int line = 0; line < height; ++line)
    for (int column = 0; column < width; ++column) {
      const Vector2d pixel(column + 0.5, height - line - 0.5);  // from the lower left corner
      const Vector2d place = pixel.cwiseQuotient(Vector2d(width, height));
      const auto on_plane = [&](double depth) -> Vector3d {
        return (from_clip * Eigen::Vector4d(2 * place.x() - 1, 2 * place.y() - 1, depth, 1))
            .eval()
            .hnormalized();
      };
      const double vignette = 1.06 - 0.45 * (place.array() - 0.5).matrix().squaredNorm();
      const double dither = 1 + 3.0 / 255 * noise(pixel);
      colours.emplace_back(background * vignette * floor_light(ground, map, on_plane(-1), on_plane(1)) *
                           dither);
    }
  return colours;
}

}  // namespace plisse::reference
