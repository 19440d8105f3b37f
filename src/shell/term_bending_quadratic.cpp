// Bending of a shell that is flat at rest as a quadratic form of the positions, which its stretching leaves
// nearly isometric (bending_quadratic.h).
#include "shell/bending_quadratic.h"
#include "shell/energy_terms.h"

namespace plisse::shell {
namespace {

class QuadraticBendingTerm : public ShellTerm {
 public:
  QuadraticBendingTerm(const Shell& shell, const Eigen::Vector3d& origin)
      : form_(bending_quadratic(shell.material, shell.topology, shell.rest)),
        sizes_(form_.cwiseAbs()),
        origin_(origin) {}

  std::string_view name() const override { return "bending"; }
  void add(const Positions& x, EnergySum& energy, ForceSum* forces) const override {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd u = x.row(axis).transpose().array() - origin_[axis], force = form_ * u;
      energy.energy += 0.5 * u.dot(force);
      // Almost all of its summands cancel, but their rounding errors do not.
      energy.summands += 0.5 * u.cwiseAbs().dot(sizes_ * u.cwiseAbs());
      if (!forces) continue;
      forces->force.row(axis) += force.transpose();
      forces->size.row(axis) += force.cwiseAbs().transpose();
    }
  }
  const Eigen::SparseMatrix<double>* constant_hessian() const override { return &form_; }

 private:
  Eigen::SparseMatrix<double> form_, sizes_;  // V×V, N/m, and its absolute values
  Eigen::Vector3d origin_;
};

}  // namespace

std::unique_ptr<EnergyTerm> quadratic_bending_term(const TermInput& input) {
  if (input.shell.bending != Bending::quadratic) return nullptr;
  return std::make_unique<QuadraticBendingTerm>(input.shell, input.origin);
}

}  // namespace plisse::shell
