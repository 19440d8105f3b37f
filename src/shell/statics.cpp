#include "shell/statics.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"

namespace plisse::shell {

using Eigen::Vector3d;

Conditions::Conditions(std::size_t vertices) {
  const auto count = static_cast<Eigen::Index>(vertices);
  held.setConstant(3, count, false);
  at.setZero(3, count);
}

void Conditions::hold(std::uint32_t vertex, const Vector3d& position) {
  for (int axis = 0; axis < 3; ++axis) hold(vertex, axis, position[axis]);
}

void Conditions::hold(std::uint32_t vertex, int axis, double coordinate) {
  held(axis, vertex) = true;
  at(axis, vertex) = coordinate;
}

double enclosed_volume(const std::vector<Face>& faces, const Positions& positions) {
  double six = 0;
  for (const Face& face : faces)
    six += positions.col(face[0]).dot(positions.col(face[1]).cross(positions.col(face[2])));
  return six / 6;
}

std::vector<OpenSide> open_sides(const Topology& topology, const Conditions& conditions) {
  std::vector<OpenSide> sides(topology.component_count);
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, topology.component_count), count = sum;
  // The apex: the mean of the held vertices, moved into the planes in which edges may slide.
  std::vector<std::array<bool, 3>> bound(topology.component_count, {false, false, false});
  const auto clamped = [&](std::uint32_t v) { return conditions.held.col(v).all(); };
  for (const int pass : {0, 1})
    for (const Edge& edge : topology.edges) {
      if (!edge.boundary()) continue;
      const auto [a, b] = edge.vertex;
      const std::uint32_t part = topology.component[a];
      OpenSide& side = sides[part];
      side.open = true;
      if (pass == 0) {
        for (const std::uint32_t v : edge.vertex)
          for (int axis = 0; axis < 3; ++axis)
            if (conditions.held(axis, v)) {
              sum(axis, part) += conditions.at(axis, v);
              count(axis, part) += 1;
            }
        continue;
      }
      if (clamped(a) && clamped(b)) continue;
      bool slides = false;
      for (int axis = 0; axis < 3 && !slides; ++axis) {
        if (!conditions.held(axis, a) || !conditions.held(axis, b)) continue;
        const double at = conditions.at(axis, a);
        if (conditions.at(axis, b) != at) continue;
        auto& taken = bound[part][static_cast<std::size_t>(axis)];
        if (taken && side.apex[axis] != at) continue;
        taken = slides = true;
        side.apex[axis] = at;
      }
      if (!slides) side.loose = clamped(a) ? b : a;
    }
  for (std::uint32_t part = 0; part < topology.component_count; ++part)
    for (int axis = 0; axis < 3; ++axis)
      if (!bound[part][static_cast<std::size_t>(axis)] && count(axis, part) > 0)
        sides[part].apex[axis] = sum(axis, part) / count(axis, part);
  return sides;
}

namespace {

struct Pull {
  Vector3d force = Vector3d::Zero();             // N, along axes without held vertices
  Eigen::Array3d free = Eigen::Array3d::Ones();  // 1: no vertex is held along this axis
  std::string what;                              // the load; empty: none
};

Pull pull_on(const Shell& shell, const Conditions& conditions, const Loads& loads, std::uint32_t part) {
  const Eigen::VectorXd areas = vertex_areas(shell.topology, shell.rest);
  Pull pull;
  Vector3d weight = Vector3d::Zero(), sum = Vector3d::Zero();
  double size = 0;
  for (std::uint32_t v = 0; v < shell.topology.vertex_count; ++v) {
    if (shell.topology.component[v] != part) continue;
    pull.free *= 1 - conditions.held.col(v).array().cast<double>();
    weight += shell.material.density * shell.material.thickness * areas[v] * loads.gravity;
    if (loads.forces.size() == 0) continue;
    sum += loads.forces.col(v);
    size += loads.forces.col(v).norm();
  }
  pull.force = pull.free * (weight + sum).array();
  // 1e-9: forces that cancel do so up to the rounding of this many summands.
  if (pull.force.norm() <= 1e-9 * (weight.norm() + size)) return pull;
  pull.what = (pull.free * weight.array()).matrix().norm() > 0 ? "gravity pulls at it"
                                                               : "forces pull at it that do not cancel";
  return pull;
}

// Whether a point that moves straight on comes within the gap of a body. All bodies except triangle meshes
// are convex: a path that leads away does not come back.
bool lands(const Obstacle& obstacle, Vector3d point, const Vector3d& way, double gap) {
  if (const auto* body = std::get_if<Body>(&obstacle)) {
    const auto& box = (*body)->tree().box();
    const double far = (point - box.center()).norm() + box.diagonal().norm();
    return (*body)->distance(point).value <= gap || (*body)->tree().first_hit(point, point + far * way) <= 1;
  }
  for (int step = 0; step < 10000; ++step) {
    const Distance d = distance(obstacle, point);
    if (d.value <= gap) return true;
    if (d.first.dot(way) >= 0) return false;
    point += std::max(d.value - 0.5 * gap, 0.5 * gap) * way;
  }
  return true;  // along its side for very long
}

std::string named(std::uint32_t part, std::uint32_t vertex) {
  return fmt::format("part {} (the one with vertex {})", part, vertex);
}

}  // namespace

