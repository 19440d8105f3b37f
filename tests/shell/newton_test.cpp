// The solver against equilibria that are known, and against what must not stop or poison it.
#include "shell/newton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "shell/meshes.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::shell {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

struct Case {
  Shell shell;
  Conditions conditions{0};
  Loads loads;
  Positions start;

  explicit Case(const test::Mesh& mesh, const Material& material = {1e6, 0.3, 1e-4, 0})
      : start(mesh.positions) {
    const auto count = static_cast<std::size_t>(mesh.positions.cols());
    shell.topology = build_topology(mesh.faces, count);
    shell.rest = rest_faces(mesh.positions, mesh.faces);
    shell.material = material;
    conditions = Conditions(count);
  }
  Equilibrium solve(const NewtonSettings& settings = {}) const {
    return find_equilibrium(shell, conditions, loads, start, settings);
  }
};

// The strip of .25 × .1 m stretched by `share`, its ends free to contract.
Case strip(int columns, int rows, const Material& material, double share) {
  Case c(test::jittered(test::grid(columns, rows, 0.25, 0.1), 0.25 / columns, 0.2, 3), material);
  for (Eigen::Index v = 0; v < c.start.cols(); ++v) {
    const auto vertex = static_cast<std::uint32_t>(v);
    const double x = c.start(0, v);
    if (x < 1e-9) c.conditions.hold(vertex, 0, 0);
    if (x > 0.25 - 1e-9) c.conditions.hold(vertex, 0, 0.25 * (1 + share));
    c.conditions.hold(vertex, 2, 0);
  }
  c.conditions.hold(0, 1, 0);
  return c;
}

TEST(ShellNewton, StretchedStrip) {
  for (const Stretching model : {Stretching::tension_field, Stretching::stvk})
    for (const double nu : {0.0, 0.3, 0.4999, 0.5}) {
      Case c = strip(10, 4, {1e6, nu, 1e-4, 0}, 0.1);
      c.shell.stretching = model;
      c.shell.bending = Bending::off;
      const Equilibrium e = c.solve();
      ASSERT_TRUE(e.converged) << e.reason;
      // E = ½Yh(λ₁/2)²A, λ₁ = .21; residuals of 1e-8 change the energy by their square.
      EXPECT_NEAR(e.energy, 0.5 * 1e6 * 1e-4 * 0.105 * 0.105 * 0.025, 1e-10) << nu;
      const double width = e.positions.row(1).maxCoeff() - e.positions.row(1).minCoeff();
      EXPECT_NEAR(width, 0.1 * std::sqrt(1 - nu * 0.21), 1e-7);
    }
}

