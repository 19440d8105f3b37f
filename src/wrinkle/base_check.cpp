#include "wrinkle/base_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace plisse::wrinkle {
namespace {

// Waves' directions on two faces across a side, as components along and across it.
Eigen::Vector2d by_side(const shell::Topology& topology, const FaceForms& forms, std::size_t face,
                        std::size_t side, const Eigen::Vector2d& direction) {
  const Eigen::Matrix2d& rest = forms.rest.edges;
  const std::array<Eigen::Vector2d, 3> corner{Eigen::Vector2d(0, 0), rest.col(0), rest.col(1)};
  const Eigen::Vector2d e =
      (corner[(side + 1) % 3] - corner[side]).normalized() * side_sign(topology, face, side);
  return {e.dot(direction), e.x() * direction.y() - e.y() * direction.x()};
}

}  // namespace

std::vector<BaseFault> base_faults(const shell::Topology& topology, const std::vector<FaceForms>& forms) {
  // Cloth stretches by less than this, and what is shrunk more is crushed: in length, not in strain.
  constexpr double other_unit = 5;
  // cos of the angle between crests that counts as a kink: 45 degrees. A smooth field turns by a few.
  constexpr double kink = 0.7;
  // Compression along crests that is worth a word, twice the Green strain, and of how much of the area.
  constexpr double along = 0.01, worth = 0.01;
  // Crests of faces that are hardly compressed, beside the strongest in the mean, have no direction.
  constexpr double hardly = 0.1;

  std::vector<PrincipalStrain> principal;
  double area = 0, strength = 0, compressed = 0;
  std::vector<double> scales;
  for (const FaceForms& face : forms) {
    principal.push_back(principal_strain(face));
    const PrincipalStrain& p = principal.back();
    area += face.rest.area;
    scales.push_back(std::sqrt(std::sqrt(std::max((1 + p.tension) * (1 + p.compression), 0.0))));
    if (p.compression + face.noise < 0) {
      strength -= face.rest.area * p.compression;
      compressed += face.rest.area;
    }
  }
  std::vector<BaseFault> faults;
  if (!(area > 0)) return faults;
  double other = 0, crest = 0;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    if (scales[f] > other_unit || scales[f] < 1 / other_unit) other += forms[f].rest.area;
    if (principal[f].tension < -along) crest += forms[f].rest.area;
  }
  std::nth_element(scales.begin(), scales.begin() + static_cast<std::ptrdiff_t>(scales.size() / 2),
                   scales.end());
  const double median = scales[scales.size() / 2];
  if (other > area / 2) {
    faults.push_back(
        {"unit",
         fmt::format(
             "positions and rest shape are in different units: lengths are {:.3g} times those at rest, "
             "on {:.0f} % of the area more than {:g} times or less than a {:g}th",
             median, 100 * other / area, other_unit, other_unit)});
    return faults;  // what the strains say otherwise means nothing
  }
  std::vector<bool> kinked(forms.size(), false);
  const double least = compressed > 0 ? hardly * strength / compressed : 0;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    if (!(principal[f].compression < -std::max(least, forms[f].noise))) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t n = across(topology, f, side);
      if (n == shell::none || !(principal[n].compression < -std::max(least, forms[n].noise))) continue;
      std::size_t back = 0;
      while (side_edge(topology, n, back) != side_edge(topology, f, side)) ++back;
      const double turn = by_side(topology, forms[f], f, side, principal[f].wave)
                              .dot(by_side(topology, forms[n], n, back, principal[n].wave));
      kinked[f] = kinked[f] || std::abs(turn) < kink;
    }
  }
  double kinks = 0;
  for (std::size_t f = 0; f < forms.size(); ++f)
    if (kinked[f]) kinks += forms[f].rest.area;
  if (kinks > worth * area)
    faults.push_back(
        {"kinks",
         fmt::format(
             "the tension field kinks: crests of neighbouring faces meet at more than 45 degrees on "
             "{:.1f} % of the area, where waves cannot follow them; a larger --follow helps, and where the "
             "surface is draped, solving to the end or drape --residual 1e-3",
             100 * kinks / area)});
  if (crest > worth * area)
    faults.push_back(
        {"crest compression",
         fmt::format("{:.1f} % of the area is compressed along the crests as well, by more than {:g} %: no "
                     "wave takes that up",
                     100 * crest / area, 50 * along)});
  return faults;
}

}  // namespace plisse::wrinkle
