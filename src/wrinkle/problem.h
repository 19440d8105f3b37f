// The discrete wrinkle problem (39) in unknowns without equality constraints: amplitudes of the free
// vertices, phases of the phase vertices, one period a loop.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <vector>

#include "wrinkle/energy.h"
#include "wrinkle/local_waves.h"
#include "wrinkle/phase_complex.h"

namespace plisse::wrinkle {

// A state.
struct Waves {
  Eigen::VectorXd amplitude;  // a, metres, one a base vertex, ≥ 0
  Eigen::VectorXd phase;      // φ, radians, one a phase vertex
  Eigen::VectorXd period;     // τ, radians, one a generator
};

class Problem {
 public:
  using SparseMatrix = Eigen::SparseMatrix<double>;

  // wrinkle_free: one flag a face; those faces and their vertices have no amplitude and add no energy.
  // clamped: one flag a vertex whose amplitude is 0 as well; may be empty.
  Problem(shell::Topology topology, std::vector<FaceForms> forms, const Model& model,
          std::vector<bool> wrinkle_free, std::vector<bool> clamped = {});

  const shell::Topology& topology() const { return topology_; }
  const std::vector<FaceForms>& forms() const { return forms_; }
  const Model& model() const { return model_; }
  const PhaseComplex& complex() const { return complex_; }
  const std::vector<bool>& live() const { return live_; }      // one a face: carries energy
  const std::vector<bool>& pinned() const { return pinned_; }  // one a vertex: a = 0
  const std::vector<bool>& wrinkle_free() const { return wrinkle_free_; }

  const std::vector<LocalWaves>& own_waves() const { return own_waves_; }  // one a face (local_waves.h)

  // Scales that make unknowns dimensionless: the largest √(2s₀)/|ω| and |ω| of the live faces' own
  // waves (start.h); never 0.

  // Largest amplitudes, in the scale, one a free amplitude: √(2s₀)/|ω| of the patch's strongest compression
  // and of one wave over the patch's diameter. Longer waves belong to the shape of the base surface; where
  // nothing else limits the wavelength (flat, free boundary), the energy alone has no minimum. And at most
  // the room that the forms of the faces leave.
  const Eigen::VectorXd& upper() const { return upper_; }

  // Unknowns in one vector, all dimensionless: free amplitudes over the scale, phases, periods.
  Eigen::Index size() const { return size_; }
  Eigen::Index amplitude_count() const { return amplitude_count_; }
  Eigen::Index phase_begin() const { return amplitude_count_; }
  Eigen::Index period_begin() const {
    return amplitude_count_ + static_cast<Eigen::Index>(complex_.vertices);
  }
  Eigen::VectorXd pack(const Waves& waves) const;
  Waves unpack(const Eigen::VectorXd& x) const;

  // Copies the values of one patch (patches.h), with amplitudes times `height`.
  void copy_patch(const std::vector<std::uint32_t>& faces, const Waves& from, Waves& to,
                  double height = 1) const;

  // Joules, over live faces, above their relaxed energy and without the base surface's own bending.
  double energy(const Eigen::VectorXd& x) const;
  // What rounding may make of it, J: differences of energies below that say nothing.
  double rounding(const Eigen::VectorXd& x) const;
  // The parts of it, one a face; 0 where none is.
  Eigen::VectorXd face_energies(const Eigen::VectorXd& x) const;
  // J, one an unknown: what tethers the phases of a state (solve.h) in proportion to the energy that its
  // waves take up, each face's to its corners alike, times a². 0 for amplitudes, which the energy determines
  // by itself, and which have to come to 0 where there are no waves; and for periods.
  Eigen::VectorXd taken_up(const Eigen::VectorXd& x) const;
  // J: the relaxed energy of the live faces, and the whole energy of faces with pinned corners that are not
  // wrinkle-free.
  double relaxed_energy() const { return relaxed_energy_; }
  double gradient(const Eigen::VectorXd& x, Eigen::VectorXd& first) const;
  // The second derivatives at a state: lower halves, all of the pattern, each the sum of the faces' own
  // parts. Those that only some steps need are made when first asked for.
  class Curvature {
   public:
    explicit Curvature(const Problem& problem);
    // Another state: its energy, J, and the energy's derivatives.
    double at(const Eigen::VectorXd& x, Eigen::VectorXd& first);
    const SparseMatrix& exact() const { return exact_; }
    // What makes each face's part the nearest positive semidefinite one, amplitudes and frequencies measured
    // by the problem's scales: less their negative eigenvalues.
    const SparseMatrix& nearest();
    const SparseMatrix& metric();  // M, of FaceEnergy::metric
    // As much of each face's M as makes its part positive semidefinite: cheaper, and of the same kind as M.
    const SparseMatrix& lift();

