#include "bench/sizing_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloth/drape_mesh.h"
#include "sizing/mesh_panel.h"

namespace plisse::bench {
namespace {

using Eigen::Vector3d;
using shell::Conditions;
using shell::Positions;
using std::numbers::pi;

constexpr double gravity = 9.81;  // m/s²

cloth::DrapeScene scene_on(const EvenMesh& mesh) {
  cloth::DrapeScene scene;
  scene.rest = scene.start = mesh.points;
  scene.rest_faces = scene.faces = mesh.faces;
  scene.stretching = shell::Stretching::stvk;
  scene.bending = shell::Bending::midedge;
  return scene;
}

struct OnLine {
  double along;  // rest coordinate along the line
  double z;
};

// The surface over the line where a rest coordinate (0: x, 1: y) has a value, in order.
std::vector<OnLine> section(const cloth::DrapeScene& scene, const Positions& positions, int axis,
                            double value) {
  std::vector<OnLine> points;
  for (const shell::Face& face : scene.rest_faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % 3];
      const double from = scene.rest(axis, a) - value, to = scene.rest(axis, b) - value;
      if ((from < 0) == (to < 0)) continue;
      const double t = from / (from - to);
      points.push_back({(1 - t) * scene.rest(1 - axis, a) + t * scene.rest(1 - axis, b),
                        (1 - t) * positions(2, a) + t * positions(2, b)});
    }
  }
  std::sort(points.begin(), points.end(), [](const OnLine& a, const OnLine& b) { return a.along < b.along; });
  return points;
}

}  // namespace

EvenMesh even_mesh(double width, double height, double edge, const std::vector<double>& lines) {
  sizing::Panel panel;
  panel.fabric = *sizing::find_fabric("cantilever");
  const sizing::SizingOptions options;
  const double scale = sizing::fabric_resolution(options.law, panel.fabric.weft) / edge;
  panel.outline = cloth::rectangle_outline(width * scale, height * scale);
  for (const double x : lines) {
    sizing::Feature line;  // a contraction of 1 asks for nothing finer, but the line stays
    line.name = "line";
    line.line = {{{x * scale, 0}, {x * scale, height * scale}}, false};
    panel.features.push_back(line);
  }
  const auto sized = sizing::mesh_panel(panel, options);
  EvenMesh mesh;
  mesh.points.resize(3, static_cast<Eigen::Index>(sized->mesh.vertices.size()));
  for (std::size_t v = 0; v < sized->mesh.vertices.size(); ++v) {
    const glm::dvec2 point = sized->mesh.vertices[v] / scale;
    mesh.points.col(static_cast<Eigen::Index>(v)) << point.x, point.y, 0;
  }
  for (const auto& triangle : sized->mesh.triangles) mesh.faces.push_back(triangle);
  return mesh;
}

EvenMesh square_mesh(double width, double height, double edge) {
  const auto pieces = [&](double length) {
    return std::max(1, static_cast<int>(std::lround(length / edge)));
  };
  const cloth::FlatMesh mesh =
      cloth::grid_mesh(width, height, pieces(width), pieces(height), cloth::Diagonals::alternating);
  return {mesh.points, mesh.faces};
}

