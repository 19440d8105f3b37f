// Pressure along the faces' normals: −p V, V the volume of the cones from an apex to the faces. For a closed
// part this is its volume for any apex; for an open one see OpenSide.
#include <Eigen/Geometry>
#include <vector>

#include "shell/energy_terms.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return m;
}

class PressureTerm : public ShellTerm {
 public:
  explicit PressureTerm(const TermInput& input)
      : topology_(input.shell.topology),
        pressure_(input.loads.pressure),
        open_sides_(open_sides(topology_, input.conditions)),
        some_vertex_(topology_.component_count, none) {
    for (std::uint32_t v = 0; v < topology_.vertex_count; ++v)
      if (topology_.component[v] != none) some_vertex_[topology_.component[v]] = v;
  }

  std::string_view name() const override { return "pressure"; }

  // Corners get a third of their faces' load each; the contribution of the cones' open sides along the
  // boundary is not a force of the sheet, so it is left out of `size`.
  void add(const Positions& x, EnergySum& energy, ForceSum* forces) const override {
    double volume = 0;
    for (std::size_t f = 0; f < topology_.faces.size(); ++f) {
      const Face& face = topology_.faces[f];
      const Vector3d from = apex(topology_.component[face[0]], x);
      const Corners corners = corners_of(face, x).colwise() - from;
      volume += corners.col(0).dot(corners.col(1).cross(corners.col(2))) / 6;
      if (!forces) continue;
      const Vector3d area = 0.5 * (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
      for (int k = 0; k < 3; ++k) {
        forces->force.col(face[static_cast<std::size_t>(k)]) -= pressure_ / 3 * area;
        forces->size.col(face[static_cast<std::size_t>(k)]) += (pressure_ / 3 * area).cwiseAbs();
        if (topology_.flaps[f][static_cast<std::size_t>(k)] != none) continue;
        const int a = (k + 1) % 3, b = (k + 2) % 3;  // the boundary edge runs from a to b
        const Vector3d side = pressure_ / 6 * corners.col(a).cross(corners.col(b));
        forces->force.col(face[static_cast<std::size_t>(a)]) += side;
        forces->force.col(face[static_cast<std::size_t>(b)]) += side;
      }
    }
    energy.count(-pressure_ * volume);
  }

  // V is trilinear: the block of corners k and k + 1 is −p/6 times the cross product's with corner k + 2. It
  // has negative curvature as well.
  void add_face_hessian(std::uint32_t face, const Positions& x, Curvature curvature,
                        Matrix9& hessian) const override {
    if (curvature == Curvature::positive) return;
    const Corners corners = corners_of(topology_.faces[face], x);
    const Vector3d from = apex(topology_.component[topology_.faces[face][0]], x);
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      const Matrix3d block = -pressure_ / 6 * cross_matrix(corners.col(last) - from);
      hessian.block<3, 3>(3 * k, 3 * next) -= block;
      hessian.block<3, 3>(3 * next, 3 * k) += block;
    }
  }

 private:
  // Any point if the part is closed, else the one that OpenSide defines.
  Vector3d apex(std::uint32_t part, const Positions& x) const {
    return open_sides_[part].open ? open_sides_[part].apex : Vector3d(x.col(some_vertex_[part]));
  }

  const Topology& topology_;
  double pressure_;                         // Pa
  std::vector<OpenSide> open_sides_;        // of each part
  std::vector<std::uint32_t> some_vertex_;  // of each part
};

}  // namespace

std::unique_ptr<EnergyTerm> pressure_term(const TermInput& input) {
  if (input.loads.pressure == 0) return nullptr;
  return std::make_unique<PressureTerm>(input);
}

}  // namespace plisse::shell
