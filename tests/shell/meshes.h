// Meshes and derivatives for the shell's tests.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "shell/rest_shape.h"

namespace plisse::shell::test {

struct Mesh {
  Positions positions;
  std::vector<Face> faces;
};

enum class Diagonal { rising, falling, alternating };

// columns × rows rectangles over width × height in the plane z = 0, two triangles each, counterclockwise.
inline Mesh grid(int columns, int rows, double width, double height, Diagonal diagonal = Diagonal::falling) {
  Mesh mesh;
  mesh.positions.resize(3, (columns + 1) * (rows + 1));
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.positions.col(id(i, j)) << width * i / columns, height * j / rows, 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
      const bool rising =
          diagonal == Diagonal::rising || (diagonal == Diagonal::alternating && (i + j) % 2 == 0);
      if (rising) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
      } else {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({b, c, d});
      }
    }
  return mesh;
}

// A box of this size about the origin, two triangles a side, wound outward.
inline Mesh box(const Eigen::Vector3d& size) {
  Mesh mesh;
  mesh.positions.resize(3, 8);
  for (int v = 0; v < 8; ++v)
    mesh.positions.col(v) << size[0] * ((v & 1) - 0.5), size[1] * ((v >> 1 & 1) - 0.5),
        size[2] * ((v >> 2) - 0.5);
  mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// A sphere about the origin of rings × 2 rings quadrangles, wound outward.
inline Mesh ball(double radius, int rings) {
  Mesh mesh;
  const int around = 2 * rings;
  mesh.positions.resize(3, (rings - 1) * around + 2);
  mesh.positions.col(0) << 0, 0, radius;
  mesh.positions.col(mesh.positions.cols() - 1) << 0, 0, -radius;
  const auto id = [&](int ring, int i) {
    if (ring == 0) return std::uint32_t{0};
    if (ring == rings) return static_cast<std::uint32_t>(mesh.positions.cols() - 1);
    return static_cast<std::uint32_t>(1 + (ring - 1) * around + i % around);
  };
  for (int ring = 1; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const double down = M_PI * ring / rings, angle = 2 * M_PI * i / around;
      mesh.positions.col(id(ring, i)) << radius * std::sin(down) * std::cos(angle),
          radius * std::sin(down) * std::sin(angle), radius * std::cos(down);
    }
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      if (ring > 0) mesh.faces.push_back({id(ring, i), id(ring + 1, i), id(ring, i + 1)});
      if (ring + 1 < rings) mesh.faces.push_back({id(ring, i + 1), id(ring + 1, i), id(ring + 1, i + 1)});
    }
  return mesh;
}

// Inner vertices of a grid moved by up to `share` of its spacing, in the plane.
inline Mesh jittered(Mesh mesh, double spacing, double share, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> shift(-share * spacing, share * spacing);
  const Eigen::Vector3d low = mesh.positions.rowwise().minCoeff(), high = mesh.positions.rowwise().maxCoeff();
  for (Eigen::Index v = 0; v < mesh.positions.cols(); ++v)
    for (int axis = 0; axis < 2; ++axis) {
      double& x = mesh.positions(axis, v);
      if (x > low[axis] + 1e-9 && x < high[axis] - 1e-9) x += shift(engine);
    }
  return mesh;
}

inline Eigen::Matrix3d random_rotation(std::mt19937& engine) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(engine), normal(engine), normal(engine), normal(engine))
      .normalized()
      .toRotationMatrix();
}

// Central differences along random directions at three steps: where they fall short of the derivative, it
// must be by an error that shrinks with the step squared, until rounding. `scale` is the size of what is
// moved.
template <typename Function, typename Derivative, typename Point>
void expect_derivative(const Function& function, const Derivative& derivative, const Point& at, double scale,
                       std::mt19937& engine) {
  std::normal_distribution<double> normal;
  Point direction = at;
  for (Eigen::Index i = 0; i < direction.size(); ++i) direction.data()[i] = normal(engine);
  direction *= scale / direction.norm();
  const auto expected = derivative(direction);
  const double size = expected.norm() + 1e-300;
  double previous = 0;
  for (const double step : {1e-3, 2.5e-4, 6.25e-5}) {
    const Point ahead = at + step * direction, behind = at - step * direction;
    const double error = ((function(ahead) - function(behind)) / (2 * step) - expected).norm() / size;
    // 1e-8: values of some 10 times their derivative's size times 1e-16, over the smallest step, a tenfold
    // over.
    const double rounding = 1e-8;
    // Third derivatives by less than 1e3 of the first on the scale that is moved.
    EXPECT_LE(error, 1e3 * step * step + rounding);
    // Slope 2: a quarter of the step has a sixteenth of the error; a twelfth is asked for.
    if (previous > 100 * rounding) {
      EXPECT_LE(error, previous / 12 + rounding);
    }
    previous = error;
  }
}

}  // namespace plisse::shell::test
