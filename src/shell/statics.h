// A shell in static equilibrium: its material, boundary conditions and loads.
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
  double residual = 0;       // η of StretchingLaw
  double tension_limit = 0;  // of StretchingLaw
  std::vector<Eigen::Matrix2d>
      rest_forms;  // II_u of each face, 1/m, for mid-edge bending; empty: flat at rest
};

// Where a vertex is held, by coordinate: clamps hold all three, rollers and symmetry planes some. `at` is
// read where `held` is set.
struct Conditions {
  // A symmetry plane normal to an axis, with the shell on one side: across boundary edges with both ends held
  // in it, the shell continues as its mirror image, so mid-edge normals are in the plane. (The quadratic
  // bending treats them as free edges, and stretching only needs the held coordinate.)
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

// The volume for pressure is that of the cones from the faces to an apex. For an open part this gives the
// right forces only if the cone faces of the open side do not move. So the boundary's edges must be held at
// both ends, either completely or in one plane normal to an axis in which they may slide (a symmetry plane),
// and the apex is in that plane.
struct OpenSide {
  bool open = false;
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();  // m
  std::uint32_t loose = none;  // a vertex of the boundary that is not held in this way, or none
};
std::vector<OpenSide> open_sides(const Topology& topology, const Conditions& conditions);  // of each part

// The parts with a load along an axis in which they are not held, and without an obstacle that would stop
// them: their names and loads; empty: there are none. (Parts that are only free to rotate have an
// equilibrium: under dead loads one rotation has the least energy.)
std::string unsupported(const Shell& shell, const Conditions& conditions, const Loads& loads,
                        const Positions& positions);
// For parts with such a load: the largest displacement of a part's mean in those axes, perpendicular to the
// load, m.
double longest_slide(const Shell& shell, const Conditions& conditions, const Loads& loads,
                     const Positions& from, const Positions& to);

// Throws Error(bad_input), all problems at once: counts that do not agree, values that are not finite, a part
// with a load along an axis in which it is not held and no obstacle would stop it (its number, one of its
// vertices and the load), pressure on a part whose boundary is not held, an obstacle that a held vertex lies
// in.
void check(const Shell& shell, const Conditions& conditions, const Loads& loads, const Positions& start);

// Volume under the faces, the sum of their cones to the origin, m³.
double enclosed_volume(const std::vector<Face>& faces, const Positions& positions);

}  // namespace plisse::shell