std::string unsupported(const Shell& shell, const Conditions& conditions, const Loads& loads,
                        const Positions& positions) {
  std::string problems;
  const auto& component = shell.topology.component;
  for (std::uint32_t part = 0; part < shell.topology.component_count; ++part) {
    const Pull pull = pull_on(shell, conditions, loads, part);
    if (pull.what.empty()) continue;
    bool caught = false;
    for (std::uint32_t v = 0; v < shell.topology.vertex_count && !caught; ++v)
      for (std::size_t o = 0; o < loads.obstacles.size() && !caught; ++o)
        caught = component[v] == part &&
                 lands(loads.obstacles[o], positions.col(v), pull.force.normalized(), loads.gap);
    if (caught) continue;
    const auto vertex =
        static_cast<std::uint32_t>(std::find(component.begin(), component.end(), part) - component.begin());
    problems += fmt::format("{}{} is held by nothing and {}: hold some of its vertices{}",
                            problems.empty() ? "" : "; ", named(part, vertex), pull.what,
                            loads.obstacles.empty() ? "" : ", or put an obstacle in its way");
  }
  return problems;
}

double longest_slide(const Shell& shell, const Conditions& conditions, const Loads& loads,
                     const Positions& from, const Positions& to) {
  double longest = 0;
  for (std::uint32_t part = 0; part < shell.topology.component_count; ++part) {
    const Pull pull = pull_on(shell, conditions, loads, part);
    if (pull.what.empty()) continue;
    Vector3d sum = Vector3d::Zero();
    double count = 0;
    for (std::uint32_t v = 0; v < shell.topology.vertex_count; ++v) {
      if (shell.topology.component[v] != part) continue;
      sum += to.col(v) - from.col(v);
      ++count;
    }
    // Motion along the load is a fall, not a slide; `unsupported` checks its end.
    Vector3d way = (pull.free * sum.array()).matrix() / count;
    const Vector3d down = pull.force.normalized();
    way -= way.dot(down) * down;
    longest = std::max(longest, way.norm());
  }
  return longest;
}

void add_edge_forces(Loads& loads, const Topology& topology, const std::vector<RestFace>& rest,
                     const std::vector<std::array<std::uint32_t, 2>>& edges, const Vector3d& per_length) {
  if (loads.forces.size() == 0) loads.forces = Positions::Zero(3, topology.vertex_count);
  for (auto [a, b] : edges) {
    if (a > b) std::swap(a, b);
    const auto edge = std::lower_bound(
        topology.edges.begin(), topology.edges.end(), std::array{a, b},
        [](const Edge& one, const std::array<std::uint32_t, 2>& pair) { return one.vertex < pair; });
    if (edge == topology.edges.end() || edge->vertex != std::array{a, b})
      throw Error(ExitCode::bad_input, fmt::format("a load is on the edge {}-{}, which no face has", a, b));
    const RestFace& triangle = rest[edge->face[0]];
    const auto& sides = topology.face_edges[edge->face[0]];
    const auto opposite =
        std::find(sides.begin(), sides.end(), static_cast<std::uint32_t>(edge - topology.edges.begin())) -
        sides.begin();
    // A hat function falls by 1 over the triangle's height, which is twice its area over the edge.
    const double length = 2 * triangle.area * triangle.gradients.col(opposite).norm();
    for (const std::uint32_t v : {a, b}) loads.forces.col(v) += 0.5 * length * per_length;
  }
}

