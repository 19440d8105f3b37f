#include "reference/waves.h"

#include <cmath>
#include <utility>

#include "reference/functions.h"

namespace plisse::reference {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Profile sinusoid() {
  return {[](double turns) { return std::cos(2 * pi * turns); },
          [](double turns) { return -std::sin(2 * pi * turns); }, 1};
}

Profile tabulated(std::vector<double> height, std::vector<double> slope, double slope_power) {
  const auto lookup = [](std::vector<double> table) {
    return [table = std::move(table)](double turns) {
      const double position = (turns - std::floor(turns)) * static_cast<double>(table.size());
      const auto index = static_cast<std::size_t>(position);
      const double t = position - static_cast<double>(index);
      return (1 - t) * table[index % table.size()] + t * table[(index + 1) % table.size()];
    };
  };
  return {lookup(std::move(height)), lookup(std::move(slope)), slope_power};
}

Matrix3d barycentric_gradients(const Matrix3d& corners) {
  const Vector3d b = corners.col(1) - corners.col(0), c = corners.col(2) - corners.col(0);
  const Vector3d normal = b.cross(c);
  Matrix3d gradients = Matrix3d::Zero();
  if (!(normal.squaredNorm() > 0)) return gradients;
  // The dual basis of b and c within their plane: ∇β·b = 1, ∇β·c = 0, and so on.
  gradients.col(1) = c.cross(normal) / normal.squaredNorm();
  gradients.col(2) = normal.cross(b) / normal.squaredNorm();
  gradients.col(0) = -gradients.col(1) - gradients.col(2);
  return gradients;
}

namespace {

// The share of an edge in the smooth blend, and the position of a point along the edge.
struct EdgeBlend {
  double share;  // e = (product of the coordinates of its two ends)²
  Vector3d share_gradient;
  double along;  // S(s): 0 at the edge's start, 1 at its end
  Vector3d along_gradient;
};

// Edge from corner i to corner j; k is the third one.
EdgeBlend edge_blend(const Matrix3d& corners, const Matrix3d& gradients, const Vector3d& barycentric, int i,
                     int j, int k) {
  const double bi = barycentric[i], bj = barycentric[j], bk = barycentric[k];
  const Vector3d edge = corners.col(j) - corners.col(i);
  const double third =
      edge.squaredNorm() > 0 ? (corners.col(k) - corners.col(i)).dot(edge) / edge.squaredNorm() : 0;
  const double s = bj + bk * third;
  const double inside = s > 0 && s < 1 ? 1 : 0;
  EdgeBlend blend;
  blend.share = bi * bi * bj * bj;
  blend.share_gradient = 2 * bi * bj * (bj * gradients.col(i) + bi * gradients.col(j));
  blend.along = smoothstep(0, 1, s);
  blend.along_gradient = inside * 6 * s * (1 - s) * (gradients.col(j) + third * gradients.col(k));
  return blend;
}

BlendWeights smooth_weights(const Matrix3d& corners, const Matrix3d& gradients, const Vector3d& barycentric) {
  // Edge i runs from corner i to corner i + 1.
  const EdgeBlend edges[3] = {edge_blend(corners, gradients, barycentric, 0, 1, 2),
                              edge_blend(corners, gradients, barycentric, 1, 2, 0),
                              edge_blend(corners, gradients, barycentric, 2, 0, 1)};
  double total = 1e-20;
  Vector3d total_gradient = Vector3d::Zero();
  for (const EdgeBlend& edge : edges) {
    total += edge.share;
    total_gradient += edge.share_gradient;
  }
  BlendWeights result;
  // At a corner no edge has a share; the limit of the weights is the corner's own wave, with gradient 0.
  if (barycentric.maxCoeff() == 1) return {barycentric, Matrix3d::Zero()};
  for (int j = 0; j < 3; ++j) {
    const EdgeBlend& out = edges[j];           // starts at this corner
    const EdgeBlend& in = edges[(j + 2) % 3];  // ends at it
    result.weights[j] = (out.share * (1 - out.along) + in.share * in.along) / total;
    const Vector3d numerator_gradient = out.share_gradient * (1 - out.along) -
                                        out.share * out.along_gradient + in.share_gradient * in.along +
                                        in.share * in.along_gradient;
    result.gradients.col(j) = (numerator_gradient - result.weights[j] * total_gradient) / total;
  }
  return result;
}

}  // namespace

BlendWeights blend_weights(const Matrix3d& corners, const Vector3d& barycentric, Blend blend) {
  const Matrix3d gradients = barycentric_gradients(corners);
  if (blend == Blend::linear) return {barycentric, gradients};
  return smooth_weights(corners, gradients, barycentric);
}

Matrix3d corner_turns(const WaveTriangle& triangle) {
  Matrix3d turns;
  for (int j = 0; j < 3; ++j)
    for (int corner = 0; corner < 3; ++corner)
      turns(j, corner) =
          triangle.wavenumbers.col(j).dot(triangle.corners.col(corner) - triangle.corners.col(j)) +
          triangle.phases[j] / (2 * pi);
  return turns;
}

HeightSample height_and_gradient(const WaveTriangle& triangle, const Vector3d& barycentric,
                                 const Profile& profile, Blend blend, Gradient gradient, const Vector3d& fade,
                                 const Vector3d& fine_fade) {
  const BlendWeights blended = blend_weights(triangle.corners, barycentric, blend);
  const Vector3d turns = corner_turns(triangle) * barycentric;
  HeightSample sample;
  sample.weights = blended.weights;
  for (int j = 0; j < 3; ++j) {
    double height = profile.coarse * fade[j] * profile.height(turns[j]);  // H_j/h_j
    double climb = profile.coarse * fade[j] * profile.slope(turns[j]);
    if (profile.fine_waves > 0) {
      const double fine = profile.fine * fine_fade[j], fine_turns = profile.fine_waves * turns[j];
      height += fine * profile.height(fine_turns);
      climb += fine * profile.fine_waves * profile.slope(fine_turns);
    }
    height *= triangle.heights[j];
    const Vector3d slope = 2 * pi * triangle.heights[j] * climb * triangle.wavenumbers.col(j);  // D_j
    sample.height += blended.weights[j] * height;
    sample.gradient += blended.weights[j] * slope;
    if (gradient == Gradient::full) sample.gradient += height * blended.gradients.col(j);
  }
  return sample;
}

FieldSample sample(const CarriedField& field, const Matrix3d& corners, const Vector3d& barycentric,
                   Blend blend) {
  const BlendWeights blended = blend_weights(corners, barycentric, blend);
  const Matrix3d plane_slopes = barycentric_gradients(corners) * field.turns.transpose();  // column j: ∇τ_j
  const Vector3d turns = field.turns * barycentric;
  FieldSample result;
  result.amplitude = barycentric.dot(field.amplitudes);
  result.turns = blended.weights.dot(turns);
  result.slope = plane_slopes * blended.weights + blended.gradients * turns;
  const double phase = 2 * pi * result.turns;
  result.height = result.amplitude * std::cos(phase);
  result.gradient = std::cos(phase) * (barycentric_gradients(corners) * field.amplitudes) -
                    2 * pi * result.amplitude * std::sin(phase) * result.slope;
  return result;
}

}  // namespace plisse::reference
