// Bending by mid-edge normals (Chen et al. 2021, eq. 3 and appendix A), a face and its flaps each. Edges in a
// mirror (Conditions::Mirror) have their own face's image across them.
#include <array>
#include <cstdint>
#include <vector>

#include "shell/energy_terms.h"

namespace plisse::shell {
namespace {

class MidedgeBendingTerm : public FlapTerm {
 public:
  MidedgeBendingTerm(const Shell& shell, const Conditions& conditions)
      : shell_(shell), mirrors_(conditions.mirrors), mirrored_(shell.topology.faces.size(), {-1, -1, -1}) {
    for (std::size_t f = 0; f < mirrored_.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        if (shell.topology.flaps[f][i] != none) continue;
        const std::uint32_t a = shell.topology.faces[f][(i + 1) % 3],
                            b = shell.topology.faces[f][(i + 2) % 3];
        for (std::size_t m = 0; m < mirrors_.size(); ++m) {
          const auto [axis, at] = mirrors_[m];
          const auto in_it = [&](std::uint32_t v) {
            return conditions.held(axis, v) && conditions.at(axis, v) == at;
          };
          if (in_it(a) && in_it(b)) mirrored_[f][i] = static_cast<std::int8_t>(m);
        }
      }
  }

  std::string_view name() const override { return "bending"; }
  double element(std::uint32_t face, const Positions& x, Vector18* gradient, Matrix18* hessian,
                 Curvature curvature) const override {
    const Flap flap = flap_of(face, x);
    const Eigen::Matrix2d rest_form =
        shell_.rest_forms.empty() ? Eigen::Matrix2d::Zero().eval() : shell_.rest_forms[face];
    const double energy = bending_midedge(shell_.material, shell_.rest[face], rest_form,
                                          corners_of(shell_.topology.faces[face], x), flap.across, flap.has,
                                          gradient, hessian, curvature);
    for (std::size_t i = 0; i < 3; ++i) {
      if (mirrored_[face][i] < 0) continue;
      // By the corner's own place: the mirror image goes the other way across the mirror.
      const auto turned =
          static_cast<Eigen::Index>(9 + 3 * i) + mirrors_[static_cast<std::size_t>(mirrored_[face][i])].axis;
      if (gradient) (*gradient)[turned] *= -1;
      if (hessian) {
        hessian->row(turned) *= -1;
        hessian->col(turned) *= -1;
      }
    }
    return energy;
  }

 private:
  struct Flap {
    Corners across = Corners::Zero();
    std::array<bool, 3> has{};
  };

  Flap flap_of(std::uint32_t face, const Positions& x) const {
    const Topology& topology = shell_.topology;
    Flap flap;
    for (std::size_t i = 0; i < 3; ++i) {
      auto across = flap.across.col(static_cast<int>(i));
      flap.has[i] = topology.flaps[face][i] != none;
      if (flap.has[i]) {
        across = x.col(topology.flaps[face][i]);
      } else if (mirrored_[face][i] >= 0) {
        const auto [axis, at] = mirrors_[static_cast<std::size_t>(mirrored_[face][i])];
        flap.has[i] = true;
        across = x.col(topology.faces[face][i]);
        across[axis] = 2 * at - across[axis];
      }
    }
    return flap;
  }

  const Shell& shell_;
  std::vector<Conditions::Mirror> mirrors_;
  std::vector<std::array<std::int8_t, 3>> mirrored_;  // of each face's edges: which mirror, −1: none
};

}  // namespace

std::unique_ptr<EnergyTerm> midedge_bending_term(const TermInput& input) {
  if (input.shell.bending != Bending::midedge) return nullptr;
  return std::make_unique<MidedgeBendingTerm>(input.shell, input.conditions);
}

}  // namespace plisse::shell
