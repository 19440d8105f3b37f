// Reference of the relax pass (Loviscach 2006, section 5.2; docs/passes.md, "Relax"): aligns the waves of
// neighbouring vertices, by the paper's descent, and by rule 3 of "State over time" where wrinkles appear.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <vector>

#include "reference/crush.h"
#include "reference/topology.h"

namespace plisse::reference {

// One pose's waves, an entry a vertex. Wavenumbers are world vectors (t', b')κ in turns per length.
struct WaveField {
  Eigen::Matrix3Xd positions;    // x'
  Eigen::Matrix3Xd wavenumbers;  // κ
  Eigen::VectorXd weights;       // w
  std::vector<Status> status;
  Eigen::VectorXd phases;  // φ, radians in (−π, π]
};

// A WaveField from a posed surface and the results of crush.
WaveField wave_field(const Eigen::Matrix3Xd& positions, const Frames& frames,
                     const std::vector<CrushResult>& crushed, const Eigen::VectorXd& phases);

// Relation of the phases of neighbour n and vertex 0: their waves agree at the midpoint of the edge if φ_0/2π
// = sign·φ_n/2π + offset.
struct Transport {
  double sign = 1;    // −1 where κ_n·κ_0 < 0
  double offset = 0;  // turns
};
Transport transport(const WaveField& field, Eigen::Index vertex, Eigen::Index neighbour);

// d_n = ψ_n − ψ_0 wrapped to (−½, ½] turns.
double phase_error(const WaveField& field, Eigen::Index vertex, Eigen::Index neighbour);

// E_0 = 1/N Σ w_n (d_n/turn)², turns², w_n = 0 for neighbours that are not set; 0 without neighbours.
double vertex_error(const Topology& topology, const WaveField& field, Eigen::Index vertex);

// One round of eq. 6, φ_0 ← φ_0 − ε ∂E_0/∂φ_0 at all set vertices at once.
void descent_round(const Topology& topology, WaveField& field, double epsilon);

// One round of spreading at onset: fresh vertices with set neighbours take a phase from them and become set.
// Returns their number.
int onset_round(const Topology& topology, WaveField& field);

// One round of complex smoothing, z ← ½z + ½ mean of the transported z of neighbours, at all fresh vertices
// at once.
void smoothing_round(const Topology& topology, const WaveField& field, std::vector<std::complex<double>>& z);

struct RelaxSettings {
  bool smooth = true;  // false: the paper's descent alone
  int descent_rounds = 1;
  double epsilon = 13.2;       // ε of eq. 6
  int onset_rounds = 8;        // P
  int smoothing_rounds = 300;  // S
};

// A frame's whole relaxation: onset first (smooth), then descent. Changes phases and status of the field.
void relax(const Topology& topology, WaveField& field, const RelaxSettings& settings);

// Closes a loop: moves each phase whose status is `which`, and whose vertex was set in the target moment, by
// `share` of the difference to the phase of that moment (with the opposite sign where k has the opposite
// sign). A fresh vertex becomes set. Phases in radians, an entry a vertex.
void lead(Eigen::VectorXd& phases, std::vector<CrushState>& states, const Eigen::VectorXd& aim_phases,
          const std::vector<CrushState>& aim_states, Status which, double share);

// --- measures of a relaxed field

// E[d²] in turns² over directed edges between wrinkled (w > 0) vertices; 0 without any.
double misfit(const Topology& topology, const WaveField& field);

// ⟨|κ̂·axis|⟩ over wrinkled vertices with κ ≠ 0, `axis` a unit vector: 1 if all waves are parallel to it.
double parallelism(const WaveField& field, const Eigen::Vector3d& axis);

// The wavelength along `axis` that follows from the phases (a length of the pose): least squares of the phase
// difference of two vertices over their distance along the axis, over directed edges between wrinkled
// vertices.
double mean_wavelength(const Topology& topology, const WaveField& field, const Eigen::Vector3d& axis);

}  // namespace plisse::reference
