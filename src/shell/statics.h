// A shell in static equilibrium: what it is made of, what holds it and what pulls at it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "shell/loads.h"
#include "shell/material.h"
#include "shell/rest_shape.h"
#include "shell/stretching.h"

namespace plisse::shell {

enum class Bending { off, quadratic, midedge };

struct Shell {
  Topology topology;
  std::vector<RestFace> rest;  // one a face
  Material material;
  Stretching stretching = Stretching::tension_field;
  Bending bending = Bending::quadratic;
  double residual = 0;  // η of StretchingLaw
  std::vector<Eigen::Matrix2d>
      rest_forms;  // II_u of each face, 1/m, for mid-edge bending; empty: flat at rest
};

// Where a vertex is held, by coordinate: clamps hold all three, rollers and symmetry planes some. `at` is
// read where `held` is set.
struct Conditions {
  // A plane across an axis, of which the shell is one side: boundary edges whose ends are both held in it go
  // on as their own mirror image, so mid-edge normals lie in it. (The quadratic bending takes them for free
  // edges, and stretching needs no more than the hold.)
  struct Mirror {
    int axis = 0;
    double at = 0;  // m
  };
  Eigen::Matrix<bool, 3, Eigen::Dynamic> held;  // 3×V
  Positions at;                                 // m, 3×V
  std::vector<Mirror> mirrors;

  explicit Conditions(std::size_t vertices = 0);
  void hold(std::uint32_t vertex, const Eigen::Vector3d& position);
  void hold(std::uint32_t vertex, int axis, double coordinate);
};

// Adds a dead force a rest length, N/m, on edges (vertex pairs, of the base): half of it to each end.
void add_edge_forces(Loads& loads, const Topology& topology, const std::vector<RestFace>& rest,
                     const std::vector<std::array<std::uint32_t, 2>>& edges,
                     const Eigen::Vector3d& per_length);

// The volume that pressure works on, of a part that is open, is that of cones from its faces to an apex:
// right where nothing moves that the open side's own cones would push at. So the boundary's edges must be
// held at both ends, either altogether or in the one plane across an axis in which they may slide (a symmetry
// plane), which then goes through the apex.
struct OpenSide {
  bool open = false;
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();  // m
  std::uint32_t loose = none;  // a vertex of the boundary that is not held so; none: there is none
};
std::vector<OpenSide> open_sides(const Topology& topology, const Conditions& conditions);  // of each part

// Parts that are pulled at along an axis in which nothing holds them and that are not on their way to an
// obstacle: which, and what pulls; empty: there is none. (Parts that are free to turn only have an
// equilibrium: dead loads have a least energy among all turns.)
std::string unsupported(const Shell& shell, const Conditions& conditions, const Loads& loads,
                        const Positions& positions);
// Of parts that are so pulled at: the farthest that the mean of one has gone in those axes, across the pull,
// m.
double longest_slide(const Shell& shell, const Conditions& conditions, const Loads& loads,
                     const Positions& from, const Positions& to);

// Throws Error(bad_input), all problems at once: counts that do not agree, values that are not finite, a part
// of the shell that is pulled at along an axis, held by nothing in it and not above an obstacle that it would
// land on (its number, a vertex of it and what pulls), pressure on a part with a loose boundary, an obstacle
// that a held vertex lies in.
void check(const Shell& shell, const Conditions& conditions, const Loads& loads, const Positions& start);

// Volume under the faces, the sum of their cones to the origin, m³.
double enclosed_volume(const std::vector<Face>& faces, const Positions& positions);

}  // namespace plisse::shell
