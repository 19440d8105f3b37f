#include "wrinkle/facets.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "shell/stretching.h"
#include "wrinkle/patches.h"

namespace plisse::wrinkle {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

std::array<Vector2d, 3> rest_edges(const FaceForms& forms) {
  const Matrix2d& e = forms.rest.edges;
  return {e.col(0), e.col(1) - e.col(0), e.col(1)};
}

// C of the face.
Matrix2d lost_to_chords(const FaceForms& forms) {
  Eigen::Matrix3d squares;
  Eigen::Vector3d lost;
  const auto edges = rest_edges(forms);
  for (int k = 0; k < 3; ++k) {
    const Vector2d& e = edges[static_cast<std::size_t>(k)];
    const double bent = e.dot(forms.second_form * e);
    squares.row(k) << e.x() * e.x(), 2 * e.x() * e.y(), e.y() * e.y();
    lost[k] = bent * bent / 12;
  }
  const Eigen::Vector3d c = squares.partialPivLu().solve(lost);
  Matrix2d result;
  result << c[0], c[1], c[1], c[2];
  return result;
}

// κl of the longest edge, κ along the waves.
double bend(const FaceForms& forms, const PrincipalStrain& principal) {
  double longest = 0;
  for (const Vector2d& e : rest_edges(forms)) longest = std::max(longest, e.norm());
  return std::abs(principal.wave.dot(forms.second_form * principal.wave)) * longest;
}

// The mean of a number of each face over the faces around it, by area: so many times over each vertex.
std::vector<double> around(const shell::Topology& topology, const std::vector<FaceForms>& forms,
                           std::vector<double> of_faces) {
  constexpr int rings = 6;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<double> sum(topology.vertex_count, 0), area(topology.vertex_count, 0);
    for (std::size_t f = 0; f < forms.size(); ++f) {
      for (const std::uint32_t v : topology.faces[f]) {
        sum[v] += forms[f].rest.area * of_faces[f];
        area[v] += forms[f].rest.area;
      }
    }
    for (std::size_t f = 0; f < forms.size(); ++f) {
      of_faces[f] = 0;
      for (const std::uint32_t v : topology.faces[f]) of_faces[f] += sum[v] / area[v] / 3;
    }
  }
  return of_faces;
}

// Radians. What bends by more than this from one end of an edge to the other is a crease, not a chord of a
// smooth surface.
constexpr double crease = 1;

}  // namespace

void limit_tension(std::vector<FaceForms>& forms, const shell::Material& material, double limit) {
  if (!(limit > 0)) return;
  shell::StretchingLaw law;
  law.material = material;
  law.tension_limit = limit;
  for (FaceForms& face : forms) {
    const shell::Principal strain = shell::principal(face.strain);
    const Vector2d elastic = shell::elastic_strain(law, strain.value[0], strain.value[1]);
    for (int i = 0; i < 2; ++i)  // what is within the limit keeps its bytes
      if (elastic[i] != strain.value[i])
        face.strain +=
            (elastic[i] - strain.value[i]) * strain.direction.col(i) * strain.direction.col(i).transpose();
  }
}

void correct_chords(std::vector<FaceForms>& forms) {
  for (FaceForms& face : forms) {
    const PrincipalStrain principal = principal_strain(face);
    if (!(principal.compression < 0) || !(bend(face, principal) < crease)) continue;
    const double lost = principal.wave.dot(lost_to_chords(face) * principal.wave);
    if (lost > 0)
      face.strain += std::min(lost, -principal.compression) * principal.wave * principal.wave.transpose();
  }
}

void find_noise(std::vector<FaceForms>& forms, const BaseSurface& surface, const shell::Material& material,
                bool chords) {
  // What is left in the mean of a neighbourhood, over what chords lack there: below `weak` a face is calm,
  // and so is a patch that is nowhere above `strong`. Slack cloth resists nothing, and vertices of a base
  // surface have moved along it until some edges have their full length and others lack more: of an untwisted
  // tube of 2,539 vertices up to 1.9 times as much is left in the mean, 3.8 times on a face.
  constexpr double weak = 0.5, strong = 2;
  // A base surface is solved to 1e-8 of its forces (shell::NewtonSettings), strains about as well.
  constexpr double solved_to = 1e-7;
  constexpr double roundings = 64;  // of a position, that a strain may be off by
  const Eigen::Matrix3Xd& x = surface.positions;
  const bool single = x.size() > 0 && (x.cast<float>().cast<double>().array() == x.array()).all();
  const double epsilon = single ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                : std::numeric_limits<double>::epsilon(),
               reach = x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0;
  double largest = 0;
  std::vector<PrincipalStrain> principal;
  for (const FaceForms& face : forms) {
    principal.push_back(principal_strain(face));
    largest = std::max({largest, principal.back().tension, -principal.back().compression});
  }
  std::vector<double> left(forms.size(), 0), lost(forms.size(), 0);  // compression, and what chords lack
  for (std::size_t f = 0; chords && f < forms.size(); ++f) {
    const double bent = bend(forms[f], principal[f]);
    left[f] = std::max(-principal[f].compression, 0.0);
    lost[f] = bent < crease ? bent * bent / 12 : 0;
  }
  const std::vector<double> left_around = around(surface.topology, forms, left),
                            lost_around = around(surface.topology, forms, lost);
  std::vector<bool> compressed(forms.size(), false);
  const auto taken_up = [&](std::size_t f) {  // s₀
    return -(principal[f].compression + material.poisson * std::max(principal[f].tension, 0.0));
  };
  for (std::size_t f = 0; f < forms.size(); ++f) {
    const double height = 1 / forms[f].rest.gradients.colwise().norm().maxCoeff();
    forms[f].noise = roundings * epsilon * (1 + reach / height) + solved_to * std::min(largest, 1.0);
    if (left_around[f] < weak * lost_around[f]) forms[f].noise = std::max(forms[f].noise, 2 * left[f]);
    compressed[f] = principal[f].compression + forms[f].noise < 0;
  }
  for (const auto& patch : patches(surface.topology, compressed)) {
    double area = 0, strongest = 0;
    bool real = false;
    for (const std::uint32_t f : patch) {
      area += forms[f].rest.area;
      strongest = std::max(strongest, taken_up(f));
      real = real || left_around[f] >= strong * lost_around[f];
    }
    // The critical compression of one wave over the patch, without tension and curvature (local_waves.h).
    const double rate = 2 * std::numbers::pi * material.thickness, least = rate * rate / (6 * area);
    if (real && strongest > least) continue;
    for (const std::uint32_t f : patch)
      forms[f].noise = std::max(forms[f].noise, -2 * principal[f].compression);
  }
}

}  // namespace plisse::wrinkle