TEST(ShellNewton, TheSameFromDifferentStarts) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  Case c = strip(8, 4, {1e6, 0.3, 1e-4, 0}, 0.1);
  const Equilibrium first = c.solve();
  for (int trial = 0; trial < 3; ++trial) {
    for (Eigen::Index i = 0; i < c.start.size(); ++i) c.start.data()[i] += 0.01 * normal(engine);
    const Equilibrium other = c.solve();
    ASSERT_TRUE(other.converged) << other.reason;
    EXPECT_NEAR(other.energy, first.energy, 1e-10 * first.energy);
    // Forces balance to 1e-8 of some 1e-2 N, stiffnesses are some 1e2 N/m.
    EXPECT_LT((other.positions - first.positions).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(ShellNewton, EnergyFallsWithEveryStep) {
  Case c = strip(8, 4, {1e6, 0.3, 1e-4, 0}, 0.3);
  const Equilibrium e = c.solve();
  ASSERT_GT(e.trace.size(), 2u);
  for (std::size_t i = 1; i < e.trace.size(); ++i)
    EXPECT_LE(e.trace[i].energy, e.trace[i - 1].energy * (1 + 1e-14));  // rounding
}

// A plate strip under its own weight against the elastica's numbers ("heavy cantilever", ν 0, G = wL³/B).
TEST(ShellNewtonSlow, HeavyCantilever) {
  const double expected[][2] = {
      {0.1, 0.012498}, {1, 0.123471}, {5, 0.495905}, {10, 0.700200}, {20, 0.829881}};
  const int columns = 40;
  // Two columns of vertices are held; the first hinge that may bend lies at the second, and what bends at a
  // hinge stands for half an edge on each side of it.
  const double length = 1, edge = length / (columns - 0.5);
  const auto mesh = test::grid(columns, 2, columns * edge, 0.1, test::Diagonal::alternating);
  for (const auto& [load, drop] : expected) {
    Case c(mesh, {1e7, 0, 1e-3, 1000});
    c.shell.stretching = Stretching::stvk;
    c.shell.bending = Bending::midedge;
    for (Eigen::Index v = 0; v < c.start.cols(); ++v)
      if (c.start(0, v) < 1.5 * edge) c.conditions.hold(static_cast<std::uint32_t>(v), c.start.col(v));
    const double weight = c.shell.material.density * c.shell.material.thickness;
    c.loads.gravity << 0, 0, -load * c.shell.material.bending_stiffness() / weight;
    const Equilibrium e = c.solve();
    ASSERT_TRUE(e.converged) << e.reason;
    EXPECT_NEAR(-e.positions(2, columns) / length, drop, 0.01 * drop) << load;
  }
}

TEST(ShellNewton, AtRestNothingMoves) {
  for (const Stretching model : {Stretching::tension_field, Stretching::stvk})
    for (const double strain : {0.0, 1e-16, -1e-16}) {
      Case c(test::grid(6, 6, 1, 1));
      c.shell.stretching = model;
      c.start *= 1 + strain;
      const Equilibrium e = c.solve();  // held by nothing, pulled at by nothing
      EXPECT_TRUE(e.converged) << e.reason;
      EXPECT_EQ(e.iterations, 0);
    }
}

// Back to rest, where all forces vanish: what is left of them is rounding, however small what meets there.
TEST(ShellNewton, UnloadedShellsConvergeToRest) {
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  for (const Stretching model : {Stretching::tension_field, Stretching::stvk})
    for (const Bending bending : {Bending::quadratic, Bending::midedge})
      for (const double thickness : {1e-4, 1e-2}) {
        Case c(test::grid(8, 4, 0.25, 0.1), {1e6, 0.3, thickness, 0});
        c.shell.stretching = model;
        c.shell.bending = bending;
        for (std::uint32_t v = 0; v < 45; ++v)
          if (c.start(0, v) < 1e-9 || c.start(0, v) > 0.25 - 1e-9) c.conditions.hold(v, c.start.col(v));
        const Positions rest = c.start;
        for (Eigen::Index i = 0; i < c.start.size(); ++i) c.start.data()[i] += 0.001 * normal(engine);
        const Equilibrium e = c.solve();
        EXPECT_TRUE(e.converged) << e.reason;
        if (model == Stretching::stvk) {
          EXPECT_LT((e.positions - rest).cwiseAbs().maxCoeff(), 1e-8);  // rounding over stiffness
        }
      }
}

TEST(ShellNewton, TheOriginIsNoMatter) {
  Case c(test::grid(8, 8, 1, 1), {1e5, 0.3, 1e-3, 100});
  c.loads.gravity << 0, 0, -9.81;
  c.loads.pressure = 3;
  const auto hold = [&] {
    for (std::uint32_t v = 0; v < 81; ++v)
      if (v < 9 || v >= 72 || v % 9 == 0 || v % 9 == 8) c.conditions.hold(v, c.start.col(v));
  };
  hold();
  const Equilibrium here = c.solve();
  ASSERT_TRUE(here.converged) << here.reason;
  const Vector3d far(300, -200, 100);
  c.start.colwise() += far;
  hold();
  const Equilibrium there = c.solve();
  ASSERT_TRUE(there.converged) << there.reason;
  EXPECT_EQ(there.iterations, here.iterations);
  // Positions there are rounded to 6e-14 m; forces balance to 1e-8 of what meets in both.
  EXPECT_NEAR(there.force_scale, here.force_scale, 1e-6 * here.force_scale);
  EXPECT_LT(((there.positions.colwise() - far) - here.positions).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(ShellNewton, EverythingSlackIsAnEquilibriumOfTensionFields) {
  Case c(test::grid(6, 6, 1, 1));
  c.shell.bending = Bending::off;
  c.start *= 0.5;
  const Equilibrium e = c.solve();
  EXPECT_TRUE(e.converged);
  EXPECT_EQ(e.energy, 0);
}

TEST(ShellNewton, InvertedAndCollapsedStarts) {
  for (const int kind : {0, 1, 2}) {
    Case c = strip(8, 4, {1e6, 0.3, 1e-4, 0}, 0.1);
    if (kind == 0) c.start.row(1) *= -1;               // all turned over
    if (kind == 1) c.start.setZero();                  // all in one point
    if (kind == 2) c.start.col(20) = c.start.col(21);  // some without area
    const Equilibrium e = c.solve();
    EXPECT_TRUE(std::isfinite(e.energy));
    EXPECT_TRUE(e.positions.allFinite());
    EXPECT_TRUE(e.converged) << kind << ": " << e.reason;
    EXPECT_NEAR(e.energy, 0.01378, 1e-5) << kind;  // the strip's, as in StretchedStrip
  }
}

TEST(ShellNewton, ScalesFrom1em6To1e6) {
  double first = 0;
  for (const double scale : {1.0, 1e-6, 1e6}) {
    Case c = strip(8, 4, {1e6, 0.3, 1e-4 * scale, 0}, 0.1);
    c.start *= scale;
    c.conditions.at *= scale;
    for (RestFace& face : c.shell.rest) {
      face.edges *= scale;
      face.gradients /= scale;
      face.area *= scale * scale;
    }
    const Equilibrium e = c.solve();
    ASSERT_TRUE(e.converged) << scale << ": " << e.reason;
    const double energy = e.energy / (scale * scale * scale);
    if (scale == 1) first = energy;
    EXPECT_NEAR(energy, first, 1e-9 * first);
  }
}

TEST(ShellNewton, ThinToAMicrometre) {
  Case c = strip(10, 4, {1e6, 0.3, 1e-6, 0}, 0.1);
  const Equilibrium e = c.solve();
  ASSERT_TRUE(e.converged) << e.reason;
  EXPECT_NEAR(e.energy, 0.01378e-2, 1e-7);
}

TEST(ShellNewton, RefusesWhatHasNoEquilibrium) {
  Case c(test::grid(3, 3, 1, 1), {1e6, 0.3, 1e-3, 100});
  c.loads.gravity << 0, -9.81, 0;
  EXPECT_THAT(plisse::test::error_of([&] { c.solve(); }),
              testing::AllOf(HasSubstr("held by nothing"), HasSubstr("gravity")));
  c.loads.gravity.setZero();
  c.loads.pressure = 1;
  EXPECT_THAT(plisse::test::error_of([&] { c.solve(); }), HasSubstr("pressure pushes it, which is open"));
  for (const std::uint32_t v : {0, 1, 2, 3, 4, 7, 8, 11, 12, 13, 14})
    c.conditions.hold(v, c.start.col(v));  // all of the boundary but one corner
  EXPECT_THAT(plisse::test::error_of([&] { c.solve(); }), HasSubstr("loose at vertex 15"));
  c.conditions.hold(15, c.start.col(15));
  EXPECT_EQ(plisse::test::error_of([&] { c.solve(); }), "");
  c.conditions = Conditions(16);
  c.loads.pressure = 0;
  c.start(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(plisse::test::error_of([&] { c.solve(); }), HasSubstr("must be finite"));
  Case inside(test::grid(3, 3, 1, 1));
  inside.loads.obstacles = {Sphere{{0, 0, 0}, 0.1}};
  EXPECT_THAT(plisse::test::error_of([&] { inside.solve(); }),
              HasSubstr("vertex 0 starts inside obstacle 0"));
}

// An obstacle catches only what lands on it, and one coordinate holds along one axis.
TEST(ShellNewton, RefusesAFreeFall) {
  Case c(test::grid(3, 3, 1, 1), {1e5, 0.3, 1e-3, 100});
  c.loads.gravity << 0, 0, -9.81;
  c.loads.obstacles = {Sphere{{5, 0, -1}, 0.5}};
  EXPECT_THAT(plisse::test::error_of([&] { c.solve(); }), HasSubstr("held by nothing and gravity"));
  c.conditions.hold(0, 1, c.start(1, 0));
  EXPECT_THAT(plisse::test::error_of([&] { c.solve(); }), HasSubstr("held by nothing and gravity"));
  c.loads.obstacles = {Plane{{0, 0, -0.1}, {0, 0, 1}}};
  EXPECT_EQ(plisse::test::error_of([&] { c.solve(); }), "");
}

TEST(ShellNewton, PartsApartAndVerticesWithoutFaces) {
  auto mesh = test::grid(4, 4, 1, 1);
  const auto count = mesh.positions.cols();
  Positions more(3, 2 * count + 1);
  more << mesh.positions, mesh.positions.colwise() + Vector3d(0, 0, 5), Vector3d(9, 9, 9);
  const auto faces = mesh.faces;
  for (const Face& face : faces) {
    const auto shift = static_cast<std::uint32_t>(count);
    mesh.faces.push_back({face[0] + shift, face[1] + shift, face[2] + shift});
  }
  mesh.positions = more;
  Case c(mesh, {1e5, 0.3, 1e-3, 100});
  c.loads.gravity << 0, -9.81, 0;
  c.conditions.hold(20, c.start.col(20));
  EXPECT_THAT(plisse::test::error_of([&] { c.solve(); }), HasSubstr("part 1 (the one with vertex 25)"));
  c.conditions.hold(45, c.start.col(45));
  const Equilibrium e = c.solve();
  EXPECT_TRUE(e.converged) << e.reason;
  EXPECT_EQ(e.positions.col(2 * count), Vector3d(9, 9, 9));
}

TEST(ShellNewton, StopsWhenToldAndSaysWhy) {
  Case c = strip(8, 4, {1e6, 0.3, 1e-4, 0}, 0.1);
  const Equilibrium limited = c.solve({1, 1e-8, 0});
  EXPECT_FALSE(limited.converged);
  EXPECT_THAT(limited.reason, HasSubstr("limit of 1 iterations"));
  const Equilibrium told = find_equilibrium(c.shell, c.conditions, c.loads, c.start, {},
                                            [](const NewtonStep&, const Positions&) { return false; });
  EXPECT_FALSE(told.converged);
  EXPECT_EQ(told.reason, "it was interrupted");
}

// A sheet that falls on a sphere hangs from it, touching and not entering.
TEST(ShellNewton, RestsOnASphere) {
  Case c(test::grid(12, 12, 1, 1, test::Diagonal::alternating), {1e5, 0.3, 1e-3, 200});
  c.start.row(0).array() -= 0.5;
  c.start.row(1).array() -= 0.5;
  c.loads.gravity << 0, 0, -9.81;
  c.loads.obstacles = {Sphere{{0, 0, -0.2}, 0.2}};
  c.loads.gap = 2e-3;
  c.start.row(2).setConstant(1e-3);
  const auto centre = static_cast<std::uint32_t>(6 * 13 + 6);
  c.conditions.hold(centre, 0, 0);  // balances on a point otherwise
  c.conditions.hold(centre, 1, 0);
  c.conditions.hold(centre + 1, 1, 0);
  const Equilibrium e = c.solve();
  EXPECT_TRUE(e.converged) << e.reason;
  for (Eigen::Index v = 0; v < e.positions.cols(); ++v)
    EXPECT_GT((e.positions.col(v) - Vector3d(0, 0, -0.2)).norm(), 0.2);
  EXPECT_NEAR(e.positions(2, centre), 1e-3, 1e-3);  // on top, within the gap
  EXPECT_LT(e.positions.row(2).minCoeff(), -0.3);   // corners hang
}

// The authors' disk, from the flat rest mesh: their shipped surface may not have less energy.
TEST(ShellNewton, AuthorsDisk) {
  const auto folder = plisse::test::shared_data("tfw-disk/elastic");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto read = [&](const char* name) {
    std::ifstream file(folder / name);
    test::Mesh mesh;
    std::vector<double> values;
    for (std::string word; file >> word;) {
      if (word == "v") {
        for (int k = 0; k < 3; ++k) file >> values.emplace_back();
      } else if (word == "f") {
        Face face;
        for (auto& v : face) {
          file >> word;
          v = static_cast<std::uint32_t>(std::stoul(word)) - 1;
        }
        mesh.faces.push_back(face);
      }
    }
    mesh.positions = Eigen::Map<Positions>(values.data(), 3, static_cast<Eigen::Index>(values.size() / 3));
    return mesh;
  };
  Case c(read("disk.obj"), {1e7, 0.44, 1e-4, 1000});
  const Positions theirs = read("disk_simulated.obj").positions;
  std::ifstream clamps(folder / "disk_clamped_vertices.dat");
  int count = 0;
  std::string mark;
  clamps >> count >> mark;
  ASSERT_EQ(count, 50);
  for (int k = 0; k < count; ++k) {
    std::uint32_t vertex = 0;
    Vector3d at;
    clamps >> vertex >> at[0] >> at[1] >> at[2];
    c.conditions.hold(vertex, at);
  }
  c.loads.pressure = 600;
  const double shipped = Potential(c.shell, c.conditions, c.loads).value(theirs).energy;
  EXPECT_NEAR(shipped, -0.3741908727, 1e-4);  // their own code's, whose bending differs
  const Equilibrium e = c.solve();
  ASSERT_TRUE(e.converged) << e.reason;
  EXPECT_LE(e.energy, shipped);
  // Theirs is converged to some 1e-8: the same surface.
  EXPECT_NEAR(e.energy, shipped, 1e-6 * std::abs(shipped));
  EXPECT_LT((e.positions - theirs).cwiseAbs().maxCoeff(), 1e-3 * 0.08);
}

}  // namespace
}  // namespace plisse::shell
