// One term of a shell's potential energy: its interface for the sum of all terms (potential.h). A term is a
// class in its own file, term_NAME.cpp, and a line in the list of terms (energy_terms.h); no other file
// depends on it.
//
// Energies are in J, gradients (the forces that would keep the shell in place) in N, Hessians in N/m. A load
// that rotates with the shell is a term if it has an energy, as pressure has.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "shell/bending_midedge.h"
#include "shell/statics.h"

namespace plisse::shell {

class EnergyTerm {
 public:
  EnergyTerm() = default;
  EnergyTerm(const EnergyTerm&) = delete;
  EnergyTerm& operator=(const EnergyTerm&) = delete;
  virtual ~EnergyTerm() = default;

  virtual std::string_view name() const = 0;  // as messages call it

  // Its Hessian is 0 everywhere, and is not evaluated.
  virtual bool linear() const { return false; }
  // The difference of its energy to that measured from the world's origin, J (TermInput::origin).
  virtual double offset() const { return 0; }

  // For terms that use lagged quantities, as friction uses earlier forces of contact: look_up()
  // is called before the first step (`first`) and every few steps, and may change the energy.
  virtual bool lags() const { return false; }
  virtual void look_up(const Positions&, bool /*first*/) {}
  // J: the part of its energy that is work against friction since the anchors.
  virtual double friction(const Positions&) const { return 0; }
  virtual std::vector<Positions> anchors(const Positions&) const { return {}; }  // as Loads::anchors

  // The share, at most 1, of a straight path that a vertex may follow: for energies that are infinite
  // somewhere.
  virtual double safe_share(const Eigen::Vector3d& /*from*/, const Eigen::Vector3d& /*to*/) const {
    return 1;
  }
};

// A sum over elements, each a function of the positions of a few vertices.
template <int Vertices>
class ElementTerm : public EnergyTerm {
 public:
  using Gradient = Eigen::Matrix<double, 3 * Vertices, 1>;
  using Hessian = Eigen::Matrix<double, 3 * Vertices, 3 * Vertices>;
  // The energy of one element; its derivatives by x₀ y₀ z₀ x₁ … are written where asked for. Of
  // Curvature::positive only the Hessian is different: faces and flaps leave out parts that may have negative
  // eigenvalues; for vertices the sum takes the positive semidefinite part of all terms together.
  virtual double element(std::uint32_t index, const Positions& x, Gradient* gradient, Hessian* hessian,
                         Curvature curvature) const = 0;
};
using VertexTerm = ElementTerm<1>;  // an element each vertex that has faces
using FaceTerm = ElementTerm<3>;    // each face: its corners
// Each face: its corners, then the vertices across its edges. Rows of a missing vertex are 0; those of a
// vertex beyond a mirror are by the corner that it mirrors.
using FlapTerm = ElementTerm<6>;

// Sums with the data for their rounding errors and for the scale of forces.
struct EnergySum {
  double energy = 0;    // J
  double summands = 0;  // J: their absolute values; what rounding is relative to
  void count(double part) {
    energy += part;
    summands += std::abs(part);
  }
};
struct ForceSum {
  Positions force, size;  // 3×V, N: the gradient, and its summands' absolute values
  void push(std::uint32_t vertex, const Eigen::Vector3d& gradient) {
    force.col(vertex) += gradient;
    size.col(vertex) += gradient.cwiseAbs();
  }
};

// One function of all vertices.
class ShellTerm : public EnergyTerm {
 public:
  // Adds its energy; its gradient where `forces` is given.
  virtual void add(const Positions& x, EnergySum& energy, ForceSum* forces) const = 0;
  // Its Hessian is the sum of two parts. One is the same for all positions and for x, y and z: V×V,
  // symmetric, positive semidefinite; nothing: there is none.
  virtual const Eigen::SparseMatrix<double>* constant_hessian() const { return nullptr; }
  // The other is a sum over faces: adds that of one, by its corners.
  virtual void add_face_hessian(std::uint32_t /*face*/, const Positions& /*x*/, Curvature,
                                Matrix9& /*hessian*/) const {}
};

// What terms are made from; they keep the references.
struct TermInput {
  const Shell& shell;
  const Conditions& conditions;
  const Loads& loads;
  Eigen::Vector3d origin;               // where dead forces have no energy, and near the shell
  const Eigen::VectorXd& vertex_areas;  // m², at rest; good while terms are made, not after
};

}  // namespace plisse::shell
