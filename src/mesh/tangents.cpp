#include "mesh/tangents.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

namespace plisse {
namespace {

glm::dvec3 unit_across(const glm::dvec3& v, const glm::dvec3& normal) {
  const glm::dvec3 across = v - glm::dot(normal, v) * normal;
  const double length = glm::length(across);
  return length > 0 ? across / length : glm::dvec3(0);
}

// The corners that share a tangent: those of one vertex whose triangles follow each other round it, edge by
// edge, all turned alike in uv. Fans that only touch in the vertex are none: where uv is mirrored twice over,
// tangents of opposite quarters would cancel.
class Fans {
 public:
  Fans(const std::vector<TangentCorner>& corners, std::vector<double>& signs) : parent_(corners.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t>
        open;                                                // directed edges without their other side
    std::vector<std::pair<std::size_t, std::size_t>> sides;  // first corners of an edge's two sides
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t from = corners[i].vertex, to = corners[next(i)].vertex;
      const auto other = open.find({to, from});
      if (other == open.end()) {
        open.try_emplace({from, to}, i);
        continue;
      }
      sides.emplace_back(i, other->second);
      open.erase(other);
    }
    // A triangle without area in uv is turned as one beside it.
    for (const auto& [i, j] : sides) {
      for (const auto& [flat, whole] : {std::pair(i, j), std::pair(j, i)}) {
        if (signs[flat / 3] == 0) signs[flat / 3] = signs[whole / 3];
      }
    }
    for (const auto& [i, j] : sides) {
      if (signs[i / 3] != signs[j / 3]) continue;
      join(i, next(j));
      join(next(i), j);
    }
  }
  std::size_t of(std::size_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }

 private:
  static std::size_t next(std::size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }
  std::vector<std::size_t> parent_;
};

}  // namespace

std::vector<CornerTangent> mikktspace(const std::vector<TangentCorner>& corners) {
  std::vector<double> signs(corners.size() / 3, 0.0);            // of triangles
  std::vector<glm::dvec3> turns(corners.size(), glm::dvec3(0));  // each corner's tangent times its angle
  std::vector<bool> flat(signs.size(), true);
  for (std::size_t first = 0; first + 2 < corners.size(); first += 3) {
    const TangentCorner* c = &corners[first];
    const glm::dvec3 d1 = c[1].position - c[0].position, d2 = c[2].position - c[0].position;
    const glm::dvec2 t1 = c[1].uv - c[0].uv, t2 = c[2].uv - c[0].uv;
    const double area = t1.x * t2.y - t1.y * t2.x;
    if (area == 0) continue;
    flat[first / 3] = false;
    const double sign = signs[first / 3] = area > 0 ? 1 : -1;
    const glm::dvec3 along_u = sign * (t2.y * d1 - t1.y * d2);
    for (std::size_t i = 0; i < 3; ++i) {
      const TangentCorner &here = c[i], &before = c[(i + 2) % 3], &after = c[(i + 1) % 3];
      const glm::dvec3 a = unit_across(before.position - here.position, here.normal),
                       b = unit_across(after.position - here.position, here.normal);
      const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
      turns[first + i] = angle * unit_across(along_u, here.normal);
    }
  }
  Fans fans(corners, signs);
  std::vector<glm::dvec3> sums(corners.size(), glm::dvec3(0));  // by a fan's first corner
  for (std::size_t i = 0; i < corners.size(); ++i) sums[fans.of(i)] += turns[i];
  std::vector<CornerTangent> result(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (flat[i / 3]) continue;
    result[i].sign = signs[i / 3];
    const glm::dvec3 sum = sums[fans.of(i)];
    if (glm::length(sum) > 0) result[i].tangent = glm::normalize(sum);
  }
  return result;
}

}  // namespace plisse
