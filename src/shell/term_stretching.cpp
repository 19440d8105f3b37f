// Stretching: St. Venant–Kirchhoff (Chen et al. 2021, eq. 2) or its relaxation by tension field theory
// (appendix B), a face each.
#include "shell/energy_terms.h"

namespace plisse::shell {
namespace {

class StretchingTerm : public FaceTerm {
 public:
  explicit StretchingTerm(const Shell& shell)
      : shell_(shell), law_{shell.material, shell.stretching, shell.residual, shell.tension_limit} {}

  std::string_view name() const override { return "stretching"; }
  double element(std::uint32_t face, const Positions& x, Vector9* gradient, Matrix9* hessian,
                 Curvature curvature) const override {
    return stretching(law_, shell_.rest[face], corners_of(shell_.topology.faces[face], x), gradient, hessian,
                      curvature);
  }

 private:
  const Shell& shell_;
  StretchingLaw law_;
};

}  // namespace

std::unique_ptr<EnergyTerm> stretching_term(const TermInput& input) {
  return std::make_unique<StretchingTerm>(input.shell);
}

}  // namespace plisse::shell