cloth::DrapeScene strip_scene(const Strip& strip, double edge, StripMesh kind, shell::Bending bending) {
  const int columns = std::max(2, static_cast<int>(std::lround(strip.length / edge)));
  // Half an edge of the free length lies before the table's edge where the hinge there stands for both sides.
  const double step = kind == StripMesh::regular ? strip.length / (columns + 0.5) : edge;
  const double held = kind == StripMesh::regular ? step : std::max(edge, 0.01),
               free = kind == StripMesh::regular ? step * columns : strip.length;
  const EvenMesh mesh =
      kind == StripMesh::regular
          ? [&] {
              const cloth::FlatMesh grid = cloth::grid_mesh(
                  held + free, strip.width, columns + 1,
                  std::max(1, static_cast<int>(std::lround(strip.width / step))), cloth::Diagonals::alternating);
              return EvenMesh{grid.points, grid.faces};
            }()
          : even_mesh(held + free, strip.width, edge, {held});
  cloth::DrapeScene scene = scene_on(mesh);
  scene.bending = bending;
  const double thickness = std::cbrt(12 * strip.bending / strip.modulus);
  scene.material = {strip.modulus, 0, thickness, strip.weight / thickness};
  scene.start.row(0).array() -= held;
  scene.start.row(2) = -mesh.points.row(1);  // lying
  scene.start.row(1).setZero();
  scene.loads.gravity << 0, -gravity, 0;
  const Positions start = scene.start;
  scene.conditions = [start](double) {
    Conditions conditions(static_cast<std::size_t>(start.cols()));
    for (std::uint32_t v = 0; v < start.cols(); ++v)
      if (start(0, v) < 1e-6) conditions.hold(v, start.col(v));
    return conditions;
  };
  return scene;
}

double sag_of(const Positions& positions) {
  return -positions.row(1).minCoeff();
}

double sag_of_beam(const Strip& strip) {
  const double g = strip.weight * gravity * std::pow(strip.length, 3) / strip.bending;
  constexpr int steps = 20000;
  constexpr double ds = 1.0 / steps;
  double drop = 0;
  // θ' at the end, and the drop over the length; classical Runge–Kutta.
  const auto shoot = [&](double curvature) {
    double angle = 0, slope = curvature;
    drop = 0;
    for (int i = 0; i < steps; ++i) {
      const double s = i * ds;
      const auto bend = [&](double at, double theta) { return -g * (1 - at) * std::cos(theta); };
      const double k1 = slope, l1 = bend(s, angle);
      const double k2 = slope + ds / 2 * l1, l2 = bend(s + ds / 2, angle + ds / 2 * k1);
      const double k3 = slope + ds / 2 * l2, l3 = bend(s + ds / 2, angle + ds / 2 * k2);
      const double k4 = slope + ds * l3, l4 = bend(s + ds, angle + ds * k3);
      const double before = angle;
      angle += ds / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      slope += ds / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      drop += ds / 2 * (std::sin(before) + std::sin(angle));
      if (angle > pi) return 1.0;  // the curvature is too large: the beam turns over
      if (slope < 0) return slope;
    }
    return slope;
  };
  double low = 0, high = g;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (shoot(middle) < 0 ? low : high) = middle;
  }
  shoot(high);
  return drop * strip.length;
}

cloth::DrapeScene sheet_scene(double edge, bool stvk) {
  const double width = 0.25, height = 0.1, stretch = 0.1278;
  cloth::DrapeScene scene =
      scene_on(stvk ? square_mesh(width, height, edge) : even_mesh(width, height, edge));
  scene.material = {1e6, 0.5, 1e-4, 0};
  if (stvk) {
    // A tenth of the thickness: flat is an equilibrium too.
    for (Eigen::Index v = 0; v < scene.start.cols(); ++v)
      scene.start(2, v) = 1e-5 * std::sin(2 * pi * 6 * scene.rest(1, v) / height + 1) *
                          std::sin(pi * scene.rest(0, v) / width);
  } else {
    scene.stretching = shell::Stretching::tension_field;
    scene.bending = shell::Bending::quadratic;
  }
  const Positions rest = scene.rest;
  scene.conditions = [=](double t) {
    Conditions conditions(static_cast<std::size_t>(rest.cols()));
    for (std::uint32_t v = 0; v < rest.cols(); ++v) {
      const bool left = rest(0, v)<1e-6, right = rest(0, v)> width - 1e-6;
      if (left || right) conditions.hold(v, {rest(0, v) * (1 + stretch * t), rest(1, v), 0});
    }
    return conditions;
  };
  return scene;
}