   private:
    struct Part {
      SparseMatrix matrix;
      bool known = false;  // at this state
    };
    template <typename Each>
    void sum(SparseMatrix& matrix, const Each& each);
    template <typename Each>
    const SparseMatrix& made(Part& part, const Each& each);

    const Problem& problem_;
    SparseMatrix exact_;
    Part nearest_, lift_, metric_;
    std::vector<LocalVector> states_;    // of each face
    std::vector<LocalMatrix> hessians_;  // and its own part
    std::vector<double> parts_;
  };
  // The pattern, zeros filled in.
  const SparseMatrix& pattern() const { return pattern_; }

  // The same energy of amplitudes and a one-form (radians, one an edge) that need not be closed: each face
  // takes its gradient from its first two sides, as section E.3 says. `first` by the unknowns of this
  // problem.
  double one_form_energy(const Eigen::VectorXd& amplitude, const Eigen::VectorXd& one_form,
                         Eigen::VectorXd& first) const;
  // ω of every edge; 0 where no live face touches it.
  Eigen::VectorXd one_form(const Waves& waves) const;

 private:
  struct Face {
    std::uint32_t face;
    FaceEnergy energy;
    std::vector<Eigen::Index> unknown;  // global, −1 where pinned; the first three are amplitudes
    Eigen::Matrix<double, 2, Eigen::Dynamic> phase;  // dφ by the unknowns from the fourth on
    std::size_t part = 0;  // where its lower half by rows begins among all faces' numbers
  };
  // A face's part by its unknowns, `part_count_` numbers over all faces; and their sums, in the faces' order,
  // so that the number of threads does not matter.
  void place(const Face& face, const LocalMatrix& matrix, std::vector<double>& parts) const;
  void gather(const std::vector<double>& parts, SparseMatrix& sum) const;
  template <typename Value>
  double sum_over_faces(const Eigen::VectorXd& x, const Value& value) const;
  LocalVector scales() const;  // of local variables
  LocalVector local(const Face& face, const Eigen::VectorXd& x) const;
  void add_gradient(const Face& face, const LocalVector& first, Eigen::VectorXd& sum) const;

  shell::Topology topology_;
  std::vector<FaceForms> forms_;
  Model model_;
  std::vector<bool> wrinkle_free_, pinned_, live_;
  PhaseComplex complex_;  // of the live faces; of all where integrability is not relaxed
  std::vector<LocalWaves> own_waves_;
  std::vector<Eigen::Index> amplitude_unknown_;  // of a vertex, −1 where pinned
  Eigen::Index amplitude_count_ = 0, size_ = 0;
  double relaxed_energy_ = 0;
  double amplitude_scale_ = 1, frequency_scale_ = 1;
  Eigen::VectorXd upper_;
  std::vector<Face> faces_;
  std::size_t part_count_ = 0;
  SparseMatrix pattern_;
  std::vector<std::uint32_t> first_source_, source_;  // of each number of the pattern: the faces' numbers
};

}  // namespace plisse::wrinkle
