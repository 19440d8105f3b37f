#include "mesh/uv_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace plisse {
namespace {

constexpr double rounding = 1e-6;  // of single-precision coordinates

void draw(UvRaster& raster, std::size_t triangle, const std::array<glm::dvec2, 3>& uv) {
  const glm::dvec2 e1 = uv[1] - uv[0], e2 = uv[2] - uv[0];
  const double area = e1.x * e2.y - e1.y * e2.x;
  if (area == 0) return;
  const int size = raster.size;
  const auto range = [&](int axis) {
    const auto [low, high] = std::minmax({uv[0][axis], uv[1][axis], uv[2][axis]});
    return std::pair(std::max(0, static_cast<int>(std::floor(low * size))),
                     std::min(size, static_cast<int>(std::ceil(high * size))));
  };
  const auto [left, right] = range(0);
  const auto [low, high] = range(1);
  for (int y = low; y < high; ++y) {
    for (int x = left; x < right; ++x) {
      const glm::dvec2 d = glm::dvec2(x + 0.5, y + 0.5) / static_cast<double>(size) - uv[0];
      glm::dvec3 b(0, (d.x * e2.y - d.y * e2.x) / area, (e1.x * d.y - e1.y * d.x) / area);
      b.x = 1 - b.y - b.z;
      const double least = std::min({b.x, b.y, b.z});
      if (least < 0) continue;
      const auto at = static_cast<std::size_t>(size - 1 - y) * static_cast<std::size_t>(size) +
                      static_cast<std::size_t>(x);
      if (raster.triangle[at] == UvRaster::none) {
        raster.triangle[at] = static_cast<std::int64_t>(triangle);
        raster.barycentric[at] = b;
        raster.source[at] = static_cast<std::int64_t>(at);
        ++raster.covered;
      } else {
        // A texel on a common edge is of both triangles and of one place.
        const glm::dvec3 other = raster.barycentric[at];
        if (least > 1e-9 && std::min({other.x, other.y, other.z}) > 1e-9) ++raster.overlapping;
      }
    }
  }
}

void widen(UvRaster& raster, int rounds) {
  const int size = raster.size;
  for (int round = 0; round < rounds; ++round) {
    const auto before = raster.source;
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const auto at = [&](int column, int row) {
          return static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
                 static_cast<std::size_t>(column);
        };
        if (before[at(x, y)] != UvRaster::none) continue;
        // Neighbours by an edge before those by a corner.
        constexpr std::array<std::array<int, 2>, 8> around{
            {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
        for (const auto& [dx, dy] : around) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= size || y + dy >= size) continue;
          if (before[at(x + dx, y + dy)] == UvRaster::none) continue;
          raster.source[at(x, y)] = before[at(x + dx, y + dy)];
          break;
        }
      }
    }
  }
}

}  // namespace

UvSquare uv_square(const glm::dvec2& low, const glm::dvec2& high, const std::string& instead) {
  UvSquare square;
  square.corner = glm::floor(low + rounding);
  const glm::dvec2 reach = glm::ceil(high - rounding) - square.corner;
  const double side = std::max({reach.x, reach.y, 1.0});
  if (!(side <= most_tiles)) {
    throw Error(
        ExitCode::bad_input,
        fmt::format("uv reaches from ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}); a texture covers at most {} "
                    "tiles a side: {}",
                    low.x, low.y, high.x, high.y, most_tiles, instead));
  }
  square.side = static_cast<int>(side);
  return square;
}

UvRaster uv_raster(const Surface& surface, int size, int widened) {
  UvRaster raster;
  raster.size = size;
  const std::size_t texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  raster.triangle.assign(texels, UvRaster::none);
  raster.source.assign(texels, UvRaster::none);
  raster.barycentric.assign(texels, glm::dvec3(0));
  glm::dvec2 low(INFINITY), high(-INFINITY);
  std::string without;
  const auto for_triangles = [&](const auto& work) {
    for (const Part& part : surface.parts) {
      if (!part.wrinkles) continue;
      if (!part.has_uv) without = part.mesh;
      for (std::size_t t = part.first_triangle; part.has_uv && t < part.first_triangle + part.triangle_count;
           ++t) {
        std::array<glm::dvec2, 3> uv;
        for (std::size_t c = 0; c < 3; ++c) uv[c] = surface.render_vertices[surface.triangles[3 * t + c]].uv;
        work(t, uv);
      }
    }
  };
  for_triangles([&](std::size_t, const auto& uv) {
    for (const glm::dvec2& at : uv) low = glm::min(low, at), high = glm::max(high, at);
  });
  if (!(low.x <= high.x)) {
    throw Error(ExitCode::bad_input,
                without.empty() ? std::string("nothing of the model wrinkles, so there is nothing to bake")
                                : fmt::format("mesh '{}' has no uv; a map needs them", without));
  }
  const UvSquare square = uv_square(low, high, "leave the mesh that is far off out with --exclude");
  raster.corner = square.corner;
  raster.side = square.side;
  for_triangles([&](std::size_t t, std::array<glm::dvec2, 3> uv) {
    for (glm::dvec2& at : uv) at = square.place(at);
    draw(raster, t, uv);
  });
  widen(raster, widened);
  return raster;
}

}  // namespace plisse