Crossing waves_across(const cloth::DrapeScene& scene, const Positions& positions) {
  const auto points = section(scene, positions, 0, 0.5 * scene.rest.row(0).maxCoeff() + 1e-9);
  Crossing crossing;
  double low = 0, high = 0;
  for (const OnLine& point : points) {
    low = std::min(low, point.z);
    high = std::max(high, point.z);
  }
  crossing.amplitude = (high - low) / 2;
  if (crossing.amplitude < 0.01 * scene.material.thickness) return crossing;  // it is flat
  // Half waves: runs between a height and a depth of a tenth of the greatest.
  int runs = 0, last = 0;
  for (const OnLine& point : points) {
    if (std::abs(point.z) < 0.1 * crossing.amplitude) continue;
    const int side = point.z > 0 ? 1 : -1;
    if (side != last) ++runs;
    last = side;
  }
  crossing.waves = runs / 2.0;
  return crossing;
}

cloth::DrapeScene curtain_scene(const Curtain& curtain, double edge, double guess) {
  const double width = curtain.wavelength / (1 - curtain.compression);
  const double share = 1 - curtain.compression;
  cloth::DrapeScene scene = scene_on(square_mesh(width, curtain.height, edge));
  const double thickness = std::cbrt(12 * (1 - 0.09) * curtain.bending / curtain.modulus);
  scene.material = {curtain.modulus, 0.3, thickness, curtain.weight / thickness};
  scene.loads.gravity << 0, -gravity, 0;
  // Amplitudes of sines of the right length: δ ≈ k²a²/4 over the gathered width, exactly for small δ.
  const double k = 2 * pi / curtain.wavelength;
  const double a = 2 / k * std::sqrt(1 / (share * share) - 1) / std::numbers::sqrt2;
  for (Eigen::Index v = 0; v < scene.start.cols(); ++v) {
    const double x = scene.rest(0, v) * share, down = curtain.height - scene.rest(1, v);
    const double s = std::clamp((down - 0.5 * guess) / guess, 0.0, 1.0);
    scene.start(0, v) = x;
    scene.start(2, v) = a * (std::sqrt(1 - s) * std::cos(k * x) + 2 * std::sqrt(s) * std::cos(k * x / 2));
  }
  const Positions start = scene.start, rest = scene.rest;
  const double height = curtain.height;
  scene.conditions = [=](double) {
    Conditions conditions(static_cast<std::size_t>(start.cols()));
    for (std::uint32_t v = 0; v < start.cols(); ++v) {
      if (rest(0, v) < 1e-9 || rest(0, v) > width - 1e-9) conditions.hold(v, 0, start(0, v));
      if (rest(1, v) > height - 1e-9) conditions.hold(v, start.col(v));
    }
    return conditions;
  };
  return scene;
}

Transition transition_of(const Curtain& curtain, const cloth::DrapeScene& scene, const Positions& positions) {
  Transition result;
  const double width = scene.rest.row(0).maxCoeff();
  constexpr int rows = 400;
  for (int i = 1; i < rows && result.most < 0; ++i) {
    const double down = curtain.height * i / rows;
    const auto points = section(scene, positions, 1, curtain.height - down + 1e-9);
    // Amplitudes of cos πx/W and cos 2πx/W; slack in each is as their slopes squared.
    double long_wave = 0, short_wave = 0, whole = 0;
    for (std::size_t p = 1; p < points.size(); ++p) {
      const double dx = points[p].along - points[p - 1].along,
                   x = (points[p].along + points[p - 1].along) / 2, z = (points[p].z + points[p - 1].z) / 2;
      long_wave += dx * z * std::cos(pi * x / width);
      short_wave += dx * z * std::cos(2 * pi * x / width);
      whole += dx;
    }
    if (whole <= 0) continue;
    const double slack = long_wave * long_wave, other = 4 * short_wave * short_wave;
    const double share = slack / (slack + other);
    if (share > 0.5 && result.half < 0) result.half = down;
    if (share > 0.9) result.most = down;
  }
  return result;
}

}  // namespace plisse::bench
