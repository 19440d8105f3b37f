// Forces that do not depend on the shell's shape: gravity on density × thickness × rest area (lumped:
// a third of each face's to each corner) and nodal forces. −F·(x − origin), a vertex each.
#include "shell/energy_terms.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

class DeadLoadsTerm : public VertexTerm {
 public:
  explicit DeadLoadsTerm(const TermInput& input)
      : origin_(input.origin), forces_(3, input.vertex_areas.size()) {
    const Material& material = input.shell.material;
    for (Eigen::Index v = 0; v < forces_.cols(); ++v) {
      forces_.col(v) = material.density * material.thickness * input.vertex_areas[v] * input.loads.gravity;
      if (input.loads.forces.size() > 0) forces_.col(v) += input.loads.forces.col(v);
      if (input.shell.topology.component[static_cast<std::size_t>(v)] != none)
        offset_ -= forces_.col(v).dot(origin_);
    }
  }

  std::string_view name() const override { return "dead loads"; }
  bool linear() const override { return true; }
  double offset() const override { return offset_; }
  double element(std::uint32_t vertex, const Positions& x, Vector3d* gradient, Matrix3d* hessian,
                 Curvature) const override {
    if (gradient) *gradient = -forces_.col(vertex);
    if (hessian) hessian->setZero();
    return -forces_.col(vertex).dot(x.col(vertex) - origin_);
  }

 private:
  Vector3d origin_;
  Positions forces_;  // N
  double offset_ = 0;
};

}  // namespace

std::unique_ptr<EnergyTerm> dead_loads_term(const TermInput& input) {
  return std::make_unique<DeadLoadsTerm>(input);
}

}  // namespace plisse::shell
