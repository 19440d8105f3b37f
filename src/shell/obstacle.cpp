#include "shell/obstacle.h"

#include <algorithm>
#include <type_traits>

namespace plisse::shell {
namespace {

using Eigen::Vector3d;

template <typename Solid>
ObstacleKind kind_of(std::type_identity<Solid>) {
  return {Solid::words, [](const SolidShape& shape) { return Obstacle(Solid::of(shape)); }};
}
ObstacleKind kind_of(std::type_identity<Body>) {
  return {{.name = "mesh"}, nullptr};
}

template <typename... Kinds>
std::vector<ObstacleKind> kinds_of(std::type_identity<std::variant<Kinds...>>) {
  return {kind_of(std::type_identity<Kinds>())...};
}

}  // namespace

const std::vector<ObstacleKind>& obstacle_kinds() {
  static const std::vector<ObstacleKind> all = kinds_of(std::type_identity<Obstacle>());
  return all;
}

Distance distance(const Obstacle& obstacle, const Vector3d& point) {
  return std::visit(
      [&](const auto& solid) {
        if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, Body>) {
          return solid->distance(point);
        } else {
          return solid.distance(point);
        }
      },
      obstacle);
}

Contact contact(const Obstacle& obstacle, const Vector3d& point, double gap, bool curvature) {
  if (const auto* body = std::get_if<Body>(&obstacle)) return (*body)->contact(point, gap, curvature);
  Contact contact;
  add_barrier(contact, distance(obstacle, point), gap, 1, curvature);
  return contact;
}

double free_way(const Obstacle& obstacle, const Vector3d& from, const Vector3d& to) {
  const double length = (to - from).norm();
  return std::visit(
      [&](const auto& solid) {
        if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, Body>) {
          return solid->free_way(from, to);
        } else {
          if (length == 0) return 1.0;
          return std::min(1.0, std::max(solid.thickness(), solid.distance(from).value) / length);
        }
      },
      obstacle);
}

}  // namespace plisse::shell
