// The height field over one triangle (Loviscach 2006, eq. 5 and 8; docs/passes.md, "Render"): three plane
// waves and the weights that blend them. Points are given by barycentric coordinates; vectors and lengths are
// in one unit.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

namespace plisse::reference {

enum class Blend { linear, smooth };  // weights of a triangle's three waves
enum class Gradient { paper, full };  // eq. 8 as printed, or with the gradient of the weights

// f and f' = df/dphase (phase in radians) as functions of turns, period 1, f even.
struct Profile {
  std::function<double(double)> height;
  std::function<double(double)> slope;
  double slope_power = 1;  // m: the mean of f'² over ½
  // Finer waves on each ("Finer waves"): coarse f(τ) + fine f(fine_waves τ).
  int fine_waves = 0;
  double coarse = 1, fine = 0;
};
Profile sinusoid();
// f and f' from tables of equal size with linear interpolation, entry i at i/N turns, as in the shaders.
Profile tabulated(std::vector<double> height, std::vector<double> slope, double slope_power);

// Column or entry j belongs to corner j (A, B, C).
struct WaveTriangle {
  Eigen::Matrix3d corners;      // x'_j
  Eigen::Matrix3d wavenumbers;  // κ_j, world
  Eigen::Vector3d heights;      // h_j
  Eigen::Vector3d phases;       // φ_j, radians
};

// Columns ∇α, ∇β, ∇γ in the triangle's plane; 0 for a triangle of zero area.
Eigen::Matrix3d barycentric_gradients(const Eigen::Matrix3d& corners);

struct BlendWeights {
  Eigen::Vector3d weights;    // w_j
  Eigen::Matrix3d gradients;  // columns ∇w_j, in the triangle's plane
};
BlendWeights blend_weights(const Eigen::Matrix3d& corners, const Eigen::Vector3d& barycentric, Blend blend);

// τ_j at the corners, turns: row j, column corner. τ is linear: times barycentric coordinates it is τ at that
// point.
Eigen::Matrix3d corner_turns(const WaveTriangle& triangle);

struct HeightSample {
  double height = 0;                  // Σ w_j H_j
  Eigen::Vector3d gradient{0, 0, 0};  // ∇h, world
  Eigen::Vector3d weights{0, 0, 0};   // w_j
};
// The height field at a point of the triangle. `fade` multiplies each wave (1 for waves much longer than a
// pixel), `fine_fade` its finer ones.
HeightSample height_and_gradient(const WaveTriangle& triangle, const Eigen::Vector3d& barycentric,
                                 const Profile& profile, Blend blend, Gradient gradient,
                                 const Eigen::Vector3d& fade = Eigen::Vector3d::Ones(),
                                 const Eigen::Vector3d& fine_fade = Eigen::Vector3d::Ones());

// A solved wrinkle field over one triangle (docs/passes.md, "Fields"): height A cos 2πθ with A and θ blended
// first.
struct CarriedField {
  Eigen::Matrix3d turns;       // row j: the turns of corner j's plane at the three corners
  Eigen::Vector3d amplitudes;  // a_j
};
struct FieldSample {
  double amplitude = 0;               // A
  double turns = 0;                   // θ
  Eigen::Vector3d slope{0, 0, 0};     // ∇θ, turns per length
  double height = 0;                  // A cos 2πθ
  Eigen::Vector3d gradient{0, 0, 0};  // of the height
};
FieldSample sample(const CarriedField& field, const Eigen::Matrix3d& corners,
                   const Eigen::Vector3d& barycentric, Blend blend);

}  // namespace plisse::reference
