// Contact with obstacles and friction on them: M. Li et al., "Incremental Potential Contact", ACM TOG 2020,
// eq. 6 and section 5 (barrier.h, friction.h), a vertex each, weighted with its rest area. Friction uses
// earlier forces of contact, so both are one term.
#include <algorithm>
#include <limits>
#include <utility>

#include "shell/energy_terms.h"
#include "shell/friction.h"

namespace plisse::shell {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The pressure that a barrier must carry: that of the loads and of the sheet's own weight.
double contact_stiffness(const Shell& shell, const Loads& loads) {
  if (loads.contact_stiffness > 0) return loads.contact_stiffness;
  double area = 0, force = 0;
  for (const RestFace& face : shell.rest) area += face.area;
  for (Eigen::Index v = 0; v < loads.forces.cols(); ++v) force += loads.forces.col(v).norm();
  const Material& m = shell.material;
  const double pressure = std::abs(loads.pressure) + m.density * m.thickness * loads.gravity.norm() +
                          force / area + m.young * m.thickness * 1e-6 / std::sqrt(area);
  // |b'| is about 1.2 gap at half of the gap: there it carries about ten times the average load.
  return 10 * pressure / (1.2 * loads.gap);
}

class ContactTerm : public VertexTerm {
 public:
  explicit ContactTerm(const TermInput& input)
      : component_(input.shell.topology.component),
        loads_(input.loads),
        stiffness_(contact_stiffness(input.shell, input.loads) * input.vertex_areas),
        first_grip_(component_.size() + 1, 0) {}

  std::string_view name() const override { return "contact"; }

  double element(std::uint32_t vertex, const Positions& x, Vector3d* gradient, Matrix3d* hessian,
                 Curvature) const override {
    Contact sum;
    const double stiffness = stiffness_[vertex];
    for (const Obstacle& obstacle : loads_.obstacles) {
      const Contact one = contact(obstacle, x.col(vertex), loads_.gap, hessian != nullptr);
      sum.value += stiffness * one.value;
      sum.first += stiffness * one.first;
      sum.second += stiffness * one.second;
    }
    for (std::size_t g = first_grip_[vertex]; g < first_grip_[vertex + 1]; ++g) {
      const Contact rub = shell::friction(grips_[g], x.col(vertex), loads_.friction, loads_.slip_length());
      sum.value += rub.value;
      sum.first += rub.first;
      sum.second += rub.second;
    }
    if (gradient) *gradient = sum.first;
    if (hessian) *hessian = sum.second;
    return sum.value;
  }

  bool lags() const override { return loads_.friction > 0; }

  // The anchor of a new contact is the vertex' position; with `first` that of Loads::anchors.
  void look_up(const Positions& x, bool first) override {
    std::vector<Grip> grips;
    auto old = grips_.begin();
    for (std::uint32_t v = 0; v < component_.size(); ++v) {
      first_grip_[v] = grips.size();
      if (component_[v] == none) continue;
      for (std::uint32_t o = 0; o < loads_.obstacles.size(); ++o) {
        while (old != grips_.end() && std::pair(old->vertex, old->obstacle) < std::pair(v, o)) ++old;
        const Vector3d push =
            -stiffness_[v] * contact(loads_.obstacles[o], x.col(v), loads_.gap, false).first;
        const double force = push.norm();
        if (!(force > 0)) continue;
        Grip grip{v, o, x.col(v), push / force, force};
        if (old != grips_.end() && old->vertex == v && old->obstacle == o) {
          grip.anchor = old->anchor;
        } else if (first && !loads_.anchors.empty() && loads_.anchors[o].col(v).allFinite()) {
          grip.anchor = loads_.anchors[o].col(v);
        }
        grips.push_back(grip);
      }
    }
    first_grip_.back() = grips.size();
    grips_ = std::move(grips);
  }

  double friction(const Positions& x) const override {
    double work = 0;
    for (const Grip& grip : grips_)
      work += shell::friction(grip, x.col(grip.vertex), loads_.friction, loads_.slip_length()).value;
    return work;
  }

  // The anchor follows a vertex that has slipped; vertices without contact have no anchor.
  std::vector<Positions> anchors(const Positions& x) const override {
    std::vector<Positions> anchors(
        loads_.obstacles.size(), Positions::Constant(3, x.cols(), std::numeric_limits<double>::quiet_NaN()));
    const double slip = loads_.slip_length();
    for (const Grip& grip : grips_) {
      const Vector3d from = x.col(grip.vertex) - grip.anchor;
      const Vector3d way = from - grip.normal.dot(from) * grip.normal;
      const double length = way.norm();
      anchors[grip.obstacle].col(grip.vertex) =
          x.col(grip.vertex) - (length > slip ? Vector3d(slip / length * way) : way);
    }
    return anchors;
  }

  double safe_share(const Vector3d& from, const Vector3d& to) const override {
    double share = 1;
    for (const Obstacle& obstacle : loads_.obstacles) share = std::min(share, free_way(obstacle, from, to));
    return share;
  }

 private:
  const std::vector<std::uint32_t>& component_;  // of each vertex
  const Loads& loads_;
  Eigen::VectorXd stiffness_;            // of each vertex, N/m
  std::vector<Grip> grips_;              // sorted by vertex, then obstacle
  std::vector<std::size_t> first_grip_;  // of each vertex
};

}  // namespace

std::unique_ptr<EnergyTerm> contact_term(const TermInput& input) {
  if (input.loads.obstacles.empty()) return nullptr;
  return std::make_unique<ContactTerm>(input);
}

}  // namespace plisse::shell
