// The potential energy of a shell under its loads, its gradient and its sparse Hessian: the sum of the terms
// that energy_terms.h lists, none of which it knows by name.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "shell/block_matrix.h"
#include "shell/energy_term.h"

namespace plisse::shell {

class Potential {
 public:
  using Terms = std::vector<std::unique_ptr<EnergyTerm>>;

  // Of all terms that the shell and its loads have. Keeps references. Which coordinates are held is fixed
  // from here on, where to is not. `origin`: where gravity and dead forces have no energy and bending is
  // measured from; near the shell rounding is least. Forces do not depend on it, and offset() is what
  // energies lack beside those from the world's origin.
  Potential(const Shell& shell, const Conditions& conditions, const Loads& loads,
            const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());
  // Of these terms.
  Potential(const Shell& shell, const Conditions& conditions, Terms terms);
  static Terms all_terms(const Shell& shell, const Conditions& conditions, const Loads& loads,
                         const Eigen::Vector3d& origin);

  double offset() const;
  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(matrix_.scalars().size()); }

  struct Value {
    double energy = 0;       // J; infinite where a vertex is inside an obstacle
    double friction = 0;     // J, a part of it: the work against what grips, since the anchors
    double summands = 0;     // J: sum of their absolute values; what rounding is relative to
    double force_scale = 0;  // N: largest sum of absolute forces of elements and loads on a vertex
  };
  // `gradient`: one entry an unknown, N.
  Value value(const Positions& x, Eigen::VectorXd* gradient = nullptr) const;

  struct Part {
    std::string name;   // of a term
    double energy = 0;  // J
  };
  std::vector<Part> parts(const Positions& x) const;  // of the energy, each term's

  // The lower half, with the same pattern every time. `positive`: without the parts that may have negative
  // curvature: compression, normals' own curvature, pressure, obstacles' concave directions.
  const Eigen::SparseMatrix<double>& hessian(const Positions& x, Curvature curvature);

  // Terms that lag look up what they go by from here on (friction: what obstacles push at): the energy
  // changes by it. The anchor of a new contact is the vertex' position; with `first` that of Loads::anchors.
  bool lags() const;
  void look_up(const Positions& x, bool first);
  // Where vertices stick from here on, to each obstacle (Loads::anchors): what has slipped drags its anchor
  // along.
  std::vector<Positions> anchors(const Positions& x) const;

  // Adds `step` times the unknowns' direction to the positions.
  void advance(Positions& x, const Eigen::VectorXd& direction, double step) const;
  // Rest area of the vertex of each unknown, m².
  const Eigen::VectorXd& areas() const { return unknown_areas_; }
  // The longest step ≤ 1 along a direction on which every term allows every vertex to go its way.
  double safe_step(const Positions& x, const Eigen::VectorXd& direction) const;

 private:
  // Terms one after the other in the list whose elements are alike are summed element by element.
  struct Run {
    std::vector<const VertexTerm*> vertices;
    std::vector<const FaceTerm*> faces;
    std::vector<const FlapTerm*> flaps;
    const ShellTerm* shell = nullptr;
    // Whether it could; takes none where this would part it from its elements.
    bool take(const EnergyTerm& term);
  };
  void sum_run(const Run& run, const Positions& x, EnergySum& energy, ForceSum* forces) const;
  // Adds a face's matrix, of its corners and (6) the vertices across its edges.
  template <int Vertices>
  void scatter(std::size_t face, const Eigen::Matrix<double, 3 * Vertices, 3 * Vertices>& element,
               const std::vector<std::uint32_t>& blocks);

  const Topology& topology_;
  Terms terms_;
  std::vector<Run> runs_;
  // Of all runs: those whose Hessians are not 0.
  std::vector<const VertexTerm*> curved_vertices_;
  std::vector<const FaceTerm*> curved_faces_;
  std::vector<const FlapTerm*> curved_flaps_;
  std::vector<const ShellTerm*> curved_shells_;
  BlockMatrix matrix_;
  Eigen::VectorXd unknown_areas_;
  std::vector<std::uint32_t> face_blocks_, flap_blocks_;  // 6 or 21 a face: pairs (k ≥ l) of its vertices
  Eigen::VectorXd constant_;                              // the matrix' values that never change
};

}  // namespace plisse::shell
