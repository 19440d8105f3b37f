// Meshes and prescribed forms for tests of the wrinkle field.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "wrinkle/field.h"
#include "wrinkle/solve.h"
#include "wrinkle/start.h"
#include "wrinkle/surface.h"

namespace plisse::test {

// A rectangle 0…width × 0…height of columns × rows cells, each cut along alternating diagonals; flat in the
// xy plane, and its own rest shape. Vertex (i, j) is j·(columns + 1) + i.
struct Grid {
  shell::Positions rest;
  std::vector<shell::Face> faces;

  Grid(double width, double height, int columns, int rows) : rest(3, (columns + 1) * (rows + 1)) {
    for (int j = 0; j <= rows; ++j) {
      for (int i = 0; i <= columns; ++i)
        rest.col(j * (columns + 1) + i) = Eigen::Vector3d(width * i / columns, height * j / rows, 0);
    }
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i), b = a + 1,
                   c = a + static_cast<std::uint32_t>(columns) + 1, d = c + 1;
        if ((i + j) % 2 == 0) {
          faces.push_back({a, b, d});
          faces.push_back({a, d, c});
        } else {
          faces.push_back({a, b, c});
          faces.push_back({b, d, c});
        }
      }
    }
  }
  Eigen::Vector3d centre(const shell::Face& f) const {
    return (rest.col(f[0]) + rest.col(f[1]) + rest.col(f[2])) / 3;
  }
};

// A base surface: the rest vertices moved somewhere.
inline wrinkle::BaseSurface moved(const Grid& grid,
                                  const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place) {
  wrinkle::BaseSurface surface{shell::build_topology(grid.faces, static_cast<std::size_t>(grid.rest.cols())),
                               shell::rest_faces(grid.rest, grid.faces), grid.rest};
  for (Eigen::Index v = 0; v < grid.rest.cols(); ++v) surface.positions.col(v) = place(grid.rest.col(v));
  return surface;
}

// A matrix given in the plane's x and y, in the frame of a rest face: its first edge lies on the first axis.
inline Eigen::Matrix2d in_frame(const Grid& grid, const shell::Face& face, const Eigen::Matrix2d& plane) {
  const Eigen::Vector2d u = (grid.rest.col(face[1]) - grid.rest.col(face[0])).head<2>().normalized();
  Eigen::Matrix2d frame;
  frame << u.x(), -u.y(), u.y(), u.x();
  return frame.transpose() * plane * frame;
}

// The grid's faces with strain and second form prescribed at their centres.
using Form = std::function<Eigen::Matrix2d(const Eigen::Vector3d&)>;
inline std::vector<wrinkle::FaceForms> prescribed(const Grid& grid, const Form& strain, const Form& second) {
  const auto rest = shell::rest_faces(grid.rest, grid.faces);
  std::vector<wrinkle::FaceForms> forms;
  for (std::size_t f = 0; f < grid.faces.size(); ++f) {
    const Eigen::Vector3d x = grid.centre(grid.faces[f]);
    forms.push_back(
        {rest[f], in_frame(grid, grid.faces[f], strain(x)), in_frame(grid, grid.faces[f], second(x))});
  }
  return forms;
}

inline Eigen::Matrix2d diagonal(double x, double y) {
  return Eigen::Vector2d(x, y).asDiagonal();
}
inline Eigen::Matrix2d no_form(const Eigen::Vector3d&) {
  return Eigen::Matrix2d::Zero();
}

inline wrinkle::Model model(double young, double poisson, double thickness) {
  wrinkle::Model result;
  result.material.young = young;
  result.material.poisson = poisson;
  result.material.thickness = thickness;
  return result;
}

// A cylinder of radius r and height .3 m, closed round, under tension along its axis and compressed round it
// by `compression`: rest faces are a rectangle's, base faces close it. Waves run round; amplitude 0 at the
// ends.
struct Tube {
  shell::Topology topology;
  std::vector<wrinkle::FaceForms> forms;
  std::vector<bool> ends;

  explicit Tube(double compression, double poisson = 0.3, double tension = 0.05, double curvature = 0) {
    constexpr int around = 24, along = 12;
    const Grid grid(0.6, 0.3, around, along);
    std::vector<shell::Face> faces;
    for (shell::Face f : grid.faces) {
      for (auto& v : f) v = (v / (around + 1)) * around + v % (around + 1) % around;
      faces.push_back(f);
    }
    topology = shell::build_topology(faces, around * (along + 1));
    forms = prescribed(
        grid, [&](const Eigen::Vector3d&) { return diagonal(-poisson * tension - compression, tension); },
        [&](const Eigen::Vector3d&) { return diagonal(0, curvature); });
    for (std::size_t v = 0; v < topology.vertex_count; ++v) ends.push_back(v < around || v >= around * along);
  }
  wrinkle::Field solve(const wrinkle::Model& model) const {
    return wrinkle::solve_field(topology, forms, model, std::vector<bool>(forms.size(), false), ends);
  }
};

}  // namespace plisse::test
