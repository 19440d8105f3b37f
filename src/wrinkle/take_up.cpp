#include "wrinkle/take_up.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/weighted_median.h"

namespace plisse::wrinkle {

TakeUp take_up(const shell::Topology& topology, const std::vector<FaceForms>& forms,
               const shell::Material& material, const CoarseField& field) {
  TakeUp result;
  double area = 0, all = 0, taken = 0, squares = 0, compressed = 0;
  std::vector<std::pair<double, double>> frequencies, angles;  // |ω|, radians; their weights
  for (std::size_t f = 0; f < forms.size(); ++f) {
    const PrincipalStrain strain = principal_strain(forms[f]);
    const double across =
                     std::max(-(strain.compression + material.poisson * std::max(strain.tension, 0.0)), 0.0),
                 along = std::max(-strain.tension, 0.0), face = forms[f].rest.area;
    const auto& t = topology.faces[f];
    const Eigen::Vector3d a(field.amplitude[t[0]], field.amplitude[t[1]], field.amplitude[t[2]]),
        phase(field.phase[f][0], field.phase[f][1], field.phase[f][2]);
    const Eigen::Vector2d gradient = forms[f].rest.gradients * phase;
    const double frequency = gradient.norm();
    const double square = (a.squaredNorm() + a.sum() * a.sum()) / 12;  // mean of a² over the face
    const double waves = square * frequency * frequency;
    area += face;
    all += face * (across + along);
    taken += face * std::min(waves / 2, across);
    if (!(waves > 0)) continue;
    frequencies.emplace_back(frequency, face * waves);
    angles.emplace_back(std::acos(std::min(std::abs(gradient.dot(strain.wave)) / frequency, 1.0)), face);
    squares += face * square;
    if (strain.compression < 0) compressed += face * square;
  }
  result.compression = area > 0 ? all / area : 0;
  result.untaken = all > 0 ? 1 - taken / all : 0;
  if (frequencies.empty()) return result;
  result.wavelength = 2 * std::numbers::pi / weighted_median(std::move(frequencies));
  result.crest_angle = weighted_median(std::move(angles));
  result.where_compressed = compressed / squares;
  return result;
}

}  // namespace plisse::wrinkle
