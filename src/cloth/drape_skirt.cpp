#include "cloth/drape_skirt.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include "cloth/drape_garment.h"

namespace plisse::cloth {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using shell::Positions;
using std::numbers::pi;

// --- the body
// -----------------------------------------------------------------------------------------------

constexpr double bottom = 0.35, top = 1.45, waist = 1.0;  // m above the ground
constexpr int rings = 92, around = 150;                   // 2 · 150 · 90 triangles

double bump(double y, double at, double width) {
  return std::exp(-(y - at) * (y - at) / (width * width));
}

// Half axes of the cross-section, across and from back to front, and how far back its middle is.
struct Section {
  double across, deep, back;
};
Section section(double y) {
  const double u = (2 * y - bottom - top) / (top - bottom);
  const double closing = std::sqrt(std::max(0.0, 1 - std::pow(u, 8)));  // round at both ends
  return {closing * (0.125 + 0.050 * bump(y, 0.80, 0.11) + 0.035 * bump(y, 1.27, 0.12)),
          closing * (0.092 + 0.034 * bump(y, 0.81, 0.10) + 0.028 * bump(y, 1.27, 0.12)),
          0.015 * bump(y, 0.80, 0.10)};
}

// Half axes over those of the waist, the largest from there down to y.
Vector2d widest_down_to(double y) {
  Vector2d widest(1, 1);
  const Section at_waist = section(waist);
  for (double at = waist; at > y; at -= 1e-3) {
    const Section s = section(at);
    widest = widest.cwiseMax(Vector2d(s.across / at_waist.across, (s.deep + s.back) / at_waist.deep));
  }
  return widest;
}

Vector3d on_body(double y, double angle) {  // from the front to the left of who wears it
  const Section s = section(y);
  return {s.across * std::sin(angle), y, s.deep * std::cos(angle) - s.back};
}

// Heights of the rings, the same way apart along the side.
const std::array<double, rings>& ring_heights() {
  static const std::array<double, rings> heights = [] {
    constexpr int fine = 20000;
    std::vector<double> length(fine + 1, 0), height(fine + 1);
    // By an angle, since the ends are steep.
    for (int k = 0; k <= fine; ++k)
      height[static_cast<std::size_t>(k)] =
          0.5 * (bottom + top) - 0.5 * (top - bottom) * std::cos(pi * k / fine);
    for (std::size_t k = 1; k <= fine; ++k)
      length[k] = length[k - 1] + std::hypot(height[k] - height[k - 1],
                                             section(height[k]).across - section(height[k - 1]).across);
    std::array<double, rings> result{};
    std::size_t k = 0;
    for (std::size_t ring = 0; ring < rings; ++ring) {
      const double at = length.back() * static_cast<double>(ring) / (rings - 1);
      while (k < fine && length[k] < at) ++k;
      result[ring] = height[k];
    }
    result.front() = bottom;
    result.back() = top;
    return result;
  }();
  return heights;
}

// The hips turn to either side and go with it; the chest stays.
Vector3d swayed(const Vector3d& p, double t) {
  const double share = 1 / (1 + std::exp((p.y() - 1.15) / 0.06)), swing = std::sin(2 * pi * t);
  const Eigen::AngleAxisd turn(share * swing * 15 * pi / 180, Vector3d::UnitY());
  return turn * p + Vector3d(0.05 * share * swing, 0, 0);
}

// --- the skirt
// ----------------------------------------------------------------------------------------------

constexpr double gap = 4e-3;  // obstacles begin to push
constexpr double band_height = 0.04, length = 0.5, gathering = 1.4, flare = 1.5;

// The waist's outline, a little off the body, by the share of its length from the front on.
class Waistline {
 public:
  Waistline() {
    constexpr int fine = 3600;
    for (int k = 0; k <= fine; ++k) {
      const double angle = 2 * pi * k / fine;
      Vector3d p = on_body(waist, angle);
      const Vector3d along = on_body(waist, angle + 1e-4) - on_body(waist, angle - 1e-4);
      p += 0.75 * gap * Vector3d(-along.z(), 0, along.x()).normalized();
      lengths_.push_back(points_.empty() ? 0 : lengths_.back() + (p - points_.back()).norm());
      points_.push_back(p);
    }
  }
  double length() const { return lengths_.back(); }
  Vector3d at(double share) const {
    share -= std::floor(share);
    const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, share * length());
    const auto k = static_cast<std::size_t>(next - lengths_.begin());
    const double inside = (share * length() - lengths_[k - 1]) / (lengths_[k] - lengths_[k - 1]);
    return points_[k - 1] + inside * (points_[k] - points_[k - 1]);
  }

 private:
  std::vector<Vector3d> points_;
  std::vector<double> lengths_;
};