void check(const Shell& shell, const Conditions& conditions, const Loads& loads, const Positions& start) {
  std::string problems;
  const auto add = [&](const std::string& text) { problems += (problems.empty() ? "" : "; ") + text; };
  const auto count = static_cast<Eigen::Index>(shell.topology.vertex_count);
  if (shell.rest.size() != shell.topology.faces.size())
    add(fmt::format("{} rest triangles for {} faces", shell.rest.size(), shell.topology.faces.size()));
  if (!shell.rest_forms.empty() &&
      (shell.rest_forms.size() != shell.rest.size() || shell.bending == Bending::quadratic))
    add(fmt::format("{} second forms of rest triangles; one a face is wanted, and mid-edge bending",
                    shell.rest_forms.size()));
  if (!shell.rest_forms.empty() && !conditions.mirrors.empty())
    add("mirrors are for shells that are flat at rest: second forms at rest know nothing of them");
  if (start.cols() != count) add(fmt::format("{} positions for {} vertices", start.cols(), count));
  if (conditions.at.cols() != count)
    add(fmt::format("conditions for {} of {} vertices", conditions.at.cols(), count));
  if (loads.forces.size() > 0 && loads.forces.cols() != count)
    add(fmt::format("{} nodal forces for {} vertices", loads.forces.cols(), count));
  if (!(shell.residual >= 0 && shell.residual <= 1))
    add(fmt::format("the residual stiffness is {}; allowed: 0 to 1", shell.residual));
  if (!(loads.friction >= 0 && loads.friction <= 1e3))
    add(fmt::format("the coefficient of friction is {}; allowed: 0 to 1000", loads.friction));
  if (!(loads.slip >= 0)) add(fmt::format("the slip length is {}; allowed: 0 m or more", loads.slip));
  if (!loads.anchors.empty() && loads.anchors.size() != loads.obstacles.size())
    add(fmt::format("anchors for {} of {} obstacles", loads.anchors.size(), loads.obstacles.size()));
  for (const Positions& anchors : loads.anchors)
    if (anchors.cols() != count) add(fmt::format("{} anchors for {} vertices", anchors.cols(), count));
  if (!(loads.gap > 0)) add(fmt::format("the gap is {}; allowed: more than 0 m", loads.gap));
  if (!start.allFinite() || !conditions.at.allFinite() || !loads.gravity.allFinite() ||
      !loads.forces.allFinite() || !std::isfinite(loads.pressure))
    add("positions, conditions and loads must be finite");
  if (!problems.empty()) throw Error(ExitCode::bad_input, problems);
  check(shell.material);

  std::vector<std::uint32_t> some_vertex(shell.topology.component_count, none);
  for (std::uint32_t v = 0; v < shell.topology.vertex_count; ++v) {
    const std::uint32_t part = shell.topology.component[v];
    if (part == none) continue;
    if (some_vertex[part] == none) some_vertex[part] = v;
    if (!conditions.held.col(v).all()) continue;
    for (std::size_t o = 0; o < loads.obstacles.size(); ++o)
      if (distance(loads.obstacles[o], conditions.at.col(v)).value <= 0)
        add(fmt::format("vertex {} is held inside obstacle {}", v, o));
  }
  const auto sides = open_sides(shell.topology, conditions);
  for (std::uint32_t part = 0; part < shell.topology.component_count; ++part) {
    if (loads.pressure != 0 && sides[part].open && sides[part].loose != none)
      add(fmt::format(
          "{}: pressure pushes it, which is open, and its boundary is loose at vertex {}: hold it "
          "all round, or in one plane across an axis",
          named(part, some_vertex[part]), sides[part].loose));
  }
  const std::string falling = unsupported(shell, conditions, loads, start);
  if (!falling.empty()) add(falling);
  if (!problems.empty()) throw Error(ExitCode::bad_input, problems);
}

}  // namespace plisse::shell
