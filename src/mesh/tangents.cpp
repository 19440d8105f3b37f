#include "mesh/tangents.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace plisse {
namespace {

glm::dvec3 unit_across(const glm::dvec3& v, const glm::dvec3& normal) {
  const glm::dvec3 across = v - glm::dot(normal, v) * normal;
  const double length = glm::length(across);
  return length > 0 ? across / length : glm::dvec3(0);
}

}  // namespace

std::vector<CornerTangent> mikktspace(const std::vector<TangentCorner>& corners) {
  std::vector<CornerTangent> result(corners.size());
  std::map<std::pair<std::uint32_t, bool>, glm::dvec3> sums;  // by vertex and orientation
  const auto key = [&](std::size_t corner) {
    return std::pair(corners[corner].vertex, result[corner].sign > 0);
  };
  std::vector<bool> flat(corners.size() / 3);
  for (std::size_t first = 0; first + 2 < corners.size(); first += 3) {
    const TangentCorner* c = &corners[first];
    const glm::dvec3 d1 = c[1].position - c[0].position, d2 = c[2].position - c[0].position;
    const glm::dvec2 t1 = c[1].uv - c[0].uv, t2 = c[2].uv - c[0].uv;
    const double area = t1.x * t2.y - t1.y * t2.x;
    flat[first / 3] = area == 0;
    if (area == 0) continue;
    const double sign = area > 0 ? 1 : -1;
    const glm::dvec3 along_u = sign * (t2.y * d1 - t1.y * d2);
    for (std::size_t i = 0; i < 3; ++i) {
      result[first + i].sign = sign;
      const TangentCorner &here = c[i], &before = c[(i + 2) % 3], &after = c[(i + 1) % 3];
      const glm::dvec3 a = unit_across(before.position - here.position, here.normal),
                       b = unit_across(after.position - here.position, here.normal);
      const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
      sums.try_emplace(key(first + i), 0).first->second += angle * unit_across(along_u, here.normal);
    }
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (flat[i / 3]) continue;
    const glm::dvec3 sum = sums.at(key(i));
    if (glm::length(sum) > 0) result[i].tangent = glm::normalize(sum);
  }
  return result;
}

}  // namespace plisse
