// Solid bodies that a shell may touch but not enter, as signed distances. A kind is a struct below, its
// functions in a file of its own, solid_NAME.cpp, and its name in the list `Obstacle`; everything else, scene
// files included, goes by that list.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string_view>
#include <variant>
#include <vector>

#include "shell/solid.h"
#include "shell/triangle_body.h"

namespace plisse::shell {

// Every solid is convex and has
//   static constexpr SolidWords words            what scene files call it and must say of it
//   static Solid of(const SolidShape&)           it, from what they say
//   Distance distance(point) const               signed; positive outside
//   double thickness() const                     m: no straight way of this length leads through its middle
//   Vector3d carried_along(after, point) const   where a point that sticks to it is when it has become
//   `after` void visit_members(visit) const              hands over all that it consists of, in one call
// All lengths in metres.
struct Sphere {
  static constexpr SolidWords words{.name = "sphere", .radius = true};
  static Sphere of(const SolidShape& shape) { return {shape.at, shape.radius}; }
  Distance distance(const Eigen::Vector3d& point) const;
  double thickness() const;
  Eigen::Vector3d carried_along(const Sphere& after, const Eigen::Vector3d& point) const;
  void visit_members(auto& visit) const { visit(centre, radius); }

  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1;
};
struct Plane {  // solid behind it
  static constexpr SolidWords words{.name = "plane"};
  static Plane of(const SolidShape& shape) { return {shape.at, shape.normal}; }
  Distance distance(const Eigen::Vector3d& point) const;
  double thickness() const;
  Eigen::Vector3d carried_along(const Plane& after, const Eigen::Vector3d& point) const;
  void visit_members(auto& visit) const { visit(point, normal); }

  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  // unit, pointing out
};
struct Capsule {  // all that is within `radius` of the segment from `first` to `second`
  static constexpr SolidWords words{.name = "capsule", .axis = true, .radius = true};
  static Capsule of(const SolidShape& shape) { return {shape.at, shape.to, shape.radius}; }
  Distance distance(const Eigen::Vector3d& point) const;
  double thickness() const;
  Eigen::Vector3d carried_along(const Capsule& after, const Eigen::Vector3d& point) const;
  void visit_members(auto& visit) const { visit(first, second, radius); }

  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = Eigen::Vector3d::UnitY();
  double radius = 1;
};
struct Cylinder {  // round, with flat ends at `first` and `second`, which differ
  static constexpr SolidWords words{.name = "cylinder", .axis = true, .radius = true};
  static Cylinder of(const SolidShape& shape) { return {shape.at, shape.to, shape.radius}; }
  Distance distance(const Eigen::Vector3d& point) const;
  double thickness() const;
  Eigen::Vector3d carried_along(const Cylinder& after, const Eigen::Vector3d& point) const;
  void visit_members(auto& visit) const { visit(first, second, radius); }

  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = Eigen::Vector3d::UnitY();
  double radius = 1;
};
using Body = std::shared_ptr<const TriangleBody>;  // in scene files a "mesh"

// In the order in which messages and docs name them.
using Obstacle = std::variant<Sphere, Plane, Capsule, Cylinder, Body>;

// What scene files know of a kind.
struct ObstacleKind {
  SolidWords words;
  Obstacle (*make)(const SolidShape& shape) = nullptr;  // none: it is made of a model's file
};
const std::vector<ObstacleKind>& obstacle_kinds();

// For a Body without second derivative: solvers use contact().
Distance distance(const Obstacle& obstacle, const Eigen::Vector3d& point);

// The barrier of a body at a point; infinite in it.
Contact contact(const Obstacle& obstacle, const Eigen::Vector3d& point, double gap, bool curvature);

// The share, at most 1, of a straight path that a point may follow without passing through the body: it may
// end inside, which is noticed, but not beyond.
double free_way(const Obstacle& obstacle, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace plisse::shell