// Seen from outside, x from right to left of who wears it: so counterclockwise is outward.
sizing::Garment pattern(double waistline) {
  const double band = waistline / 2, upper = gathering * band, lower = flare * upper;
  const sizing::Fabric fabric = *sizing::find_fabric("wine-style");  // any would do: see delaunay_mesh
  sizing::Garment garment;
  const auto panel = [&](const char* name, double below, double above, double high) {
    sizing::Panel made;
    made.name = name;
    made.fabric = fabric;
    made.fabric.warp = made.fabric.weft;
    made.outline = {{{-below / 2, 0}, {below / 2, 0}, {above / 2, high}, {-above / 2, high}}, true};
    garment.panels.push_back(made);
  };
  panel("front", lower, upper, length);
  panel("back", lower, upper, length);
  panel("band front", band, band, band_height);
  panel("band back", band, band, band_height);
  const auto sew = [&](const char* name, std::size_t a, glm::dvec2 a_from, glm::dvec2 a_to, std::size_t b,
                       glm::dvec2 b_from, glm::dvec2 b_to) {
    garment.seams.push_back({name, {a, a_from, a_to}, {b, b_from, b_to}});
  };
  const double l = lower / 2, u = upper / 2, w = band / 2;
  sew("left side", 0, {l, 0}, {u, length}, 1, {-l, 0}, {-u, length});
  sew("right side", 0, {-l, 0}, {-u, length}, 1, {l, 0}, {u, length});
  sew("left of the band", 2, {w, 0}, {w, band_height}, 3, {-w, 0}, {-w, band_height});
  sew("right of the band", 2, {-w, 0}, {-w, band_height}, 3, {w, 0}, {w, band_height});
  sew("front waist", 0, {-u, length}, {u, length}, 2, {-w, 0}, {w, 0});
  sew("back waist", 1, {-u, length}, {u, length}, 3, {-w, 0}, {w, 0});
  return garment;
}

}  // namespace

Positions torso_points(double t) {
  Positions points(3, (rings - 2) * around + 2);
  for (int ring = 1; ring + 1 < rings; ++ring)
    for (int i = 0; i < around; ++i)
      points.col((ring - 1) * around + i) =
          on_body(ring_heights()[static_cast<std::size_t>(ring)], 2 * pi * i / around);
  points.col(points.cols() - 2) = on_body(bottom, 0);
  points.col(points.cols() - 1) = on_body(top, 0);
  for (Eigen::Index v = 0; v < points.cols(); ++v) points.col(v) = swayed(points.col(v), t);
  return points;
}

std::vector<shell::Face> torso_faces() {
  std::vector<shell::Face> faces;
  const auto id = [](int ring, int i) {
    if (ring == 0) return static_cast<std::uint32_t>((rings - 2) * around);
    if (ring == rings - 1) return static_cast<std::uint32_t>((rings - 2) * around + 1);
    return static_cast<std::uint32_t>((ring - 1) * around + i % around);
  };
  for (int ring = 0; ring + 1 < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      if (ring > 0) faces.push_back({id(ring, i), id(ring, i + 1), id(ring + 1, i)});
      if (ring + 2 < rings) faces.push_back({id(ring, i + 1), id(ring + 1, i + 1), id(ring + 1, i)});
    }
  return faces;
}

DrapeScene skirt_scene(int vertices, std::uint32_t seed) {
  const Waistline line;
  const sizing::Garment garment = pattern(line.length());
  const SewnGarment sewn = sew_garment(garment, vertices, seed);
  DrapeScene scene;
  scene.rest = sewn.rest.points;
  scene.rest_faces = sewn.rest.faces;
  scene.faces = sewn.faces;
  scene.material = {2e5, 0.3, 5e-4, 300};
  scene.loads.gravity << 0, -9.81, 0;
  scene.loads.gap = gap;

  // Round the body on a cone that begins at the waist, as wide as the body needs: the panels' shares of their
  // width become shares of the circumference.
  Positions placed(3, sewn.rest.points.cols());
  std::vector<std::uint32_t> held;
  for (Eigen::Index v = 0; v < placed.cols(); ++v) {
    const std::size_t panel = sewn.panel[static_cast<std::size_t>(v)];
    const Vector2d p = sewn.rest.points.col(v).head<2>();
    const bool band = panel >= 2;
    const double down = band ? 0 : 1 - p.y() / length;
    const double width = band ? line.length() / 2 : gathering * line.length() / 2 * (1 + (flare - 1) * down);
    const Vector3d at = line.at(0.5 * p.x() / width + (panel % 2 == 0 ? 0.0 : 0.5));
    const double y = band ? waist + p.y() - band_height : waist - band_height - length * down;
    const Vector2d wider = (1 + 0.6 * down) * widest_down_to(y);
    placed.col(v) << wider[0] * at.x(), y, wider[1] * at.z();
    if (band && p.y() > band_height * (1 - 1e-6)) held.push_back(sewn.base_of[static_cast<std::size_t>(v)]);
  }
  scene.start = sewn.sewn(placed);
  scene.frames = 24;
  scene.conditions = [held, start = scene.start](double t) {
    shell::Conditions conditions(static_cast<std::size_t>(start.cols()));
    for (const std::uint32_t v : held) conditions.hold(v, swayed(start.col(v), t));
    return conditions;
  };
  scene.obstacles = [faces = torso_faces()](double t) {
    return std::vector<shell::Obstacle>{
        std::make_shared<shell::TriangleBody>(torso_points(t), faces, "the torso")};
  };
  scene.loads.obstacles = scene.obstacles(0);
  scene.measures = [](const Positions& x) {
    return std::map<std::string, double>{{"hem_m", x.row(1).minCoeff()}};
  };
  return scene;
}

}  // namespace plisse::cloth
