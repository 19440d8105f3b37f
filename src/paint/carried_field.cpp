#include "paint/carried_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace plisse::paint {
namespace {

using std::numbers::pi;

std::uint32_t welded(const Surface& surface, std::size_t corner) {
  return surface.render_vertices[surface.triangles[corner]].welded;
}

// The gradients of barycentric coordinates in a triangle's plane, 0 for triangles without area; and twice the
// area.
struct Plane {
  std::array<glm::dvec3, 3> gradient{};
  double twice_area = 0;
};

Plane plane_of(const Surface& surface, std::size_t t) {
  std::array<glm::dvec3, 3> x;
  for (std::size_t c = 0; c < 3; ++c) x[c] = surface.rest[welded(surface, 3 * t + c)];
  const glm::dvec3 n = glm::cross(x[1] - x[0], x[2] - x[0]);
  Plane plane;
  plane.twice_area = glm::length(n);
  const double square = plane.twice_area * plane.twice_area;
  if (!(square > 0)) return plane;
  for (std::size_t c = 0; c < 3; ++c)
    plane.gradient[c] = glm::cross(n, x[(c + 2) % 3] - x[(c + 1) % 3]) / square;
  return plane;
}

// Slopes of lengths that are 1 + u², at equal steps of u, in which the slope is nearly linear.
class Slopes {
 public:
  Slopes() {
    for (std::size_t i = 1; i <= steps; ++i) {
      const double u = static_cast<double>(i) * step, wanted = 1 + u * u;
      // Newton's method from the two before, or from L = 1 + s²/4, with a difference for the derivative: L is
      // smooth and convex.
      double s = i == 1 ? 2 * u : 2 * values_[i - 1] - values_[i - 2];
      for (int round = 0; round < 3; ++round) {
        const double small = 1e-6 * s, length = arc_length(s);
        s += (wanted - length) * small / (arc_length(s + small) - length);
      }
      values_[i] = s;
    }
  }
  double at(double length) const {
    if (!(length > 1)) return 0;
    const double place = std::sqrt(length - 1) / step;
    if (place >= steps) return 0.5 * pi * length;  // L tends to 2s/π; from 50 on within 1e-3
    const auto i = static_cast<std::size_t>(place);
    return std::lerp(values_[i], values_[i + 1], place - static_cast<double>(i));
  }

 private:
  static constexpr std::size_t steps = 7000;
  static constexpr double step = 1e-3;
  std::array<double, steps + 1> values_{};
};

}  // namespace

double arc_length(double slope) {
  const double stretched = std::sqrt(1 + slope * slope);
  return 2 / pi * stretched * std::comp_ellint_2(slope / stretched);
}

double slope_of_length(double length) {
  static const Slopes slopes;
  return slopes.at(length);
}

CarriedField::CarriedField(const Surface& surface, std::vector<FieldTriangle> at_rest,
                           std::vector<double> mask)
    : surface_(surface),
      at_rest_(std::move(at_rest)),
      mask_(std::move(mask)),
      along_(surface.vertex_count(), glm::dvec3(0)),
      omega_(surface.vertex_count(), 0) {
  std::vector<double> areas(surface.vertex_count(), 0);
  for (std::size_t t = 0; t < at_rest_.size(); ++t) {
    const Plane plane = plane_of(surface_, t);
    for (std::size_t j = 0; j < 3; ++j) {
      if (!(at_rest_[t].amplitude[j] > 0)) continue;
      const std::uint32_t v = welded(surface_, 3 * t + j);
      for (std::size_t k = 0; k < 3; ++k)
        along_[v] += plane.twice_area * 2 * pi * at_rest_[t].turns[j][k] * plane.gradient[k];
      areas[v] += plane.twice_area;
    }
  }
  for (std::size_t v = 0; v < along_.size(); ++v) {
    const double sum = glm::length(along_[v]);
    if (!(sum > 0)) continue;
    omega_[v] = sum / areas[v];
    along_[v] /= sum;
  }
}

std::vector<FieldTriangle> CarriedField::in(const std::vector<glm::dvec3>& posed) const {
  // λ of each vertex: the mean over its triangles, by their areas at rest.
  std::vector<double> stretch(along_.size(), 0), areas(along_.size(), 0);
  for (std::size_t t = 0; t < at_rest_.size(); ++t) {
    const Plane plane = plane_of(surface_, t);
    if (!(plane.twice_area > 0)) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint32_t v = welded(surface_, 3 * t + j);
      if (!(omega_[v] > 0)) continue;
      glm::dvec3 moved(0), kept(0);  // F ĝ; and ĝ itself in this plane
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t w = welded(surface_, 3 * t + k);
        const double part = glm::dot(plane.gradient[k], along_[v]);
        moved += part * posed[w];
        kept += part * surface_.rest[w];
      }
      if (!(glm::length(kept) > 0)) continue;
      stretch[v] += plane.twice_area * glm::length(moved) / glm::length(kept);
      areas[v] += plane.twice_area;
    }
  }
  std::vector<double> factor(along_.size(),
                             0);  // a over a at rest, of the slope that one amplitude stands for
  std::vector<FieldTriangle> now = at_rest_;
  for (std::size_t t = 0; t < now.size(); ++t) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint32_t v = welded(surface_, 3 * t + j);
      double& a = now[t].amplitude[j];
      if (a > 0 && omega_[v] > 0 && areas[v] > 0) {
        const double lambda = std::max(stretch[v] / areas[v], 1e-3);
        if (factor[v] == 0) {
          const double slope = slope_of_length(arc_length(a * omega_[v]) / lambda);
          factor[v] = lambda * slope / (a * omega_[v]);
        }
        a *= factor[v];
      }
      a *= mask_[v];
    }
  }
  return now;
}

}  // namespace plisse::paint
