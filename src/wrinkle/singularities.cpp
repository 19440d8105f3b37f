#include "wrinkle/singularities.h"

#include <cmath>
#include <numbers>

namespace plisse::wrinkle {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

Vector2d corner(const FaceForms& forms, std::size_t c) {
  return c == 0 ? Vector2d(0, 0) : Vector2d(forms.rest.edges.col(static_cast<Eigen::Index>(c) - 1));
}
double angle_of(const Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

}  // namespace

std::vector<int> double_index(const std::vector<FaceForms>& forms, const shell::Topology& topology,
                              const std::vector<bool>& live) {
  std::vector<int> result(topology.vertex_count, 0);
  std::vector<bool> done(topology.vertex_count, false);
  for (std::uint32_t first = 0; first < live.size(); ++first) {
    if (!live[first]) continue;
    for (std::size_t start = 0; start < 3; ++start) {
      const std::uint32_t vertex = topology.faces[first][start];
      if (done[vertex]) continue;
      done[vertex] = true;
      // Round the vertex from face to face, over the side that ends in it.
      double turned = 0, angles = 0;
      std::uint32_t face = first;
      bool closed = false;
      do {
        std::size_t c = 0;
        while (topology.faces[face][c] != vertex) ++c;
        const std::size_t to = (c + 2) % 3;
        const Vector2d at = corner(forms[face], c), out = corner(forms[face], (c + 1) % 3) - at,
                       over = corner(forms[face], to) - at;
        angles += std::abs(std::remainder(angle_of(over) - angle_of(out), 2 * pi));
        const double here = angle_of(principal_strain(forms[face]).wave) - angle_of(over);
        const std::uint32_t next = across(topology, face, to);
        if (next == shell::none || !live[next]) break;
        // The same edge seen from the next face, where it is the first side.
        std::size_t d = 0;
        while (topology.faces[next][d] != vertex) ++d;
        const double there = angle_of(principal_strain(forms[next]).wave) -
                             angle_of(corner(forms[next], (d + 1) % 3) - corner(forms[next], d));
        turned += std::remainder(there - here, pi);
        face = next;
        closed = face == first;
      } while (!closed);
      if (closed) result[vertex] = static_cast<int>(std::lround((turned + 2 * pi - angles) / pi));
    }
  }
  return result;
}

}  // namespace plisse::wrinkle
