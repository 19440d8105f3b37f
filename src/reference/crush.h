// Reference of the crush pass (Loviscach 2006, sections 4.2 and 5.1; docs/passes.md, "Crush"): strength and
// direction of the compression at every vertex, and the wave that takes up the lost length.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <optional>
#include <vector>

#include "reference/topology.h"

namespace plisse::reference {

enum class Status : std::uint8_t { idle = 0, set = 1, fresh = 2 };

struct CrushSettings {
  double dead_zone = 0.005;  // δ, of 1 − r
  bool smooth = true;        // relax mode `smooth`; false: `descent`, where every vertex is always set
  bool unstrained = false;   // M = E: only the bias shortens, which is of the pose itself
};

// State from frame to frame.
struct CrushState {
  Eigen::Vector2d direction{0, 0};  // k in (t, b), unit; (0, 0) = unset
  Status status = Status::idle;
};

// What is painted on the rest pose, of each vertex; or nothing.
struct Bias {
  Eigen::Matrix3Xd p;                        // as columns
  std::vector<std::optional<double>> phase;  // φ of the wave along p, radians: where there is a solved field
  Eigen::Matrix3Xd carried;  // ĝ, as columns: unit, or 0; along which a carried field takes up the animation
};

struct CrushResult {
  Eigen::Matrix2d M;                // (t, b) → (t', b')
  double r = 1;                     // σ₂, the least stretch
  double stretch = 1;               // σ₁, the greatest stretch
  double gap = 0;                   // g = (σ₁² − σ₂²)/(σ₁² + σ₂²)
  Eigen::Vector2d minimum{0, 1};    // k̂ of this pose alone; its sign is k's where k was set, else arbitrary
  Eigen::Vector2d direction{0, 0};  // k, the new state
  Eigen::Vector2d wave_vector{0, 0};  // k' in (t', b'), of length 1/r for k = k̂
  Eigen::Vector2d wavenumber{0, 0};   // κ = k'/W, turns per length
  double height = 0;                  // h, a length
  double weight = 0;                  // w in relax, 0…1
  Status status = Status::idle;       // the new state
  std::optional<double> phase;        // φ of a wave that came back as its field's, of `direction`
};

// The linear regression of eq. 1 with its regularisation: for v' = Fv, M = F + μ(E − F)(S + μE)⁻¹. Columns
// are v_i and v'_i; without any length in v it is E.
Eigen::Matrix2d regression(const Eigen::Matrix2Xd& v, const Eigen::Matrix2Xd& posed);

// k' = M⁻ᵀk with singular values floored at 0.05: from M's singular value decomposition.
Eigen::Vector2d wave_vector(const Eigen::Matrix2d& M, const Eigen::Vector2d& k);

// Eq. 2 with the dead zone: h/W of mask 1.
double relative_height(double r, double dead_zone);

// The whole computation for one vertex, after its regression.
CrushResult crush_vertex(const Eigen::Matrix2d& M, double wavelength, double mask,
                         const CrushSettings& settings, const CrushState& previous);

// M(E − q⊗q) with q the components of p in the rest frame (basis: t and b as columns), cut to a length of .99
// (section 7).
Eigen::Matrix2d biased(const Eigen::Matrix2d& M, const Eigen::Matrix<double, 3, 2>& rest_basis,
                       const Eigen::Vector3d& p);

// M(E + (1/|Mĝ| − 1) ĝ⊗ĝ), ĝ in (t, b), unit: as long along ĝ as at rest; |Mĝ| counts as .05 at least.
Eigen::Matrix2d without_stretch_along(const Eigen::Matrix2d& M, const Eigen::Vector2d& direction);

// A wave that was idle, or more than 45 degrees from the solved wave along q (in (t, b)), and is now within
// them has that one's phase, with the sign that its k has to q; it is set at once.
void begin_as_solved(const Eigen::Vector2d& q, double phase, const CrushState& previous, CrushResult& vertex);

// The whole pass. `wavelength` and `mask` have one entry a vertex; `previous` is the state of the last frame.
std::vector<CrushResult> crush(const Topology& topology, const Frames& rest_frames,
                               const Eigen::Matrix3Xd& positions, const Frames& frames,
                               const Eigen::VectorXd& wavelength, const Eigen::VectorXd& mask,
                               const CrushSettings& settings, const std::vector<CrushState>& previous,
                               const Bias& bias = {});

}  // namespace plisse::reference
