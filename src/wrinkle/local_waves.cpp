#include "wrinkle/local_waves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "wrinkle/patches.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Vector2d;

// A crest from a face's centre: its length (metres at rest) until it leaves the live faces, and whether
// amplitudes are 0 there.
struct CrestEnd {
  double length = 0;
  bool pinned = false;
};

class CrestLines {
 public:
  CrestLines(const std::vector<FaceForms>& forms, const shell::Topology& topology,
             const std::vector<bool>& live, const std::vector<bool>& pinned)
      : forms_(forms), topology_(topology), live_(live), pinned_(pinned) {
    for (const FaceForms& f : forms) crest_.push_back(principal_strain(f).crest);
  }

  CrestEnd follow(std::size_t face, double sign) const {
    Eigen::Vector3d at = Eigen::Vector3d::Constant(1.0 / 3);  // barycentric
    Vector2d direction = sign * crest_[face];
    CrestEnd end;
    // A limit for closed lines.
    const int most = 20 + 4 * static_cast<int>(std::sqrt(static_cast<double>(forms_.size())));
    for (int step = 0; step < most; ++step) {
      const Eigen::Vector3d rate = forms_[face].rest.gradients.transpose() * direction;
      double time = std::numeric_limits<double>::infinity();
      int out = 0;
      for (int i = 0; i < 3; ++i) {
        if (rate[i] < 0 && at[i] / -rate[i] < time) {
          time = at[i] / -rate[i];
          out = i;
        }
      }
      end.length += time;
      at = (at + time * rate).cwiseMax(0);
      const auto side = static_cast<std::size_t>(out + 1) % 3;
      const std::uint32_t next = across(topology_, face, side);
      const std::uint32_t a = topology_.faces[face][side], b = topology_.faces[face][(side + 1) % 3];
      if (next == shell::none || !live_[next]) {
        end.pinned = pinned_[a] && pinned_[b];
        break;
      }
      Eigen::Vector3d entry = Eigen::Vector3d::Zero();
      int inward = 0;
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = topology_.faces[next][static_cast<std::size_t>(i)];
        if (v == a)
          entry[i] = at[static_cast<int>(side)];
        else if (v == b)
          entry[i] = at[static_cast<int>((side + 1) % 3)];
        else
          inward = i;
      }
      at = entry;
      face = next;
      direction = crest_[face];
      if (forms_[face].rest.gradients.col(inward).dot(direction) < 0) direction = -direction;
    }
    return end;
  }

  // π/L of amplitudes that vanish at both ends of the crest through a face; π/2L at one, 0 at none.
  double rate(std::size_t face) const {
    const CrestEnd one = follow(face, 1), other = follow(face, -1);
    const double ends = (one.pinned ? 0.5 : 0.0) + (other.pinned ? 0.5 : 0.0);
    return ends * std::numbers::pi / (one.length + other.length);
  }

 private:
  const std::vector<FaceForms>& forms_;
  const shell::Topology& topology_;
  const std::vector<bool>&live_, &pinned_;
  std::vector<Vector2d> crest_;
};

}  // namespace

double LocalWaves::critical(const Model& model, double frequency) const {
  const double nu = model.material.poisson, h = model.material.thickness, square = frequency * frequency;
  return 2 * (1 - nu * nu) * stiffness / square + h * h * square / 6;
}

double best_amplitude(const FaceForms& forms, const Model& model, const LocalWaves& local,
                      const Vector2d& gradient) {
  const double frequency = gradient.norm();
  if (!(frequency > 0)) return 0;
  const Vector2d along = gradient / frequency, across(-along.y(), along.x());
  const Eigen::Matrix2d strain = wrinkled_strain(forms, model);
  const double compression =
      -(along.dot(strain * along) + model.material.poisson * across.dot(strain * across));
  return std::sqrt(2 * std::max(compression - local.critical(model, frequency), 0.0)) / frequency;
}

LocalWaves local_waves(const FaceForms& forms, const Model& model, double rate, double least) {
  const PrincipalStrain principal = principal_strain(forms);
  const double nu = model.material.poisson, h = model.material.thickness,
               tension = std::max(principal.tension, 0.0);
  LocalWaves result;
  result.compression = -(principal.compression + nu * tension);
  const double curvature = principal.crest.dot(forms.second_form * principal.crest);
  result.stiffness = model.curvature_factor * curvature * curvature + tension / 2 * rate * rate;
  result.gradient =
      std::max(std::sqrt(std::sqrt(12 * (1 - nu * nu) * result.stiffness) / h), least) * principal.wave;
  return result;
}

std::vector<LocalWaves> local_waves(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                                    const std::vector<bool>& live, const std::vector<bool>& pinned,
                                    const Model& model) {
  const CrestLines crests(forms, topology, live, pinned);
  std::vector<LocalWaves> result(forms.size());
  for (const auto& patch : patches(topology, live)) {
    double area = 0;
    for (const std::uint32_t f : patch) area += forms[f].rest.area;
    for (const std::uint32_t f : patch)
      result[f] = local_waves(forms[f], model, crests.rate(f), 2 * std::numbers::pi / std::sqrt(area));
  }
  return result;
}

}  // namespace plisse::wrinkle
