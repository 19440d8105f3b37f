#include "reference/displacement.h"

#include <algorithm>
#include <cmath>

#include "reference/functions.h"

namespace plisse::reference {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Where the angle between a triangle's plane normal and the interpolated normal is beyond 87°, the plane
// cannot be projected along that normal; then eq. 7 is used.
constexpr double steepest = 0.05;

// Some unit vector at right angles to n.
Vector3d perpendicular(const Vector3d& n) {
  Eigen::Index smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  return n.cross(Vector3d::Unit(smallest)).normalized();
}

// The tangential displacement of a field's waves (Chen et al. 2021, v₂): ⅛ A² sin 2φ ∇φ, which makes the
// strain constant along a wave; where waves are steeper than s = A|∇φ| = 2, with 1/(2s²) in place of ⅛, since
// the cloth would fold over itself. And its derivative by the position in the triangle's plane, with ∇φ and s
// taken as constant: they change over the radius of the crests, the other factors over a wavelength.
struct InPlane {
  Vector3d motion = Vector3d::Zero();
  Matrix3d gradient = Matrix3d::Zero();
};

InPlane in_plane_motion(const CarriedField& field, const Matrix3d& corners, const Vector3d& barycentric,
                        Blend blend) {
  const FieldSample at = sample(field, corners, barycentric, blend);
  const Vector3d amplitude_slope = barycentric_gradients(corners) * field.amplitudes;
  const Vector3d phase_slope = 2 * pi * at.slope;
  const double twice = 4 * pi * at.turns, a = at.amplitude;
  const double slope = a * phase_slope.norm(), share = slope > 2 ? 0.5 / (slope * slope) : 0.125;
  const Vector3d climb =
      2 * share * a * (std::sin(twice) * amplitude_slope + a * std::cos(twice) * phase_slope);
  return {share * a * a * std::sin(twice) * phase_slope, phase_slope * climb.transpose()};
}

}  // namespace

Displaced displace(const Triangle& triangle, const Matrix3d& directions, const Vector3d& barycentric,
                   const Profile& profile, Blend blend, double cavity) {
  const Matrix3d& corners = triangle.waves.corners;
  const HeightSample waves = height_and_gradient(triangle.waves, barycentric, profile, blend, Gradient::full);
  Displaced result;
  result.height = waves.height;
  result.amplitude = (profile.coarse + profile.fine) * waves.weights.dot(triangle.waves.heights);
  Vector3d gradient = waves.gradient;
  InPlane sliding;
  const Matrix3d slopes = barycentric_gradients(corners);
  double longest = triangle.waves.wavenumbers.colwise().norm().maxCoeff();
  if (triangle.field) {
    const FieldSample carried = sample(*triangle.field, corners, barycentric, blend);
    result.height += carried.height;
    result.amplitude += carried.amplitude;
    gradient += carried.gradient;
    const Matrix3d planes = slopes * triangle.field->turns.transpose();
    longest = planes.colwise().norm().maxCoeff();
    for (int j = 0; j < 3; ++j)
      if (triangle.waves.heights[j] > 0)
        longest = std::max(longest, triangle.waves.wavenumbers.col(j).norm());
    if (carried.amplitude > 0) sliding = in_plane_motion(*triangle.field, corners, barycentric, blend);
  }
  result.sky_front = groove_occlusion(cavity, result.amplitude, result.height, longest);
  result.sky_back = groove_occlusion(cavity, result.amplitude, -result.height, longest);

  const Vector3d mean = directions * barycentric;
  const double length = mean.norm();
  const Vector3d d = length > 0 ? Vector3d(mean / length) : Vector3d::Zero();
  result.base = corners * barycentric;
  result.position = result.base + sliding.motion + result.height * d;

  const Vector3d n = (triangle.normals * barycentric).normalized();
  result.normal = (n - gradient).normalized();
  Vector3d plane = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
  plane = plane.norm() > 0 ? Vector3d(plane.normalized()) : Vector3d::Zero();
  const double upright = n.dot(plane);
  if (std::abs(upright) < steepest || length == 0) return result;
  const Vector3d first = perpendicular(n), tangents[2] = {first, n.cross(first)};
  Vector3d moved[2];  // their images
  for (int i = 0; i < 2; ++i) {
    const Vector3d& t = tangents[i];
    const Vector3d e = t - t.dot(plane) / upright * n;  // in the triangle's plane, above t
    const Vector3d turning = directions * (slopes.transpose() * e);
    const Vector3d bend = (turning - d.dot(turning) * d) / length;  // ∂d/∂e
    const Vector3d slide = sliding.gradient * e;
    moved[i] = t + slide - n.dot(slide) * n + gradient.dot(e) * n + result.height * (bend - n.dot(bend) * n);
  }
  const Vector3d normal = moved[0].cross(moved[1]);
  // A height above the radius of curvature turns the surface over; then eq. 7 is better.
  if (normal.dot(n) > 0) result.normal = normal.normalized();
  return result;
}

}  // namespace plisse::reference
