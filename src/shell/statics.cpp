#include "shell/statics.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
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

namespace {

// What pulls at a part as a whole; empty: nothing does.
std::string pull_on(const Shell& shell, const Loads& loads, std::uint32_t component) {
  if (loads.gravity.norm() > 0 && shell.material.density > 0) return "gravity pulls at it";
  if (loads.forces.size() > 0) {
    Vector3d sum = Vector3d::Zero();
    double size = 0;
    for (std::uint32_t v = 0; v < shell.topology.vertex_count; ++v)
      if (shell.topology.component[v] == component) {
        sum += loads.forces.col(v);
        size += loads.forces.col(v).norm();
      }
    if (sum.norm() > 1e-9 * size) return "forces pull at it that do not cancel";
  }
  if (loads.pressure != 0)
    for (const Edge& edge : shell.topology.edges)
      if (edge.boundary() && shell.topology.component[edge.vertex[0]] == component)
        return "pressure pushes it, which is open";
  return "";
}

}  // namespace

void check(const Shell& shell, const Conditions& conditions, const Loads& loads, const Positions& start) {
  std::string problems;
  const auto add = [&](const std::string& text) { problems += (problems.empty() ? "" : "; ") + text; };
  const auto count = static_cast<Eigen::Index>(shell.topology.vertex_count);
  if (shell.rest.size() != shell.topology.faces.size())
    add(fmt::format("{} rest triangles for {} faces", shell.rest.size(), shell.topology.faces.size()));
  if (start.cols() != count) add(fmt::format("{} positions for {} vertices", start.cols(), count));
  if (conditions.at.cols() != count)
    add(fmt::format("conditions for {} of {} vertices", conditions.at.cols(), count));
  if (loads.forces.size() > 0 && loads.forces.cols() != count)
    add(fmt::format("{} nodal forces for {} vertices", loads.forces.cols(), count));
  if (!(shell.residual >= 0 && shell.residual <= 1))
    add(fmt::format("the residual stiffness is {}; allowed: 0 to 1", shell.residual));
  if (!(loads.gap > 0)) add(fmt::format("the gap is {}; allowed: more than 0 m", loads.gap));
  if (!start.allFinite() || !conditions.at.allFinite() || !loads.gravity.allFinite() ||
      !loads.forces.allFinite() || !std::isfinite(loads.pressure))
    add("positions, conditions and loads must be finite");
  if (!problems.empty()) throw Error(ExitCode::bad_input, problems);
  check(shell.material);

  std::vector<std::uint32_t> some_vertex(shell.topology.component_count, none);
  std::vector<bool> kept(shell.topology.component_count, !loads.obstacles.empty());
  for (std::uint32_t v = 0; v < shell.topology.vertex_count; ++v) {
    const std::uint32_t part = shell.topology.component[v];
    if (part == none) continue;
    if (some_vertex[part] == none) some_vertex[part] = v;
    if (conditions.held.col(v).any()) kept[part] = true;
    if (!conditions.held.col(v).all()) continue;
    for (std::size_t o = 0; o < loads.obstacles.size(); ++o)
      if (distance(loads.obstacles[o], conditions.at.col(v)).value <= 0)
        add(fmt::format("vertex {} is held inside obstacle {}", v, o));
  }
  for (std::uint32_t part = 0; part < shell.topology.component_count; ++part) {
    if (kept[part]) continue;
    const std::string pull = pull_on(shell, loads, part);
    if (!pull.empty())
      add(fmt::format("part {} (the one with vertex {}) is held by nothing and {}: hold some of its vertices",
                      part, some_vertex[part], pull));
  }
  if (!problems.empty()) throw Error(ExitCode::bad_input, problems);
}

}  // namespace plisse::shell
